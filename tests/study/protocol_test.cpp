#include "prostm/study/protocol.hpp"

#include <nlohmann/json.hpp>

#include "prostm/core/file.hpp"
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

TEST(Protocol, OfThePaperIsThePapers) {
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

TEST(Protocol, WhatIsWrongIsSaidWithItsLine) {
  EXPECT_THAT(refusal("[trails]\n"), HasSubstr("p.toml, line 1"));
  EXPECT_THAT(refusal("[trails]\n"), HasSubstr("trials"));
  EXPECT_THAT(refusal("[methods.am]\n"), HasSubstr("method"));
  EXPECT_THAT(refusal("[trials]\nrepeats = 0\n"), HasSubstr("line 2: trials.repeats"));
  EXPECT_THAT(refusal("[trials]\ngate = \"on\"\n"), HasSubstr("required"));
  EXPECT_THAT(refusal(kScenes), HasSubstr("0 [method.NAME]"));
  EXPECT_THAT(refusal("[scene.one-plume]\nquestion = \"?\"\n" + kMethods), HasSubstr("needs 2"));
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
              HasSubstr("[method.am] gives pipeline.scene"));
  EXPECT_THAT(refusal("[study\n"), HasSubstr("not valid TOML"));
}

TEST(Protocol, AsJsonHasEverySettingOfEveryMethod) {
  const auto json = protocol_json(test::study_protocol());
  EXPECT_EQ(json["study"]["title"], "Plumes");
  EXPECT_EQ(json["scene"]["one-plume"]["question"], "One?");
  EXPECT_EQ(json["method"]["am"]["pipeline"]["method"], "am");
  EXPECT_TRUE(json["method"]["pro-stm"]["plan"].contains("paths"));
}

}  // namespace
}  // namespace prostm
