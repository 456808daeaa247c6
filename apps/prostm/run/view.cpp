#include "run/view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "common.hpp"
#include "prostm/acoustics/skin/sensation_level.hpp"
#include "prostm/commit.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/io/hand/pose_file.hpp"
#include "prostm/viewer/page_files.hpp"

namespace prostm::app {
namespace {

constexpr std::string_view kExperimenter = "/experimenter.html", kParticipant = "/participant.html";

/// Returns the kind of hands that `--hand` names.
std::string source_of(const std::string& hand) {
  if (names_recording(hand)) return "recording";
  return hand.starts_with("leap:") ? "leap" : hand;
}

}  // namespace

void check_view(const RunOptionsGiven& given, bool realtime) {
  if (!given.view) {
    if (given.hand == "page")
      throw InputError("--hand page is moved on the page, so it needs --view");
    return;
  }
  if (!realtime) {
    throw InputError(
        "--view shows a run in real time; leave out --as-fast-as-possible and --stepped");
  }
  if (given.tracker_file && !names_tracker(given.hand)) {
    throw InputError(
        fmt::format("--tracker-file is for the pose of a tracker, and --hand {} has none; leave it "
                    "out, or give --hand leap://HOST:PORT or openxr",
                    given.hand));
  }
}

View::View(const RunOptionsGiven& given, const PipelineSettings& settings) : given_(given) {
  link_.settings.pipeline = settings;
  // computes the widths of the array's focus once, not at every change
  PipelineSettings with_widths = settings;
  with_widths.array_width = true;
  link_.settings.pipeline.plan.widths = plan_settings(with_widths, settings.emission_rate()).widths;
  const std::string source = source_of(given.hand);
  link_.settings.source = source;
  link_.settings.sources = {source};
  for (const char* other : {"scripted", "study", "page"})
    if (source != other) link_.settings.sources.emplace_back(other);
  link_.page_hand = std::make_shared<PageHand>(settings.track);
  link_.make_hands = [this, source](const std::string& wanted, const PipelineSettings& s) {
    auto base = make_hands(wanted == source ? given_.hand : wanted, s);
    return std::make_unique<HandSwitch>(std::move(base), link_.page_hand, Pose::Identity());
  };
  link_.pose_file = given.tracker_file.value_or(kTrackerFile);
  link_.save_pose = [file = link_.pose_file](const Calibration& pose) { write_pose(file, pose); };
}

std::unique_ptr<HandSource> View::behind_the_page(std::unique_ptr<HandSource> base) {
  auto hands = std::make_unique<HandSwitch>(std::move(base), link_.page_hand, Pose::Identity());
  link_.hands = hands.get();
  return hands;
}

ViewHello View::hello(Pipeline& pipeline) const {
  const GridShape& grid = pipeline.world_stage().world().grid();
  const PipelineSettings& s = settings();
  const SensationInterval interval = sensation_interval(s.transducers);
  return {version_text(),
          pipeline.device().info().name,
          s.transducers.name,
          s.transducers.position,
          grid.p_DF,
          grid.cell * grid.nx,
          interval.below,
          interval.above,
          std::string(name_of(interval.sound))};
}

void View::start(bool guests) {
  ViewSettings settings;
  if (given_.view_address) settings.address = *given_.view_address;
  settings.port = given_.view_port;
  settings.hosts = given_.view_hosts;
  settings.guests = guests;
  server_ = std::make_unique<ViewServer>(settings, *source_, files_);
}

void View::warn(std::FILE* out) const {
  if (!server_->loopback()) {
    fmt::print(out,
               "The page listens on {}: anyone who reaches that address can see and control this "
               "run.\n",
               given_.view_address.value_or(""));
  }
  std::fflush(out);
}

void View::serve(Pipeline& pipeline, std::FILE* out) {
  link_.hands->set_tracker_pose(pipeline.world_stage().tracker_pose());
  source_ = std::make_unique<PipelineView>(link_, hello(pipeline));
  for (const PageFile& file : page_files())
    if (file.path != kExperimenter && file.path != kParticipant) files_.push_back(file);
  start(false);
  fmt::print(out, "page: {}\n", server_->url());
  warn(out);
}

StudyView& View::serve(Pipeline& pipeline, StudySession& session,
                       std::optional<Rehearsal> rehearsal, MarkerSender& markers, std::FILE* out) {
  link_.hands->set_tracker_pose(pipeline.world_stage().tracker_pose());
  auto view =
      std::make_unique<StudyView>(link_, hello(pipeline), session, std::move(rehearsal), &markers);
  StudyView& study = *view;
  source_ = std::move(view);
  for (PageFile file : page_files()) {
    if (file.path == "/") continue;  // the page of a run
    if (file.path == kExperimenter) file.path = "/";
    if (file.path == kParticipant) file.path = "/participant";
    files_.push_back(file);
  }
  start(true);
  fmt::print(out, "experimenter: {0}\nparticipant:  {0}participant\n", server_->url());
  warn(out);
  return study;
}

void View::announce(std::FILE* out) const {
  fmt::print(out, "The run continues at {} until Ctrl-C.\n", server_->url());
  std::fflush(out);
}

}  // namespace prostm::app
