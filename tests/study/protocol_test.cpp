#include <nlohmann/json.hpp>

#include "prostm/core/file/file.hpp"
#include "prostm/study/task/protocol_file.hpp"
#include "study/study_support.hpp"
#include "support/input_errors.hpp"
#include "support/places.hpp"

namespace prostm {
namespace {

using testing::HasSubstr;

const std::string kScenes =
    "[scene.one-plume]\nquestion = \"One?\"\n[scene.four-plumes]\nquestion = \"Four?\"\n";
const std::string kMethods = "[method.am.pipeline]\nmethod = \"am\"\n[method.pro-stm]\n";

std::string refusal(const std::string& text) {
  return test::input_error([&] { protocol_from_toml(text, "p.toml", PipelineSettings{}); });
}

TEST(Protocol, KeepsScenesAndMethodsInTheOrderOfTheFile) {
  PipelineSettings base;
  base.fluid.cells = 48;
  const Protocol p = protocol_from_toml(
      "[method.z.plan]\npaths = 3\n[method.a.pipeline]\nmethod = "
      "\"am\"\n[scene.two-plumes]\nquestion = "
      "\"Two?\"\n[scene.one-plume]\nquestion = \"One?\"\n[trials]\nrepeats = 5\n",
      "p.toml", base);
  ASSERT_EQ(p.methods.size(), 2U);
  EXPECT_EQ(p.methods[0].name, "z");
  EXPECT_EQ(p.methods[0].settings.plan.paths, 3);
  EXPECT_EQ(p.methods[0].settings.fluid.cells, 48);
  EXPECT_EQ(p.methods[1].settings.method, Method::Am);
  EXPECT_EQ(p.methods[1].settings.fluid.cells, 48);
  ASSERT_EQ(p.scenes.size(), 2U);
  EXPECT_EQ(p.scenes[0].name, "two-plumes");
  EXPECT_EQ(p.scenes[1].question, "One?");
  EXPECT_EQ(p.trials.repeats, 5);
}

TEST(Protocol, OfThePaperMatchesThePaper) {
  const Protocol p = read_protocol(test::source_file("data/protocols/one-plume-or-four.toml"), {});
  EXPECT_EQ(p.study.methods, MethodsOf::Between);
  EXPECT_EQ(p.study.participants, 16);
  EXPECT_EQ(p.training.seconds, 120.0);
  EXPECT_TRUE(p.training.picture);
  EXPECT_EQ(trial_order(p, 1).size(), 16U);
  EXPECT_EQ(p.trials.questions, Questions::Random);
  EXPECT_FALSE(p.trials.feedback);
  EXPECT_EQ(p.trials.time_limit, 0.0);
  EXPECT_EQ(p.methods[0].settings.method, Method::Am);
  EXPECT_EQ(p.methods[1].settings.method, Method::ProStm);
  EXPECT_EQ(p.methods[1].settings.plan.preset, Preset::Paper);
}

TEST(Protocol, ErrorsAreReportedWithTheirLine) {
  EXPECT_THAT(refusal("[trails]\n"), HasSubstr("p.toml, line 1"));
  EXPECT_THAT(refusal("[trails]\n"), HasSubstr("trials"));
  EXPECT_THAT(refusal("[methods.am]\n"), HasSubstr("method"));
  EXPECT_THAT(refusal("[trials]\nrepeats = 0\n"), HasSubstr("line 2: trials.repeats"));
  EXPECT_THAT(refusal("[trials]\ngate = \"on\"\n"), HasSubstr("required"));
  EXPECT_THAT(refusal(kScenes), HasSubstr("0 [method.NAME]"));
  EXPECT_THAT(refusal("[scene.one-plume]\nquestion = \"?\"\n" + kMethods),
              HasSubstr("needs at least 2"));
  EXPECT_THAT(refusal("scene = 3\n"), HasSubstr("line 1: scene must be tables"));
  EXPECT_THAT(refusal("[method]\nam = 1\n" + kScenes),
              HasSubstr("line 2: method.am must be a table"));
  EXPECT_THAT(refusal("[scene.fog]\n[scene.one-plume]\n"), HasSubstr("[scene.fog]"));
  EXPECT_THAT(refusal("[scene.one-plume]\n[scene.four-plumes]\n" + kMethods),
              HasSubstr("has no question"));
  EXPECT_THAT(refusal("[scene.one-plume]\nquestoin = \"?\"\n[scene.four-plumes]\n"),
              HasSubstr("line 2: one-plume has no setting"));
  EXPECT_THAT(refusal(kScenes + "[method.am.pipeline]\nmethod = \"fm\"\n"),
              HasSubstr("line 6: pipeline.method"));
  EXPECT_THAT(refusal(kScenes + "[method.am.plna]\n"), HasSubstr("did you mean"));
  EXPECT_THAT(refusal(kScenes + "[method.am.pipeline]\nscene = \"ring\"\n"),
              HasSubstr("[method.am] sets pipeline.scene"));
  EXPECT_THAT(refusal("[study\n"), HasSubstr("not valid TOML"));
}

// ---- levels ----

std::string levels(const std::string& task, const std::string& level,
                   const std::string& methods = "[method.a]\n") {
  return "[trials]\ntask = \"" + task + "\"\n[level]\n" + level +
         "[scene.one-plume]\nquestion = \"?\"\n" + methods;
}
const std::string kSpeed = "setting = \"plan.speed\"\nlow = 2\nhigh = 8\nstep = 0.5\n";

TEST(Protocol, ExamplesOfEveryTaskAreRead) {
  const auto read = [](const char* name) {
    return read_protocol(test::source_file(std::string("data/protocols/") + name), {});
  };
  const Protocol gain = read("gain-as-strong-as-am.toml");
  EXPECT_EQ(gain.trials.task, &adjustment());
  ASSERT_TRUE(gain.standard);
  EXPECT_EQ(gain.standard->name, "am");
  EXPECT_EQ(gain.standard->settings.method, Method::Am);
  ASSERT_EQ(gain.methods.size(), 1U);
  EXPECT_EQ(gain.methods[0].name, "pro-stm");
  EXPECT_EQ(gain.methods[0].settings.emit.full_scale_pressure,
            gain.standard->settings.emit.full_scale_pressure);
  const Protocol continuity = read("continuity.toml");
  EXPECT_EQ(continuity.trials.task, &judgement());
  EXPECT_EQ(continuity.level.setting, "plan.draw_rate");
  EXPECT_EQ(continuity.level.start, 120.0) << "where it is easiest";
  const Protocol paths = read("number-of-paths.toml");
  EXPECT_EQ(paths.level.setting, "plan.paths");
  EXPECT_EQ(paths.level.procedure, Staircase::Bayes);
  const Protocol stronger = read("just-stronger.toml");
  EXPECT_EQ(stronger.trials.task, &forced_choice());
  EXPECT_FALSE(stronger.standard);
  EXPECT_EQ(stronger.level.start, 2.0);
  for (const Protocol* p : {&gain, &continuity, &paths, &stronger}) {
    const auto json = protocol_json(*p);
    EXPECT_EQ(json["level"]["setting"], p->level.setting);
    EXPECT_EQ(json["method"].size(), p->methods.size() + (p->standard ? 1U : 0U));
  }
}

TEST(Protocol, InvalidLevelsAreRejected) {
  const std::string reference = "reference = 2\n";
  EXPECT_THAT(refusal(kScenes + kMethods + "[level]\nlow = 1\n"), HasSubstr("another task"));
  EXPECT_THAT(refusal(levels("guessing", kSpeed)), HasSubstr("line 2: trials.task"));
  EXPECT_THAT(refusal(levels("judgement", "low = 1\n")), HasSubstr("needs setting in [level]"));
  EXPECT_THAT(refusal(levels("judgement", "setting = \"plan.speed\"\nlow = 1\n")),
              HasSubstr("needs high"));
  EXPECT_THAT(refusal(levels("judgement", kSpeed + "hihg = 3\n")), HasSubstr("line 8: level has"));
  const auto refused = [](const std::string& setting, const std::string& low_high,
                          const std::string& more = "", const std::string& methods = "") {
    return refusal(levels("judgement", "setting = \"" + setting + "\"\n" + low_high + more,
                          methods.empty() ? "[method.a]\n" : methods));
  };
  const std::string fine = "low = 2\nhigh = 8\n", step = "step = 0.5\n";
  EXPECT_THAT(refused("plan.speed", "low = 8\nhigh = 2\n"), HasSubstr("must be below level.high"));
  EXPECT_THAT(refused("plan.speed", fine), HasSubstr("needs a step"));
  EXPECT_THAT(refused("plan.speed", "low = 0\nhigh = 2\n", "scale = \"log\"\n" + step),
              HasSubstr("above 0 because scale is log"));
  EXPECT_THAT(refused("plan.speed", "low = 2\nhigh = 800\n", step),
              HasSubstr("speed = 800 m/s must be between 0.1 and 8 m/s"));
  EXPECT_THAT(refused("plan.speed", fine, step + "start = 9\n"), HasSubstr("level.start = 9"));
  EXPECT_THAT(refused("plan.speed", fine, "step = 50\n"), HasSubstr("step = 50"));
  EXPECT_THAT(refused("plan.speed", fine, step + "coarse = 20\n"), HasSubstr("reversals = 12"));
  for (const char* not_one : {"plan.preset", "plan.fog", "speed", "fluid.jet_speed", "emit.foci"})
    EXPECT_THAT(refused(not_one, fine, step), HasSubstr("that can change during a trial"));
  EXPECT_THAT(refused("am.foci", "low = 1\nhigh = 3\n", step), HasSubstr("changes nothing"));
  EXPECT_THAT(refused("plan.paths", fine, step), HasSubstr("[method.a.emit] foci = 4"));
  EXPECT_THAT(refused("plan.gain", fine, step), HasSubstr("full_scale_pressure"));
  EXPECT_THAT(refused("plan.speed", fine, step + reference), HasSubstr("has no standard"));
  EXPECT_THAT(refusal(levels("forced-choice", kSpeed)), HasSubstr("needs a standard"));
  EXPECT_THAT(refusal(levels("forced-choice", kSpeed + "reference = 3\n")),
              HasSubstr("must not be above low"));
  EXPECT_THAT(refusal(levels("adjustment", kSpeed + reference + "against = \"a\"\n")),
              HasSubstr("give either"));
  EXPECT_THAT(refusal(levels("adjustment", kSpeed + "against = \"b\"\n")),
              HasSubstr("names no [method.NAME]"));
  EXPECT_THAT(refusal(levels("adjustment", kSpeed + "against = \"a\"\n")),
              HasSubstr("the only method"));
  std::string told = levels("judgement", kSpeed);
  told.insert(told.find("[level]"), "feedback = true\n");
  EXPECT_THAT(refusal(told), HasSubstr("has no right or wrong answers"));
}

TEST(Protocol, JsonHasEverySettingOfEveryMethod) {
  const auto json = protocol_json(test::study_protocol());
  EXPECT_EQ(json["study"]["title"], "Plumes");
  EXPECT_EQ(json["scene"]["one-plume"]["question"], "One?");
  EXPECT_EQ(json["method"]["am"]["pipeline"]["method"], "am");
  EXPECT_TRUE(json["method"]["pro-stm"]["plan"].contains("paths"));
}

}  // namespace
}  // namespace prostm
