#include "prostm/viewer/study_view.hpp"

#include <thread>

#include "prostm/core/file/file.hpp"
#include "prostm/device/simulated/simulated_array.hpp"
#include "prostm/pipeline/runner.hpp"
#include "study/study_support.hpp"
#include "support/input_errors.hpp"
#include "viewer/live_run.hpp"

namespace prostm {
namespace {

using test::Json;
using test::Page;
using testing::HasSubstr;

/// A study with a hand at rest, on its own threads and with its own server.
class LiveStudy {
 public:
  explicit LiveStudy(const std::string& more)
      : protocol_(protocol(more)),
        file_(folder_.file("1.jsonl")),
        session_(protocol_, 1, file_, {{"prostm", "test"}}, study_time()) {
    link_.settings.pipeline = protocol_.methods.front().settings;
    link_.settings.pipeline.scene = "still-air";
    link_.page_hand = std::make_shared<PageHand>(link_.settings.pipeline.track);
    link_.make_hands = [this](const std::string&, const PipelineSettings& s) {
      return std::make_unique<HandSwitch>(make_study_hand(s.study_hand), link_.page_hand,
                                          Pose::Identity());
    };
    auto hands = link_.make_hands("study", link_.settings.pipeline);
    link_.hands = hands.get();
    pipeline_ = std::make_unique<Pipeline>(link_.settings.pipeline, std::move(hands), link_.mute);
    view_ = std::make_unique<CountingView>(
        link_, ViewHello{"0", "simulated usx", "usx", {}, Vec3::Zero(), 0.36, 0.0, 0.0, "nominal"},
        session_);
    ViewSettings settings;
    settings.port = 0;
    settings.guests = true;
    settings.stall_time = settings.idle_time = 600.0;  // a test reads one page at a time
    server_ = std::make_unique<ViewServer>(settings, *view_, std::span<const PageFile>());
    RunOptions options = test::for_long();
    options.live = &link_;
    thread_ = std::thread(
        [this, options] { run(*pipeline_, link_.settings.pipeline, options, observer_); });
  }
  ~LiveStudy() {
    observer_.stops = true;
    thread_.join();
  }

  int port() const { return server_->port(); }
  const Protocol& protocol() const { return protocol_; }
  std::vector<ResponseLine> trials() const {
    std::vector<ResponseLine> found;
    for (const ResponseLine& line : responses_from_text(read_file(file_.path()), file_.path()))
      if (line["kind"] == "trial") found.push_back(line);
    return found;
  }
  /// Waits until current plans press on the hand and the session got one; the page reports.
  void wait_for_pressure(Page& page, const std::string& report) {
    const auto wait_for = [&](const std::atomic<int>& count, int more) {
      for (const int end = count + more; count < end;) {
        page.say(report);
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
      }
    };
    wait_for(observer_.pressing, 3);
    wait_for(view_->looks, 3);
  }
  /// Waits until the session is closed.
  void wait() {
    while (!view_->closed()) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }

 private:
  /// Counts calls to the session.
  struct CountingView final : StudyView {
    using StudyView::StudyView;
    bool refresh_state(Room room, std::string& state) override {
      if (room == Room::Main) ++looks;
      return StudyView::refresh_state(room, state);
    }
    std::atomic<int> looks{0};
  };
  struct Observer final : RunObserver {
    bool on_plan(const WorldFrame&, const PlanFrame& plan) override {
      if (!plan.plan.paths.empty() || !plan.plan.foci.empty()) ++pressing;
      return goes_on();
    }
    bool on_progress(double) override { return goes_on(); }
    bool goes_on() const { return !stops; }
    std::atomic<bool> stops{false};
    std::atomic<int> pressing{0};  // plans with focal points
  };
  static Protocol protocol(const std::string& more) {
    Protocol p = test::study_protocol(more);
    for (StudyMethod& method : p.methods) {
      method.settings.fluid.cells = 32;
      method.settings.jets.place = JetPlace::Hand;
      method.settings.devices.of<SimulatedArraySettings>().realtime = true;
      set_live_budget(method.settings);
    }
    return p;
  }

