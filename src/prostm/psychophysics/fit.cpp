#include "prostm/psychophysics/fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "prostm/core/text/json.hpp"
#include "prostm/psychophysics/detail/json_name.hpp"
#include "prostm/psychophysics/detail/published_files.hpp"

namespace prostm {
namespace {

constexpr const char* kFormat = "prostm-observers/1";
constexpr int kValues = 61;        // of a parameter that are tried
constexpr int kRounds = 4;         // over all parameters
constexpr double kRange = 1.92;    // half of χ² at 95 % for one degree of freedom
constexpr double kForce = 0.4e-3;  // of the published threshold that the threshold starts from [N]

constexpr std::array<FittedParameter, kFittedParameters> kParameters = {{
    {"threshold", &ObserverParameters::threshold, 0.1, 10.0, true, true, false},
    {"noise", &ObserverParameters::noise, 0.02, 20.0, true, false, false},
    {"criterion", &ObserverParameters::criterion, -3.0, 3.0, false, false, false},
    {"place", &ObserverParameters::place, 1e-3, 50e-3, true, false, true},
    {"strength_noise", &ObserverParameters::strength_noise, 0.2, 20.0, true, false, false},
}};

/// The start: the threshold from the force on a disk of 1.8 cm², at 200 Hz, that is just felt.
ObserverParameters start_of(Laboratory& laboratory, PerceptModel model, Readout readout) {
  ObserverParameters start;
  if (readout == Readout::Category) {
    start.noise = 0.3;
    start.criterion = 0.5;
  }
  start.threshold = 1.0;
  Experiment disk;
  disk.stimuli.emplace("disk", Disk{1.8e-4, kForce, 200.0, 0.0});
  disk.keys.emplace("disk", "start");
  Cell cell;
  cell.stimuli = {"disk"};
  const auto force = laboratory.predict(Observer(model, readout, start), disk, cell);
  start.threshold = 1e3 * kForce / *force;
  return start;
}

/// The loss of the fitted set as one parameter changes.
class Search {
 public:
  Search(Laboratory& laboratory, PerceptModel model, Readout readout,
         std::span<const Experiment* const> experiments)
      : laboratory_(laboratory),
        model_(model),
        readout_(readout),
        experiments_(experiments),
        start_(start_of(laboratory, model, readout)),
        now_(start_) {}

  double loss() { return loss_of(now_); }
  const ObserverParameters& now() const { return now_; }

  /// Tries values of a parameter, and keeps the middle of the best ones.
  void improve(const FittedParameter& parameter) {
    const auto [values, losses] = tried(parameter, &Search::loss_of);
    const double lowest = *std::ranges::min_element(losses);
    // a flat minimum has no best value: its middle
    std::size_t first = losses.size(), last = 0;
    for (std::size_t i = 0; i < losses.size(); ++i) {
      if (losses[i] > lowest + 1e-9) continue;
      first = std::min(first, i);
      last = i;
    }
    const double middle = parameter.logarithmic ? std::sqrt(values[first] * values[last])
                                                : 0.5 * (values[first] + values[last]);
    const double before = loss();
    ObserverParameters next = now_;
    next.*parameter.value = middle;
    if (loss_of(next) < before - 1e-12) now_ = next;
  }

  ParameterRange range_of(const FittedParameter& parameter) {
    const auto [values, losses] = tried(parameter, &Search::loss_of_cells);
    const double most = *std::ranges::min_element(losses) + kRange;
    ParameterRange out{now_.*parameter.value, now_.*parameter.value, true};
    for (std::size_t i = 0; i < losses.size(); ++i) {
      if (losses[i] > most) continue;
      out.low = std::min(out.low, values[i]);
      out.high = std::max(out.high, values[i]);
      if (i == 0 || i + 1 == losses.size()) out.determined = false;
    }
    return out;
  }

 private:
  std::vector<PredictedExperiment> predicted(const ObserverParameters& parameters) {
    const Observer observer(model_, readout_, parameters);
    std::vector<PredictedExperiment> out;
    for (const Experiment* one : experiments_) out.push_back(predict(laboratory_, &observer, *one));
    return out;
  }

  /// (X16): each paper weighs one.
  double loss_of(const ObserverParameters& parameters) {
    return sum_of(paper_losses(predicted(parameters)), ExperimentSet::Fit);
  }

  /// Each number weighs one, as in a likelihood.
  double loss_of_cells(const ObserverParameters& parameters) {
    double sum = 0.0;
    for (const PredictedExperiment& one : predicted(parameters))
      sum += one.loss * static_cast<double>(one.cells.size());
    return sum;
  }

