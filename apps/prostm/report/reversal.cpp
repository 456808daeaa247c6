#include "report/reversal.hpp"

#include <fmt/format.h>

#include <string>

#include "prostm/core/units.hpp"
#include "prostm/study/task/statistics.hpp"
#include "report/study_predictions.hpp"

namespace prostm::app {
namespace {

using Json = nlohmann::ordered_json;

// the paper's study: 8 people with each method, 16 answers each
constexpr int kPeople = 8, kAnswers = 16;
constexpr int kRightAm = 78, kRightProStm = 97;
constexpr double kAdaptation = 6.0;  // rise of AM's threshold, assumed [dB]
constexpr double kPooled = 0.5 * (kRightAm + kRightProStm) / (kPeople * kAnswers);

std::vector<StudyVariation> variations() {
  std::vector<StudyVariation> out(1);
  out.push_back({.name = "pose",
                 .change = "each trial has a hand placed anew, within 10 mm and 10° (1 SD)",
                 .scene = {.place = 0.010, .turn = 10.0 * kPi / 180.0},
                 .in_trial = 1});
  out.push_back(
      {.name = "waveform",
       .change = "AM's intensity is a raised cosine",
       .apply = [](PipelineSettings& s) { s.emit.am_waveform = Waveform::RaisedCosine; }});
  out.push_back({.name = "wide AM",
                 .change = "AM's foci are planned with a width of 16 mm",
                 .apply = [](PipelineSettings& s) { s.am.sigma = 0.016; }});
  out.push_back({.name = "groups",
                 .change = "two of AM's four foci are modulated half a period late",
                 .scene = {.opposed_foci = true}});
  out.push_back({.name = "edges",
                 .change = "the skin ends at the outline of the hand and reflects waves",
                 .scene = {.edges = SkinEdges::Reflecting}});
  return out;
}

Json row_of(StudyPredictions& study, const StudyVariation& variation, const FittedObserver& of,
            bool threshold) {
  FittedObserver as = of;
  if (!threshold) as.parameters.threshold = 0.0;
  const StudyQuantities& found = study.of(as.observer());
  Json row = {{"variation", variation.name},
              {"observer", of.name()},
              {"threshold", threshold},
              {"am", found.at("am")},
              {"pro_stm", found.at("pro-stm")},
              {"am_spread", found.at("am spread")},
              {"pro_stm_spread", found.at("pro-stm spread")}};
  if (threshold) row["am_adapted"] = study.of(as.observer(), kAdaptation).at("am");
  return row;
}

void print_row(std::FILE* out, const Json& row) {
  const auto number = [&](const char* key) { return row[key].get<double>(); };
  const bool threshold = row["threshold"].get<bool>();
  const std::string adapted =
      threshold ? fmt::format(" (adapted {:4.1f} %)", 100.0 * number("am_adapted")) : "";
  fmt::print(out, "  {:<26} {:<13} AM {:4.1f} %{}, PRO-STM {:4.1f} %, χ²/df {:.1f}, {:.1f}\n",
             row["observer"].get<std::string>(), threshold ? "threshold" : "no threshold",
             100.0 * number("am"), adapted, 100.0 * number("pro_stm"), number("am_spread"),
             number("pro_stm_spread"));
}

void print_chance(std::FILE* out) {
  fmt::print(out,
             "\nChance: if both methods had the same share, PRO-STM would be ahead by the paper's "
             "14.8 points or more in\n");
  for (const double correlation : {0.05, 0.10, 0.15}) {
    fmt::print(
        out, "  {:.1f} % of studies, if answers of one person correlate with {:.2f}\n",
        100.0 * chance_of_lead({kPeople, kAnswers, kPooled, correlation}, kRightProStm - kRightAm),
        correlation);
  }
}

}  // namespace

Json print_reversal(std::FILE* out, const std::vector<FittedObserver>& observers, int hands,
                    const std::function<bool()>& go_on) {
  fmt::print(
      out,
      "The paper's study in variations: right answers with AM and PRO-STM (people: 60.9 % "
      "and 75.8 %), and χ²/df of participants (1.5 and 4.7). Adapted: AM's steady vibration raises "
      "its threshold by {:g} dB\n",
      kAdaptation);
  Json rows = Json::array();
  for (const StudyVariation& variation : variations()) {
    fmt::print(out, "\n{}: {}\n", variation.name, variation.change);
    std::fflush(out);
    StudyPredictions study(hands, go_on, variation);
    for (const FittedObserver& of : observers) {
      for (const bool threshold : {false, true}) {
        rows.push_back(row_of(study, variation, of, threshold));
        print_row(out, rows.back());
      }
    }
  }
  print_chance(out);
  return rows;
}

}  // namespace prostm::app
