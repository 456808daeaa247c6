/// The paper's Fig. 4, and models that do its study.
#include "study/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>

#include "prostm/core/worker_pool.hpp"
#include "prostm/psychophysics/experiment.hpp"
#include "report/report.hpp"
#include "study/simulated_study.hpp"

namespace prostm::app {
namespace {

using Json = nlohmann::ordered_json;

Json or_null(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

/// Returns the scores of the paper's participants; none if their file is missing.
std::vector<Answer> answers_of_people(const ReportWork& work) {
  const auto text = work.paper_file("fig4.json");
  return text ? answers_from_paper(*text, work.paper_data + "/fig4.json") : std::vector<Answer>();
}

Json method_rows(const Analysis& analysis) {
  Json rows = Json::array();
  for (const SceneResult& scene : analysis.scenes) {
    for (const MethodResult& m : scene.methods) {
      rows.push_back({{"scene", scene_name(scene)},
                      {"method", m.method},
                      {"right", m.correct.successes},
                      {"of", m.correct.trials},
                      {"share", 100.0 * m.correct.value()},
                      {"low", 100.0 * m.interval.low},
                      {"high", 100.0 * m.interval.high},
                      {"dispersion", m.dispersion ? Json(m.dispersion->statistic / m.dispersion->df)
                                                  : Json(nullptr)}});
    }
  }
  return rows;
}

Json comparison_rows(const Analysis& analysis) {
  Json rows = Json::array();
  for (const SceneResult& scene : analysis.scenes) {
    for (const Comparison& c : scene.comparisons) {
      rows.push_back({{"scene", scene_name(scene)},
                      {"z", c.pooled_z.statistic},
                      {"z_p", c.pooled_z.p},
                      {"fisher_p", c.fisher_p},
                      {"permutation_p", c.permutation ? Json(c.permutation->p) : Json(nullptr)},
                      {"t", c.t ? Json(c.t->statistic) : Json(nullptr)},
                      {"t_p", c.t ? Json(c.t->p) : Json(nullptr)},
                      {"d", c.effect ? Json(c.effect->value) : Json(nullptr)},
                      {"d_low", c.effect ? Json(c.effect->interval.low) : Json(nullptr)},
                      {"d_high", c.effect ? Json(c.effect->interval.high) : Json(nullptr)}});
    }
  }
  return rows;
}

void add_analysis(const Analysis& analysis, Json& document) {
  auto& blocks = document["blocks"];
  blocks.push_back(report::table_block("Right answers, with Wilson's 95 % intervals",
                                       {{"scene", "scene"},
                                        {"method", "method"},
                                        {"right", "right", "", 0},
                                        {"of", "of", "", 0},
                                        {"share", "share", "%", 1},
                                        {"low", "from", "%", 1},
                                        {"high", "to", "%", 1},
                                        {"dispersion", "χ²/df of participants", "", 1}},
                                       method_rows(analysis)));
  blocks.push_back(
      report::table_block("AM against PRO-STM: tests over answers (pooled z, as in the "
                          "paper; Fisher's) and over participants (permutation, "
                          "Welch's t)",
                          {{"scene", "scene"},
                           {"z", "z"},
                           {"z_p", "p", "", 4},
                           {"fisher_p", "Fisher's p", "", 4},
                           {"permutation_p", "permutation p", "", 3},
                           {"t", "t", "", 2},
                           {"t_p", "p", "", 3},
                           {"d", "effect d", "", 2},
                           {"d_low", "from", "", 2},
                           {"d_high", "to", "", 2}},
                          comparison_rows(analysis)));
  document["values"]["words"] = in_words(analysis);
  blocks.push_back(report::text_block("{/values/words}"));
}

/// The published share of right answers with a method, both scenes together, and its interval [%].
report::Published published_share(const std::string& method) {
  const auto& all = published_experiments();
  const auto study = std::ranges::find(all, "barreiro-2020", &Experiment::id);
  const auto cell = std::ranges::find(study->cells, method, &Cell::quantity);
  return {100.0 * cell->low, 100.0 * cell->high};
}

/// Right answers of an observer in both scenes [%].
double share_of(const std::vector<ObserverRow>& rows, const std::string& observer,
                const std::string& method) {
  const auto row = std::ranges::find_if(rows, [&](const ObserverRow& one) {
    return one.observer == observer && one.method == method;
  });
  return 100.0 * row->share.back().mean;
}

/// A row of the table of observers.
Json share_row(const std::string& observer, const std::string& method,
               const std::array<SimulatedShare, 3>& shares) {
  Json row = {{"observer", observer}, {"method", method}};
  constexpr std::array kNames = {"one", "four", "both"};
  for (std::size_t s = 0; s < shares.size(); ++s) {
    row[kNames[s]] = 100.0 * shares[s].mean;
    row[fmt::format("{}_low", kNames[s])] = 100.0 * shares[s].interval.low;
    row[fmt::format("{}_high", kNames[s])] = 100.0 * shares[s].interval.high;
  }
  row["d_prime"] = row["log_likelihood"] = nullptr;
  return row;
}

std::vector<report::Column> share_columns() {
  std::vector<report::Column> columns = {{"observer", "observer"}, {"method", "method"}};
  for (const auto& [key, name] :
       {std::pair{"one", "one plume"}, {"four", "four plumes"}, {"both", "both"}}) {
    columns.push_back({key, name, "%", 1});
    columns.push_back({fmt::format("{}_low", key), "from", "%", 0});
    columns.push_back({fmt::format("{}_high", key), "to", "%", 0});
  }
  columns.push_back({"d_prime", "d′", "", 2});
  columns.push_back({"log_likelihood", "log L", "", 1});
  return columns;
}

Json observer_table(const std::vector<ObserverRow>& observers, const std::vector<Answer>& people) {
  Json rows = Json::array();
  for (const ObserverRow& observer : observers) {
    Json& row = rows.emplace_back(
        share_row("model: " + observer.observer, observer.method, observer.share));
    row["d_prime"] = observer.d_prime;
    row["log_likelihood"] = or_null(observer.log_likelihood);
  }
  for (const StudyMethod& method : kStudyMethods) {
    if (people.empty()) continue;
    rows.push_back(share_row("people", method.name, shares_of(answers_with(people, method.name))));
    rows.back()["marked"] = true;
  }
  return rows;
}

}  // namespace

void make_figure_four(const ReportWork& work, Json& document) {
  const std::vector<Answer> answers = answers_of_people(work);
  auto& blocks = document["blocks"];
  document["values"] = Json::object();
  if (answers.empty()) return;  // the findings tell that they are missing
  const Analysis analysis = analyse(answers);
  draw_analysis(analysis, work.folder.path("figure-4.svg"));
  blocks.push_back(report::text_block(
      "The answers of the paper's participants, as they were read off its Fig. 4: each was asked "
      "whether what they felt was one plume or four."));
  blocks.push_back(report::figure_block(
      "figure-4.svg", "The paper's Fig. 4 from its participants' scores",
      "Bars of right answers with AM and PRO-STM in both scenes, and a dot for each participant"));
  add_analysis(analysis, document);
  std::vector<report::Verdict> verdicts;
  for (const StudyMethod& method : kStudyMethods) {
    const double share = 100.0 * shares_of(answers_with(answers, method.name)).back().mean;
    const double published = 100.0 * method.of_people;
    verdicts.push_back(
        report::compare(fmt::format("With method {} the scores have right answers in", method.name),
                        share, {published, published}, {0, " % of trials"}));
  }
  report::add_verdicts(blocks, verdicts);
}

void make_models(const ReportWork& work, Json& document) {
  SimulateOptionsGiven given;
  given.hands = work.full_or_quick(6, 1, "hands", document);
  given.grid = work.full_or_quick(64, 32, "cells of the smoke along an edge", document);
  given.seed = work.seed;
  PipelineSettings settings;
  settings.plan.preset = Preset::Paper;
  settings.fluid.cells = given.grid;
  settings.threads = 1;
  bool stopped = false;
  std::mutex one_at_a_time;
  const auto hands = feel_hands(given, settings, [&](int done, int all) {
    // called on two threads, which must not throw
    const std::lock_guard lock(one_at_a_time);
    try {
      work.progress(static_cast<double>(done) / all);
    } catch (const ReportStopped&) {
      stopped = true;
    }
    return !stopped;
  });
  if (stopped) throw ReportStopped{};
  const std::vector<Answer> people = answers_of_people(work);
  const std::vector<ObserverRow> rows = observer_rows(hands, given, people);
  document["values"] = {{"hands", given.hands},
                        {"grid", given.grid},
                        {"studies", given.studies},
                        {"am", 100.0 * kStudyMethods[0].of_people},
                        {"pro_stm", 100.0 * kStudyMethods[1].of_people},
                        {"skin_am", share_of(rows, "skin", "am")},
                        {"skin_pro_stm", share_of(rows, "skin", "pro-stm")},
                        {"words", about_strength(rows, hands)},
                        {"sensation_words", about_sensation(hands, given.sound)}};
  auto& blocks = document["blocks"];
  blocks.push_back(report::text_block(
      "These are models, not people. They tell one plume from four by the percept of the skin "
      "model "
      "(skin), by Eq. (1) (field), by the overall strength (strength), or not at all (guess), on "
      "{/values/hands} simulated hands; shares with the range of 95 % of {/values/studies} "
      "simulated studies. No model was fitted to the paper's scores: its participants had "
      "{/values/am} % with AM and {/values/pro_stm} % with PRO-STM. log L is the log-likelihood of "
      "the paper's scores under a model; it is blank without these scores."));
  blocks.push_back(report::table_block("Right answers of models", share_columns(),
                                       observer_table(rows, people)));
  blocks.push_back(report::text_block("{/values/words} {/values/sensation_words}"));
  std::vector<report::Verdict> verdicts;
  for (const auto& [method, name] : {std::pair{"am", "AM"}, {"pro-stm", "PRO-STM"}}) {
    verdicts.push_back(report::compare(fmt::format("With {} the observer skin is right in", name),
                                       share_of(rows, "skin", method), published_share(method),
                                       {1, " % of trials"}));
  }
  report::add_verdicts(blocks, verdicts);
}

}  // namespace prostm::app
