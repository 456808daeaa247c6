#include "prostm/study/plan/study_plan.hpp"

#include <gmock/gmock.h>

#include <sstream>

#include "prostm/study/plan/planned_tests.hpp"
#include "prostm/study/plan/sha256.hpp"
#include "support/input_errors.hpp"

namespace prostm {
namespace {

using testing::HasSubstr;

// FIPS 180-4 examples, as in NIST's "Secure Hash Standard" test vectors
TEST(Sha256, MatchesPublishedHashes) {
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256(std::string(1'000'000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

nlohmann::ordered_json protocol_with(const std::string& methods, int repeats = 8) {
  return {{"study", {{"methods", methods}}},
          {"trials", {{"repeats", repeats}}},
          {"method", {{"am", {{"pipeline", {{"threads", 2}}}}}}}};
}

StudyPlan plan_of(const std::string& methods) {
  StudyPlan plan;
  plan.created_utc = "2026-01-02T03:04:05Z";
  plan.protocols = {{"p.toml", protocol_with(methods)}};
  plan.participants = 12;
  plan.equivalence = 0.1;
  plan.exclusions = {true, true, true, 0.25, 0.2, std::nullopt};
  plan.notes = {"PRO-STM is recognised more often."};
  plan.comparisons = {{"", "am", "pro-stm"}, {"x", "am", ""}};
  return plan;
}

TEST(StudyPlan, IsReadAsItWasWritten) {
  const std::string text = plan_text(plan_of("within"));
  const StudyPlan read = plan_from_text(text, "plan.jsonl");
  EXPECT_EQ(plan_text(read), text);
  EXPECT_EQ(read.sha256, sha256(text));
  EXPECT_EQ(read.participants, 12);
  EXPECT_TRUE(read.exclusions.failed_practice);
  EXPECT_EQ(read.exclusions.wrong_checks_above, 0.25);
  EXPECT_EQ(read.exclusions.response_below, 0.2);
  EXPECT_FALSE(read.exclusions.response_above);
  EXPECT_EQ(read.comparisons.at(1).second, "");
}

TEST(StudyPlan, NamesTheLineThatWasChanged) {
  const std::string text = plan_text(plan_of("within"));
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string other = text;
    other.replace(other.find(from), from.size(), to);
    return test::input_error([&] { plan_from_text(other, "plan.jsonl"); });
  };
  EXPECT_THAT(changed("\"repeats\":8", "\"repeats\":9"), HasSubstr("plan.jsonl, line 2 does not"));
  EXPECT_THAT(changed("\"alpha\":0.05", "\"alpha\":0.5"), HasSubstr("plan.jsonl, line 3 does not"));
  EXPECT_THAT(changed("more often", "less often"), HasSubstr("plan.jsonl, line 5 does not"));
  const std::size_t third = text.find("{\"kind\":\"settings\"");
  const std::string line = text.substr(third, text.find('\n', third) + 1 - third);
  EXPECT_THAT(changed(line, ""), HasSubstr("plan.jsonl, line 3 does not match"));
  const std::size_t last = text.find("{\"kind\":\"end\"");
  EXPECT_THAT(changed(text.substr(last), ""), HasSubstr("cut off"));
  EXPECT_THAT(changed("\"}\n{\"kind\":\"settings\"", "\"} {\"kind\":\"settings\""),
              HasSubstr("plan.jsonl, line 2"));
  EXPECT_THAT(test::input_error([&] { plan_from_text("{}\n", "plan.jsonl"); }),
              HasSubstr("not a plan"));
}

TEST(StudyPlan, RefusesAnotherProtocol) {
  const StudyPlan plan = plan_of("within");
  auto other = protocol_with("within");
  other["method"]["am"]["pipeline"]["threads"] = 8;  // changes no stimulus
  require_planned(other, "a.jsonl, line 1", plan, "plan.jsonl");
  other["trials"]["repeats"] = 4;
  EXPECT_THAT(
      test::input_error([&] { require_planned(other, "a.jsonl, line 1", plan, "plan.jsonl"); }),
      testing::AllOf(HasSubstr("a.jsonl, line 1 has another protocol than plan.jsonl, line 2"),
                     HasSubstr("trials.repeats is 4, and 8 in the plan")));
}

/// Adds answers of a participant, of which the first `right` are right.
void add(std::vector<Answer>& out, const std::string& who, const std::string& method, int right) {
  for (int i = 0; i < 10; ++i) {
    out.push_back({.participant = who,
                   .method = method,
                   .scene = "x",
                   .correct = i < right,
                   .response_s = 0.5 + i,
                   .gate = i == 9 ? "anyway" : "pass"});
  }
}

std::vector<Answer> within_answers() {
  std::vector<Answer> out;
  const int am[] = {4, 5, 6, 3, 5, 7}, stm[] = {6, 7, 6, 5, 8, 8};
  for (int i = 0; i < 6; ++i) {
    add(out, std::to_string(i), "am", am[i]);
    add(out, std::to_string(i), "pro-stm", stm[i]);
  }
  return out;
}

TEST(PlannedTests, RunInOrderWithTheirCorrection) {
  const test::WithoutTraps in_boost;
  StudyPlan plan = plan_of("within");
  plan.exclusions = {};
  const ConfirmatoryResults found = run_plan(plan, within_answers(), {}, 1);
  ASSERT_EQ(found.results.size(), 2U);
  const std::vector<double> a = {0.4, 0.5, 0.6, 0.3, 0.5, 0.7}, b = {0.6, 0.7, 0.6, 0.5, 0.8, 0.8},
                            half(6, 0.5);
  const PlannedResult& pairs = found.results[0];
  EXPECT_NEAR(pairs.test->p, paired_t(a, b)->p, 1e-12);
  EXPECT_NEAR(pairs.difference->value, 1.0 / 6.0, 1e-12);
  EXPECT_NEAR(*pairs.second.mean, 2.0 / 3.0, 1e-12);
  EXPECT_NEAR(pairs.equal->p(), equivalence({a, b, Groups::Within}, 0.1)->p(), 1e-12);
  const PlannedResult& chance = found.results[1];
  EXPECT_NEAR(chance.test->p, paired_t(half, a)->p, 1e-12);
  EXPECT_NEAR(*chance.first.mean, 0.5, 1e-12);
  EXPECT_NEAR(pairs.corrected_p, 2.0 * pairs.test->p, 1e-12);
  EXPECT_TRUE(pairs.significant);
  EXPECT_FALSE(chance.significant);
  plan.correction = Correction::None;
  plan.test = PlannedTest::Permutation;
  const ConfirmatoryResults other = run_plan(plan, within_answers(), {}, 1);
  EXPECT_NEAR(other.results[0].corrected_p, paired_permutation(a, b, 1).p, 1e-12);
}

TEST(PlannedTests, FollowTheExclusionsOfThePlan) {
  const test::WithoutTraps in_boost;
  StudyPlan plan = plan_of("within");
  // of ten trials, two are left out by time and one by the gate
  plan.exclusions = {true, true, false, std::nullopt, 1.0, 8.0};
  const std::vector<SessionFacts> sessions = {{"2", false}, {"3", true, false, 1.0}};
  const ConfirmatoryResults found = run_plan(plan, within_answers(), sessions, 1);
  EXPECT_EQ(found.participants, 5);
  EXPECT_EQ(found.results[0].first.participants, 5);
  EXPECT_NEAR(*found.results[0].first.mean, (3 + 4 + 2 + 4 + 6) / 5.0 / 7.0, 1e-12);
  ASSERT_EQ(found.left_out.size(), 3U);
  EXPECT_EQ(found.left_out[0], "Sessions not finished, left out: 2.");
  EXPECT_EQ(found.left_out[1], "Trials left out because the gate did not pass: 10.");
  EXPECT_EQ(found.left_out[2], "Trials left out by response time: 20.");
  plan.exclusions.response_below = 1000.0;
  EXPECT_THAT(test::input_error([&] { run_plan(plan, within_answers(), sessions, 1); }),
              HasSubstr("leave no answer"));
}

TEST(PlannedTests, ExcludePeopleByPracticeAndChecks) {
  const test::WithoutTraps in_boost;
  StudyPlan plan = plan_of("within");
  const std::vector<SessionFacts> sessions = {
      {"1", true, false, 0.0}, {"2", true, true, 0.5}, {"3", true, true, 0.25}, {"4", false}};
  plan.exclusions = {};
  EXPECT_EQ(run_plan(plan, within_answers(), sessions, 1).participants, 6);
  plan.exclusions.failed_practice = true;
  plan.exclusions.wrong_checks_above = 0.25;
  const ConfirmatoryResults found = run_plan(plan, within_answers(), sessions, 1);
  EXPECT_EQ(found.participants, 4);
  EXPECT_THAT(
      found.left_out,
      testing::ElementsAre("More than 25 % of catch and attention trials wrong, left out: 2.",
                           "Practice without its criterion, left out: 1."));
}

// A plan of a version without these rules.
TEST(StudyPlan, ReadsPlansWithoutTheNewerExclusions) {
  std::string older;
  std::istringstream lines(plan_text(plan_of("within")));
  for (std::string line; std::getline(lines, line);) {
    nlohmann::ordered_json json = nlohmann::ordered_json::parse(line);
    for (const char* key : {"check", "failed_practice", "wrong_checks_above"}) json.erase(key);
    if (json["kind"] == "end") json["sha256"] = sha256(older);
    const std::string body = json.dump().substr(0, json.dump().size() - 1);
    older += body + ",\"check\":\"" + sha256(older + body).substr(0, 16) + "\"}\n";
  }
  const StudyPlan read = plan_from_text(older, "plan.jsonl");
  EXPECT_TRUE(read.exclusions.overridden_gate);
  EXPECT_FALSE(read.exclusions.failed_practice);
  EXPECT_FALSE(read.exclusions.wrong_checks_above);
}

TEST(PlannedTests, OfGroupsAreWelchs) {
  const test::WithoutTraps in_boost;
  std::vector<Answer> answers;
  const int am[] = {4, 5, 6, 3}, stm[] = {6, 9, 8, 9, 10};
  for (int i = 0; i < 4; ++i) add(answers, "a" + std::to_string(i), "am", am[i]);
  for (int i = 0; i < 5; ++i) add(answers, "s" + std::to_string(i), "pro-stm", stm[i]);
  StudyPlan plan = plan_of("between");
  plan.exclusions = {};
  const ConfirmatoryResults found = run_plan(plan, answers, {}, 1);
  const std::vector<double> a = {0.4, 0.5, 0.6, 0.3}, b = {0.6, 0.9, 0.8, 0.9, 1.0};
  EXPECT_NEAR(found.results[0].test->p, welch_t(a, b)->p, 1e-12);
  // a single value has no test, and counts as p = 1
  plan.comparisons = {{"", "pro-stm", "none"}};
  EXPECT_FALSE(run_plan(plan, answers, {}, 1).results[0].test);
  EXPECT_EQ(run_plan(plan, answers, {}, 1).results[0].corrected_p, 1.0);
}

}  // namespace
}  // namespace prostm
