/// prostm experiments: published experiments, and what observers predict for them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "common.hpp"
#include "options.hpp"
#include "prostm/core/file/file.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/core/text/nearest_name.hpp"
#include "prostm/figure/figures.hpp"
#include "prostm/psychophysics/fit.hpp"
#include "report/reversal.hpp"
#include "report/study_predictions.hpp"

namespace prostm::app {
namespace {

using Json = nlohmann::ordered_json;
using Chosen = std::vector<const Experiment*>;
using Observers = std::vector<std::pair<PerceptModel, Readout>>;

constexpr int kHands = 6;           // of the simulated study
constexpr double kMostDrawn = 1e4;  // a prediction beyond it would hide the others

/// Returns the value that an option names; nothing if it is not given.
template <class E>
std::optional<E> option_value(const std::string& name, const char* option) {
  if (name.empty()) return std::nullopt;
  const auto value = value_named<E>(name);
  if (!value) throw InputError(fmt::format("{} {}", option, must_be(name, kNames<E>)));
  return value;
}

Chosen chosen_experiments(const ExperimentsOptionsGiven& options) {
  const auto set = option_value<ExperimentSet>(options.set, "--set");
  std::vector<std::string> known;
  for (const Experiment& one : published_experiments()) known.push_back(one.id);
  for (const std::string& name : options.names) {
    if (std::ranges::find(known, name) == known.end())
      throw InputError(fmt::format("there is no experiment \"{}\"{}; prostm experiments lists them",
                                   shown_name(name), did_you_mean(name, known)));
  }
  Chosen out;
  for (const Experiment& one : published_experiments()) {
    const bool named =
        options.names.empty() || std::ranges::find(options.names, one.id) != options.names.end();
    if (named && (!set || one.set == *set)) out.push_back(&one);
  }
  if (out.empty()) throw InputError(fmt::format("no experiment of --set {} is named", options.set));
  return out;
}

std::string number_text(const std::optional<double>& value) {
  return value ? fmt::format("{:.3g}", *value) : "–";
}

/// "60.9 (52.3 to 69)", "above 0", "below 1.1".
std::string published_text(const Cell& cell) {
  if (cell.value) return fmt::format("{:.3g} ({:.3g} to {:.3g})", *cell.value, cell.low, cell.high);
  if (std::isinf(cell.high)) return fmt::format("above {:.3g}", cell.low);
  if (std::isinf(cell.low)) return fmt::format("below {:.3g}", cell.high);
  return fmt::format("{:.3g} to {:.3g}", cell.low, cell.high);
}

/// The predictions of one observer for all experiments; of a guess without a name.
struct Column {
  std::string name;
  std::vector<PredictedExperiment> experiments;
};

Json cell_json(const PredictedCell& of) {
  const Cell& cell = *of.cell;
  Json out = {{"name", cell.name}, {"task", name_of(cell.task)}};
  out["published"] = cell.value ? Json(*cell.value) : Json(nullptr);
  out["low"] = std::isinf(cell.low) ? Json(nullptr) : Json(cell.low);
  out["high"] = std::isinf(cell.high) ? Json(nullptr) : Json(cell.high);
  out["source"] = name_of(cell.source);
  out["predicted"] = of.predicted ? Json(*of.predicted) : Json(nullptr);
  out["within"] = of.within;
  out["loss"] = of.loss;
  return out;
}

Json column_json(const Column& column) {
  const std::vector<PaperLoss> papers = paper_losses(column.experiments);
  Json out = {{"observer", column.name},
              {"loss_fit", sum_of(papers, ExperimentSet::Fit)},
              {"loss_held_out", sum_of(papers, ExperimentSet::HeldOut)}};
  for (const PaperLoss& paper : papers) out["papers"][paper.paper_id] = paper.loss;
  for (const PredictedExperiment& one : column.experiments) {
    Json& entry = out["experiments"].emplace_back();
    entry = {{"id", one.experiment->id},
             {"set", name_of(one.experiment->set)},
             {"agrees", one.agrees},
             {"loss", one.loss}};
    for (const PredictedCell& cell : one.cells) entry["cells"].push_back(cell_json(cell));
  }
  return out;
}

/// "authors: title. journal, Sec. III, doi:10.…"
std::string where_words(const Experiment& of) {
  std::string words = of.paper;
  if (!of.place.empty()) words += ", " + of.place;
  if (!of.doi.empty()) words += ", doi:" + of.doi;
  return words;
}

void print_cells(std::FILE* out, const std::vector<Column>& columns) {
  for (std::size_t e = 0; e < columns.front().experiments.size(); ++e) {
    const Experiment& of = *columns.front().experiments[e].experiment;
    fmt::print(out, "\n{}: {} ({})\n  {}\n", of.id, of.title, name_of(of.set), where_words(of));
    fmt::print(out, "  participants: {}\n  {}\n", of.participants, of.note);
    for (std::size_t c = 0; c < of.cells.size(); ++c) {
      fmt::print(out, "  {:<44} published {}\n", of.cells[c].name, published_text(of.cells[c]));
      for (const Column& column : columns) {
        const PredictedCell& cell = column.experiments[e].cells[c];
        if (!cell.predicted) continue;
        fmt::print(out, "    {:<25} {:>9}{}\n", column.name, number_text(cell.predicted),
                   cell.within ? "  within" : "");
      }
    }
  }
}

/// Prints the loss of each paper with each observer, and the sums of both sets.
void print_losses(std::FILE* out, const std::vector<Column>& columns) {
  fmt::print(out,
             "\nLoss of each paper (0: exact, 2: two standard errors off; * agrees), and sums\n");
  for (const Column& column : columns) {
    const std::vector<PaperLoss> papers = paper_losses(column.experiments);
    fmt::print(out, "  {:<26}", column.name);
    for (const PaperLoss& paper : papers) {
      const bool agrees = std::ranges::all_of(column.experiments, [&](const auto& one) {
        return one.experiment->paper_id != paper.paper_id || one.agrees;
      });
      fmt::print(out, " {} {:.2f}{}", paper.paper_id, paper.loss, agrees ? "*" : "");
    }
    fmt::print(out, "  fit {:.2f} held-out {:.2f}\n", sum_of(papers, ExperimentSet::Fit),
               sum_of(papers, ExperimentSet::HeldOut));
  }
}

bool has_study(const Chosen& experiments) {
  return std::ranges::any_of(experiments, [](const Experiment* one) {
    return one->cells.front().task == ExperimentTask::OneOrFour;
  });
}

/// Returns the paper's study with each observer, with and without its threshold.
Json study_rows(StudyPredictions& study, const std::vector<FittedObserver>& observers) {
  Json rows = Json::array();
  for (const FittedObserver& of : observers) {
    const auto strengths = study.strengths(of.model);
    for (const bool threshold : {false, true}) {
      Json& row = rows.emplace_back(
          Json{{"observer", of.name()}, {"threshold", threshold}, {"quantities", Json::object()}});
      FittedObserver as = of;
      if (!threshold) as.parameters.threshold = 0.0;
      for (const auto& [name, value] : study.of(as.observer())) row["quantities"][name] = value;
      for (std::size_t m = 0; m < strengths.size(); ++m) {
        for (const double strength : strengths[m])
          row["above_threshold_db"][kStudyMethods[m].name].push_back(
              decibels(strength, of.parameters.threshold));
      }
    }
  }
  return rows;
}

void print_study(std::FILE* out, const Json& rows) {
  fmt::print(
      out,
      "\nThe paper's study: right answers with AM and PRO-STM (people: 60.9 % and 75.8 %), χ²/df "
      "of\n"
      "participants (1.5 and 4.7), and the strength of one and four plumes above threshold\n");
  for (const Json& row : rows) {
    const auto percent = [&](const char* name) {
      return 100.0 * row["quantities"][name].get<double>();
    };
    const auto level = [&](const char* method, std::size_t scene) {
      return row["above_threshold_db"][method][scene].get<double>();
    };
    fmt::print(out,
               "  {:<26} {:<13} AM {:4.1f} %, PRO-STM {:4.1f} %, χ²/df {:.1f}, {:.1f}, AM {:+.1f}, "
               "{:+.1f} dB, "
               "PRO-STM {:+.1f}, {:+.1f} dB\n",
               row["observer"].get<std::string>(),
               row["threshold"].get<bool>() ? "threshold" : "no threshold", percent("am"),
               percent("pro-stm"), row["quantities"]["am spread"].get<double>(),
               row["quantities"]["pro-stm spread"].get<double>(), level("am", 0), level("am", 1),
               level("pro-stm", 0), level("pro-stm", 1));
  }
}

/// The observers that the options choose.
Observers chosen_observers(const ExperimentsOptionsGiven& options) {
  const auto model = option_value<PerceptModel>(options.model, "--model");
  const auto readout = option_value<Readout>(options.readout, "--readout");
  Observers out;
  for (std::size_t m = 0; m < kPerceptModels; ++m) {
    for (const Readout one : {Readout::Template, Readout::Category}) {
      const auto of = static_cast<PerceptModel>(m);
      if ((!model || of == *model) && (!readout || one == *readout)) out.emplace_back(of, one);
    }
  }
  return out;
}

/// The frozen ones of the observers that the options choose.
std::vector<FittedObserver> chosen_frozen(const ExperimentsOptionsGiven& options) {
  const Observers chosen = chosen_observers(options);
  std::vector<FittedObserver> out;
  for (const FittedObserver& of : frozen_observers()) {
    if (std::ranges::find(chosen, std::pair(of.model, of.readout)) != chosen.end())
      out.push_back(of);
  }
  return out;
}

/// Draws a chart for each experiment: the published numbers by their place in its list, and the
/// predicted ones.
void draw(const std::vector<Column>& columns, const std::string& path) {
  constexpr std::size_t kInRow = 4;
  std::vector<Chart> charts;
  for (std::size_t e = 0; e < columns.front().experiments.size(); ++e) {
    const PredictedExperiment& of = columns.front().experiments[e];
    Chart chart{of.experiment->id, "number in its list", "value", false, {}, false};
    ChartSeries published{"published", {}, {}};
    for (std::size_t c = 0; c < of.cells.size(); ++c) {
      const Cell& cell = *of.cells[c].cell;
      const auto x = static_cast<double>(c + 1);
      // a bound is drawn where it is
      const double y = cell.value ? *cell.value : std::isinf(cell.low) ? cell.high : cell.low;
      published.x.push_back(x);
      published.y.push_back(y);
    }
    chart.series.push_back(published);
    for (const Column& column : columns) {
      ChartSeries predicted{column.name, {}, {}};
      for (std::size_t c = 0; c < of.cells.size(); ++c) {
        const auto& value = column.experiments[e].cells[c].predicted;
        if (!value || std::abs(*value) > kMostDrawn) continue;
        predicted.x.push_back(static_cast<double>(c + 1));
        predicted.y.push_back(*value);
      }
      if (!predicted.x.empty()) chart.series.push_back(predicted);
    }
    charts.push_back(chart);
  }
  draw_charts(charts, path, kInRow);
}

/// Returns the predictions of a guess and of the chosen observers.
std::vector<Column> predicted_columns(Laboratory& laboratory, const Chosen& experiments,
                                      const std::vector<FittedObserver>& observers) {
  std::vector<Column> columns = {{"guess", {}}};
  for (const Experiment* one : experiments)
    columns.front().experiments.push_back(predict(laboratory, nullptr, *one));
  for (const FittedObserver& of : observers) {
    const Observer observer = of.observer();
    Column& column = columns.emplace_back(Column{of.name(), {}});
    for (const Experiment* one : experiments)
      column.experiments.push_back(predict(laboratory, &observer, *one));
  }
  return columns;
}

/// Returns the experiments of the fitted set, without those of a paper if it is named.
Chosen fitted_experiments(const std::string& without) {
  Chosen out;
  for (const Experiment& one : published_experiments())
    if (one.set == ExperimentSet::Fit && one.paper_id != without) out.push_back(&one);
  return out;
}

/// Leaves out each paper in turn, and prints the observer, fitted without it, that predicts the
/// others best. @param fitted_without the observers for each paper of the fitted set.
Json print_judges(std::FILE* out, Laboratory& laboratory, Progress& progress,
                  const std::map<std::string, std::vector<FittedObserver>>& fitted_without) {
  Chosen all;
  for (const Experiment& one : published_experiments()) all.push_back(&one);
  const std::vector<Column> frozen = predicted_columns(laboratory, all, frozen_observers());
  Json rows = Json::array();
  progress.clear();
  fmt::print(out,
             "\nWithout each paper, the observer that predicts the others best, and its loss\n");
  for (const PaperLoss& paper : paper_losses(frozen.front().experiments)) {
    const std::string& left = paper.paper_id;
    const auto found = fitted_without.find(left);
    const std::vector<Column> columns =
        found == fitted_without.end() ? frozen : predicted_columns(laboratory, all, found->second);
    progress.clear();
    const auto loss_of = [&](const Column& column) {
      return sum_without(paper_losses(column.experiments), left);
    };
    const Column& best = *std::ranges::min_element(columns, {}, loss_of);
    const double loss = loss_of(best), guess = loss_of(columns.front());
    fmt::print(out, "  {:<12} {:<26} {:.2f}, a guess {:.2f}\n", left, best.name, loss, guess);
    rows.push_back({{"without", left}, {"observer", best.name}, {"loss", loss}, {"guess", guess}});
  }
  return rows;
}

/// Fits each observer without each paper of the fitted set, and prints the parameters that are
/// outside their ranges then, or that nothing determines any more. If all observers are chosen,
/// also prints which of them predicts best without each paper.
int leave_one_out(const ExperimentsOptionsGiven& options, Laboratory& laboratory,
                  Progress& progress) {
  std::FILE* out = prose(options.json);
  Json rows = Json::array();
  std::vector<std::string> papers;
  for (const Experiment* one : fitted_experiments(""))
    if (papers.empty() || papers.back() != one->paper_id) papers.push_back(one->paper_id);
  std::map<std::string, std::vector<FittedObserver>> fitted_without;
  for (const FittedObserver& frozen : chosen_frozen(options)) {
    for (const std::string& paper : papers) {
      const FittedObserver of =
          fit_observer(laboratory, frozen.model, frozen.readout, fitted_experiments(paper));
      progress.clear();
      fmt::print(out, "{} without {}:", frozen.name(), paper);
      Json& row = rows.emplace_back(Json{{"observer", frozen.name()}, {"without", paper}});
      for (std::size_t i = 0; i < kFittedParameters; ++i) {
        const FittedParameter& parameter = fitted_parameters()[i];
        const double value = of.parameters.*parameter.value;
        const ParameterRange& range = frozen.ranges[i];
        if (!has(parameter, frozen.readout)) continue;
        row[parameter.name] = {{"value", value}, {"determined", of.ranges[i].determined}};
        const bool moved = value < range.low || value > range.high;
        if (!of.ranges[i].determined)
          fmt::print(out, " {} is not determined;", parameter.name);
        else if (moved)
          fmt::print(out, " {} moves to {:.3g};", parameter.name, value);
      }
      fmt::print(out, " loss {:.2f}\n", of.loss);
      fitted_without[paper].push_back(of);
    }
  }
  Json document = {{"leave_one_out", rows}};
  if (options.model.empty() && options.readout.empty())
    document["judges"] = print_judges(out, laboratory, progress, fitted_without);
  write_json(options.json, document);
  say_written(out, options.json);
  return 0;
}

/// Simulates the paper's study in variations.
int vary(const ExperimentsOptionsGiven& options, const std::function<bool()>& go_on,
         Progress& progress) {
  std::FILE* out = prose(options.json);
  progress.clear();
  const Json rows = print_reversal(out, chosen_frozen(options), kHands, go_on);
  write_json(options.json, Json{{"variations", rows}});
  say_written(out, options.json);
  return 0;
}

int fit(const ExperimentsOptionsGiven& options, Laboratory& laboratory, Progress& progress) {
  const Chosen experiments = fitted_experiments("");
  std::vector<FittedObserver> fitted;
  for (const auto& [model, readout] : chosen_observers(options)) {
    fitted.push_back(fit_observer(laboratory, model, readout, experiments));
    progress.clear();
    const FittedObserver& of = fitted.back();
    fmt::print(stdout, "{:<26} loss {:.3f}, threshold {:.3g}, noise {:.3g}\n", of.name(), of.loss,
               of.parameters.threshold, of.parameters.noise);
  }
  write_file(options.fit, observers_text(fitted, experiments));
  say_written(stdout, options.fit);
  return 0;
}

}  // namespace

int experiments_command(const ExperimentsOptionsGiven& options) {
  std::FILE* out = prose(options.json);
  const Chosen experiments = chosen_experiments(options);
  const auto observers = chosen_frozen(options);
  const Interrupt interrupt;
  Progress progress("computing the stimuli");
  Laboratory laboratory(SkinSettings{}, at_measured_amplitude(usx_array()), [&] {
    if (interrupt.requested()) throw StudyStopped{};
  });
  const auto go_on = [&] { return !interrupt.requested(); };
  StudyPredictions study(kHands, go_on);
  laboratory.simulate_with([&](const Observer& observer, const std::string& quantity) {
    return std::optional(study.of(observer).at(quantity));
  });
  try {
    if (!options.fit.empty()) return fit(options, laboratory, progress);
    if (options.leave_one_out) return leave_one_out(options, laboratory, progress);
    if (options.variations) return vary(options, go_on, progress);
    const std::vector<Column> columns = predicted_columns(laboratory, experiments, observers);
    progress.clear();
    print_cells(out, columns);
    print_losses(out, columns);
    fmt::print(out, "\nParameters: SHA-256 {}\n", frozen_hash());
    Json document = {{"parameters_sha256", frozen_hash()}};
    if (has_study(experiments)) {
      document["paper_study"] = study_rows(study, observers);
      print_study(out, document["paper_study"]);
    }
    for (const Column& column : columns) document["observers"].push_back(column_json(column));
    write_json(options.json, document);
    if (!options.figure.empty()) draw(columns, options.figure);
    say_written(out, options.json);
    say_written(out, options.figure);
  } catch (const StudyStopped&) {
    progress.clear();
    warn(fmt::format("stopped by {}; nothing was written", interrupt.cause()));
    return interrupt.status();
  }
  return 0;
}

}  // namespace prostm::app
