#include "prostm/study/analysis/bradley_terry.hpp"

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "support/input_errors.hpp"
#include "support/places.hpp"

namespace prostm {
namespace {

using Json = nlohmann::json;
using Preferred = PairedComparison::Preferred;
using testing::HasSubstr;

/// Adds comparisons in which `winner` was preferred to `loser`.
void add(std::vector<PairedComparison>& out, const std::string& winner, const std::string& loser,
         int times) {
  for (int i = 0; i < times; ++i) {
    const bool turned = i % 2 == 1;  // either place
    out.push_back({"", turned ? loser : winner, turned ? winner : loser,
                   turned ? Preferred::B : Preferred::A});
  }
}

std::vector<PairedComparison> of_matrix(const Json& wins) {
  std::vector<PairedComparison> out;
  for (std::size_t i = 0; i < wins.size(); ++i) {
    for (std::size_t k = 0; k < wins.size(); ++k)
      add(out, "s" + std::to_string(i), "s" + std::to_string(k), wins[i][k]);
  }
  return out;
}

const StimulusAbility& ability_of(const BradleyTerry& fit, const std::string& stimulus) {
  for (const StimulusAbility& of : fit.stimuli) {
    if (of.stimulus == stimulus) return of;
  }
  throw std::out_of_range(stimulus);
}

/// The difference of `of` from `from`, whichever order the fit lists them in.
AbilityDifference difference(const BradleyTerry& fit, const std::string& from,
                             const std::string& of) {
  for (AbilityDifference x : fit.differences) {
    if (x.first == from && x.second == of) return x;
    if (x.first != of || x.second != from) continue;
    x.difference = -x.difference;
    return x;
  }
  throw std::out_of_range(of);
}

TEST(BradleyTerry, AgreesWithStatsmodelsOnThreeHundredTables) {
  const test::WithoutTraps in_boost;
  std::ifstream file(test::source_file("tests/study/analysis/expected_effects.jsonl"));
  int lines = 0;
  for (std::string text; std::getline(file, text); ++lines) {
    const Json line = Json::parse(text)["bradley_terry"];
    const BradleyTerry fit = fit_bradley_terry(of_matrix(line["wins"]));
    double sum = 0.0;
    for (const StimulusAbility& of : fit.stimuli) sum += of.ability;
    EXPECT_NEAR(sum, 0.0, 1e-9);
    for (std::size_t i = 0; i < line["ability"].size(); ++i) {
      const AbilityDifference x = difference(fit, "s0", "s" + std::to_string(i + 1));
      EXPECT_NEAR(x.difference, line["ability"][i].get<double>(), 1e-6) << line;
      EXPECT_NEAR(x.error, line["error"][i].get<double>(), 1e-6) << line;
      EXPECT_NEAR(x.p, line["p"][i].get<double>(), 1e-6) << line;
      EXPECT_NEAR(x.interval.high - x.interval.low, 2.0 * 1.959963985 * x.error, 1e-6);
    }
    if (fit.misfit) {
      EXPECT_NEAR(fit.misfit->statistic, line["deviance"].get<double>(), 1e-6) << line;
    } else {
      EXPECT_EQ(fit.stimuli.size(), 2U);
    }
  }
  EXPECT_EQ(lines, 300);
}

// Citations between statistical journals (S. M. Stigler, Stat. Sci. 9, 94 (1994)), with the
// abilities that H. Turner and D. Firth print (J. Stat. Softw. 48(9) (2012), section 2).
TEST(BradleyTerry, RanksJournalsAsPublished) {
  const test::WithoutTraps in_boost;
  std::vector<PairedComparison> cited;
  const auto pair = [&](const char* a, const char* b, int of_a, int of_b) {
    add(cited, a, b, of_a);
    add(cited, b, a, of_b);
  };
  pair("Biometrika", "Comm Statist", 730, 33);
  pair("Biometrika", "JASA", 498, 320);
  pair("Biometrika", "JRSS-B", 221, 284);
  pair("Comm Statist", "JASA", 68, 813);
  pair("Comm Statist", "JRSS-B", 17, 276);
  pair("JASA", "JRSS-B", 142, 325);
  const BradleyTerry fit = fit_bradley_terry(cited);
  EXPECT_NEAR(difference(fit, "Biometrika", "Comm Statist").difference, -2.94907, 5e-6);
  EXPECT_NEAR(difference(fit, "Biometrika", "Comm Statist").error, 0.10255, 5e-6);
  EXPECT_NEAR(difference(fit, "Biometrika", "JASA").difference, -0.47957, 5e-6);
  EXPECT_NEAR(difference(fit, "Biometrika", "JASA").error, 0.06059, 5e-6);
  EXPECT_NEAR(difference(fit, "Biometrika", "JRSS-B").difference, 0.26895, 5e-6);
  EXPECT_NEAR(difference(fit, "Biometrika", "JRSS-B").error, 0.07083, 5e-6);
  EXPECT_NEAR(fit.misfit->statistic, 4.293, 5e-4);
  EXPECT_EQ(fit.misfit->df, 3.0);
  EXPECT_THAT(in_words(fit), HasSubstr("preferred: JRSS-B, Biometrika, JASA, Comm Statist."));
}

// With two stimuli, the ability is the log-odds of the preferences.
TEST(BradleyTerry, OfTwoStimuliIsTheirLogOdds) {
  const test::WithoutTraps in_boost;
  std::vector<PairedComparison> of;
  add(of, "x", "y", 15);
  add(of, "y", "x", 4);
  for (int i = 0; i < 2; ++i) of.push_back({"p", "x", "y", Preferred::Neither});
  const BradleyTerry fit = fit_bradley_terry(of);
  EXPECT_EQ(fit.ties, 2U);
  EXPECT_NEAR(ability_of(fit, "x").ability, 0.5 * std::log(16.0 / 5.0), 1e-9);
  EXPECT_NEAR(ability_of(fit, "x").preferred, 16.0, 1e-12);
  EXPECT_EQ(ability_of(fit, "y").comparisons, 21);
  const AbilityDifference x = difference(fit, "x", "y");
  EXPECT_NEAR(x.error, std::sqrt(1.0 / 16.0 + 1.0 / 5.0), 1e-9);
  EXPECT_NEAR(x.share, 5.0 / 21.0, 1e-9);
  EXPECT_FALSE(fit.misfit);
}

TEST(BradleyTerry, RefusesStimuliWithoutFiniteAbilities) {
  std::vector<PairedComparison> of;
  EXPECT_THAT(test::input_error([&] { fit_bradley_terry(of); }),
              HasSubstr("there is no comparison"));
  add(of, "x", "y", 5);
  add(of, "y", "x", 2);
  add(of, "x", "z", 4);
  EXPECT_THAT(test::input_error([&] { fit_bradley_terry(of); }),
              HasSubstr("none of \"z\" was ever preferred to any of \"x\", \"y\""));
  add(of, "z", "y", 1);
  EXPECT_EQ(fit_bradley_terry(of).stimuli.size(), 3U);
  add(of, "u", "v", 1);
  add(of, "v", "u", 1);
  EXPECT_THAT(test::input_error([&] { fit_bradley_terry(of); }), HasSubstr("was ever preferred"));
  of.push_back({"", "x", "x", Preferred::A});
  EXPECT_THAT(test::input_error([&] { fit_bradley_terry(of); }), HasSubstr("compared with itself"));
}

}  // namespace
}  // namespace prostm