  std::pair<std::vector<double>, std::vector<double>> tried(
      const FittedParameter& parameter, double (Search::*loss_at)(const ObserverParameters&)) {
    const double unit = parameter.relative ? start_.*parameter.value : 1.0;
    std::vector<double> values, losses;
    for (int i = 0; i < kValues; ++i) {
      const double share = static_cast<double>(i) / (kValues - 1);
      values.push_back(unit * (parameter.logarithmic
                                   ? parameter.low * std::pow(parameter.high / parameter.low, share)
                                   : parameter.low + share * (parameter.high - parameter.low)));
      ObserverParameters next = now_;
      next.*parameter.value = values.back();
      losses.push_back((this->*loss_at)(next));
    }
    return {values, losses};
  }

  Laboratory& laboratory_;
  PerceptModel model_;
  Readout readout_;
  std::span<const Experiment* const> experiments_;
  ObserverParameters start_, now_;
};

FittedObserver observer_from_json(const JsonNode& node) {
  FittedObserver out;
  out.model = named_value<PerceptModel>(node.at("model", "a percept model"));
  out.readout = named_value<Readout>(node.at("readout", "template or category"));
  out.loss = node.at("loss", "a number").number(0.0, 1e6);
  std::vector<std::string> known = {"model", "readout", "loss"};
  for (std::size_t i = 0; i < kFittedParameters; ++i) {
    const FittedParameter& parameter = kParameters[i];
    if (!has(parameter, out.readout)) continue;
    known.emplace_back(parameter.name);
    const JsonNode entry = node.at(parameter.name, "an object");
    entry.allow_only({"value", "low", "high", "determined"});
    const auto number = [&](const char* key) {
      return entry.at(key, "a number").number(-1e9, 1e9);
    };
    out.parameters.*parameter.value = number("value");
    out.ranges[i] = {number("low"), number("high"),
                     entry.at("determined", "true or false").value() == true};
  }
  node.allow_only(known);
  return out;
}

}  // namespace

std::span<const FittedParameter> fitted_parameters() {
  return kParameters;
}

bool has(const FittedParameter& parameter, Readout readout) {
  return readout == Readout::Category || !parameter.category_only;
}

std::string FittedObserver::name() const {
  return fmt::format("{}, {}", name_of(model), name_of(readout));
}

FittedObserver fit_observer(Laboratory& laboratory, PerceptModel model, Readout readout,
                            std::span<const Experiment* const> experiments) {
  Search search(laboratory, model, readout, experiments);
  for (int round = 0; round < kRounds; ++round) {
    for (const FittedParameter& parameter : kParameters)
      if (has(parameter, readout)) search.improve(parameter);
  }
  FittedObserver out{.model = model, .readout = readout, .parameters = search.now()};
  for (std::size_t i = 0; i < kFittedParameters; ++i)
    if (has(kParameters[i], readout)) out.ranges[i] = search.range_of(kParameters[i]);
  out.loss = search.loss();
  return out;
}

std::string observers_text(std::span<const FittedObserver> observers,
                           std::span<const Experiment* const> experiments) {
  nlohmann::ordered_json document = {{"format", kFormat}};
  for (const Experiment* one : experiments) document["fitted_to"].push_back(one->id);
  for (const FittedObserver& of : observers) {
    nlohmann::ordered_json entry = {
        {"model", name_of(of.model)}, {"readout", name_of(of.readout)}, {"loss", of.loss}};
    for (std::size_t i = 0; i < kFittedParameters; ++i) {
      if (!has(kParameters[i], of.readout)) continue;
      entry[kParameters[i].name] = {{"value", of.parameters.*kParameters[i].value},
                                    {"low", of.ranges[i].low},
                                    {"high", of.ranges[i].high},
                                    {"determined", of.ranges[i].determined}};
    }
    document["observers"].push_back(entry);
  }
  return to_text(document);
}

std::vector<FittedObserver> parse_observers(const std::string& text, const std::string& file) {
  const nlohmann::json document = parse_json(text, file);
  const JsonNode root(document, file);
  root.allow_only({"format", "fitted_to", "observers"});
  require_format(root, kFormat);
  std::vector<FittedObserver> out;
  if (!root.has("observers")) return out;
  const JsonNode list = root.at("observers", "a list of observers");
  for (std::size_t i = 0; i < list.array_size(); ++i) out.push_back(observer_from_json(list.at(i)));
  return out;
}

const std::vector<FittedObserver>& frozen_observers() {
  static const std::vector<FittedObserver> all =
      parse_observers(std::string(observers_file().text), std::string(observers_file().name));
  return all;
}

std::string_view frozen_hash() {
  return observers_hash();
}

}  // namespace prostm