  test::TemporaryFolder folder_;
  Protocol protocol_;
  ResponseFile file_;
  StudySession session_;
  LiveLink link_;
  std::unique_ptr<Pipeline> pipeline_;
  std::unique_ptr<CountingView> view_;
  std::unique_ptr<ViewServer> server_;
  Observer observer_;
  std::thread thread_;
};

/// The next state of a page with the session in a phase. @param meanwhile is called before each
/// message: a phase may wait for a recent report of the participant's page.
Json at_phase(
    Page& page, const std::string& phase, const std::function<void()>& meanwhile = [] {}) {
  for (;;) {
    meanwhile();
    Json state = page.next_text("study");
    if (state.at("phase") == phase) return state;
  }
}

const std::string kReport = R"({"type":"page","visible":true,"noise":"off","picture":true})";
const std::string kWithNoise = R"({"type":"page","visible":true,"noise":"playing","picture":true})";

TEST(StudyView, TakesARunThroughTheTrialsAndHidesThemFromBothPages) {
  LiveStudy study(
      "methods = \"within\"\n[training]\nseconds = 0\n[trials]\nrepeats = 1\nrest = "
      "0.1\nsettle = 0.5\ngate = \"off\"\n");
  Page experimenter(study.port()), participant(study.port(), "", "", "/guest/live");
  EXPECT_EQ(at_phase(participant, "ready").at("room"), "participant");
  EXPECT_EQ(at_phase(experimenter, "ready").at("room"), "experimenter");
  participant.say(kReport);
  participant.say(R"({"type":"study","do":"next"})");
  EXPECT_EQ(participant.next_text("error").at("sentence"), "only the experimenter can do that");
  experimenter.say(R"({"type":"set","id":"gain","value":1})");
  EXPECT_THAT(experimenter.next_text("error").at("sentence").get<std::string>(),
              HasSubstr("protocol"));
  EXPECT_EQ(test::status_of(test::get(study.port(), "/numbers.json")), 403);
  const auto order = trial_order(study.protocol(), 1);
  for (std::size_t i = 0; i < order.size(); ++i) {
    participant.say(kReport);
    if (i == 0 || order[i].method != order[i - 1].method)
      experimenter.say(R"({"type":"study","do":"next"})");
    const Json told = at_phase(experimenter, "presenting", [&] { participant.say(kReport); }),
               shown = at_phase(participant, "presenting");
    EXPECT_TRUE(told.at("condition").is_null());
    EXPECT_EQ(told.at("question"), shown.at("question").at("text"));
    EXPECT_EQ(shown.at("question").at("jets_mm").size(), order[i].question == 0 ? 1U : 4U);
    study.wait_for_pressure(participant, kReport);
    experimenter.say(R"({"type":"study","do":"answer","yes":true})");
    at_phase(experimenter, i + 1 == order.size()                    ? "done"
                           : order[i + 1].method == order[i].method ? "settling"
                                                                    : "ready");
  }
  const auto trials = study.trials();
  ASSERT_EQ(trials.size(), order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    EXPECT_EQ(trials[i]["scene"] == "one-plume", order[i].scene == 0);
    EXPECT_EQ(trials[i]["method"] == "am", order[i].method == 0);
    EXPECT_GT(trials[i]["target_mn"].get<double>(), 0.0) << "smoke pressed on the hand";
    EXPECT_GT(trials[i]["rendered_mn"].get<double>(), 0.0);
  }
  experimenter.say(R"({"type":"study","do":"next"})");
  study.wait();
}

/// The next state of the experimenter's page that meets a condition.
Json state_with(Page& page, const std::function<bool(const Json&)>& holds) {
  for (;;) {
    Json state = page.next_text("study");
    if (holds(state)) return state;
  }
}

TEST(StudyView, NamesNoConditionInACatchTrial) {
  LiveStudy study(
      "methods = \"within\"\nblind = false\n[training]\nseconds = 0\n[trials]\nrepeats = "
      "1\nrest = 0.1\nsettle = 0.5\ngate = \"off\"\ncatch_every = 2\n");
  Page experimenter(study.port()), participant(study.port(), "", "", "/guest/live");
  at_phase(experimenter, "ready");
  experimenter.say(R"({"type":"study","do":"next"})");
  std::size_t unnamed = 0;
  for (int presented = 1; presented <= 3; ++presented) {
    const Json state = at_phase(experimenter, "presenting", [&] { participant.say(kReport); });
    if (state.at("condition").is_null()) ++unnamed;
    experimenter.say(R"({"type":"study","do":"answer","yes":true})");
    state_with(experimenter, [&](const Json& next) { return next.at("phase") != "presenting"; });
    EXPECT_EQ(presented - study.trials().size(), unnamed)
        << "answers to catch trials are not results";
    experimenter.say(R"({"type":"study","do":"next"})");
  }
  EXPECT_EQ(unnamed, 1U);
}

TEST(StudyView, HoldsTrialsUntilThePageReportsTheNoise) {
  LiveStudy study(
      "[training]\nseconds = 0\n[trials]\nnoise = true\nrest = 0.1\nsettle = 0.5\ngate = "
      "\"off\"\n");
  Page experimenter(study.port());
  at_phase(experimenter, "ready");
  experimenter.say(R"({"type":"study","do":"next"})");
  const auto needs = [](const char* word) {
    return [word](const Json& state) {
      EXPECT_NE(state.at("phase"), "presenting");
      return state.at("needs").get<std::string>().find(word) != std::string::npos;
    };
  };
  state_with(experimenter, needs("not open"));
  experimenter.say(kWithNoise);
  EXPECT_EQ(experimenter.next_text("error").at("sentence"), "only the participant's page reports");
  auto participant = std::make_unique<Page>(study.port(), "", "", "/guest/live");
  state_with(experimenter, needs("does not report"));
  participant->say(kReport);
  state_with(experimenter, needs("noise does not play"));
  at_phase(experimenter, "presenting", [&] { participant->say(kWithNoise); });
  participant.reset();  // as in a reload
  at_phase(experimenter, "settling");
  state_with(experimenter, needs("not open"));
  Page again(study.port(), "", "", "/guest/live");
  at_phase(experimenter, "presenting", [&] { again.say(kWithNoise); });
  experimenter.say(R"({"type":"study","do":"answer","yes":true})");
  at_phase(experimenter, "settling");
  EXPECT_EQ(study.trials().at(0)["page"]["interrupted"], 1);
}

TEST(StudyView, ShowsTheSimulationInTrainingButNotTheMethod) {
  LiveStudy study("[training]\nseconds = 600\n");
  Page experimenter(study.port()), participant(study.port(), "", "", "/guest/live");
  std::string frame;
  for (int i = 0; i < 20; ++i) {
    frame = participant.next_frame();
    EXPECT_LE(test::section_count(frame, 5), 0) << "fields";
    EXPECT_LE(test::section_count(frame, 6), 0) << "paths";
  }
  EXPECT_EQ(test::section_count(frame, 3), 1) << "hands";
  experimenter.say(R"({"type":"study","do":"end-training"})");
  at_phase(participant, "ready");
  participant.catch_up();
  experimenter.say(R"({"type":"study","do":"withdraw"})");
  EXPECT_EQ(at_phase(experimenter, "withdrawn").at("trials"), 16);
}

}  // namespace
}  // namespace prostm
