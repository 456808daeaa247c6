#include "prostm/psychophysics/experiment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "prostm/core/text/json.hpp"
#include "prostm/psychophysics/detail/json_name.hpp"
#include "prostm/psychophysics/detail/published_files.hpp"

namespace prostm {
namespace {

constexpr double kAnything = 1e6;

std::string text_or_nothing(const JsonNode& node, const char* key) {
  return node.has(key) ? node.at(key, "a text").text() : std::string();
}

std::vector<double> numbers_or_none(const JsonNode& node, const char* key) {
  std::vector<double> out;
  if (!node.has(key)) return out;
  const JsonNode list = node.at(key, "a list of numbers");
  for (std::size_t i = 0; i < list.array_size(); ++i)
    out.push_back(list.at(i).number(-kAnything, kAnything));
  return out;
}

/// Number of stimuli that a task compares; 0: any number, or its own.
std::size_t stimuli_of(ExperimentTask task) {
  switch (task) {
    case ExperimentTask::ThresholdRatio:
    case ExperimentTask::Stronger:
    case ExperimentTask::StrengthRatio:
      return 2;
    case ExperimentTask::ForceThreshold:
    case ExperimentTask::Locate:
    case ExperimentTask::Direction:
      return 1;
    default:
      return 0;
  }
}

bool are_equally_spaced(const std::vector<double>& x) {
  if (x.size() < 3 || x[1] <= x[0]) return false;
  for (std::size_t i = 1; i < x.size(); ++i)
    if (std::abs(x[i] - x[i - 1] - (x[1] - x[0])) > 1e-6 * (x[1] - x[0])) return false;
  return true;
}

void read_stimuli(const JsonNode& node, const Experiment& of, Cell& cell) {
  if (node.has("stimuli")) {
    const JsonNode list = node.at("stimuli", "a list of names");
    for (std::size_t i = 0; i < list.array_size(); ++i) {
      cell.stimuli.push_back(list.at(i).text());
      if (!of.stimuli.contains(cell.stimuli.back()))
        list.at(i).fail("must be a stimulus of the experiment");
    }
  }
  const std::size_t needed = stimuli_of(cell.task);
  if (needed != 0 && cell.stimuli.size() != needed)
    node.fail(needed == 1 ? "must have one stimulus" : "must have two stimuli");
  cell.abscissae = numbers_or_none(node, "abscissae");
  const bool has_abscissae = cell.task == ExperimentTask::StrongestSpeed ||
                             cell.task == ExperimentTask::StrengthLinear ||
                             cell.task == ExperimentTask::Curvature;
  if (has_abscissae && (cell.abscissae.size() != cell.stimuli.size() || cell.stimuli.size() < 2))
    node.fail("must have two stimuli or more, and an abscissa for each");
  if (cell.task == ExperimentTask::StrongestSpeed && !are_equally_spaced(cell.abscissae))
    node.fail("must have three abscissae or more, equally spaced and ascending");
  if (cell.task == ExperimentTask::Curvature && cell.stimuli.size() % 2 != 0)
    node.fail("must have pairs of stimuli");
  cell.quantity = text_or_nothing(node, "quantity");
  const bool is_study = cell.task == ExperimentTask::OneOrFour;
  if (is_study && std::ranges::find(kStudyQuantities, cell.quantity) == kStudyQuantities.end())
    node.fail(fmt::format("has a quantity that {}", must_be(cell.quantity, kStudyQuantities)));
  cell.presented = text_or_nothing(node, "presented");
  cell.answer = text_or_nothing(node, "answer");
  for (const std::string& name : {cell.presented, cell.answer}) {
    if (!name.empty() && std::ranges::find(cell.stimuli, name) == cell.stimuli.end())
      node.fail("presents or names a stimulus that is not in its list");
  }
  if (cell.presented.empty() != cell.answer.empty())
    node.fail("must have presented and answer, or neither");
}

void read_gap(const JsonNode& node, Cell& cell) {
  cell.frequencies = numbers_or_none(node, "frequencies_hz");
  if (node.has("share")) cell.share = node.at("share", "a share").number(0.01, 0.99);
  if (node.has("gap_mm")) cell.gap = from_milli(node.at("gap_mm", "a gap").number(5.0, 60.0));
  const bool has_gap = cell.task == ExperimentTask::TwoPoints;
  const bool finds_gap = cell.task == ExperimentTask::Gap || cell.task == ExperimentTask::GapRatio;
  if (!has_gap && !finds_gap) return;
  if (cell.frequencies.size() != 1 && cell.frequencies.size() != 2)
    node.fail("must have one or two frequencies_hz");
  if (has_gap && cell.gap == 0.0) node.fail("must have gap_mm");
  if (finds_gap && cell.share == 0.0) node.fail("must have a share");
}

Cell cell_from_json(const JsonNode& node, const Experiment& of) {
  node.allow_only({"name", "task", "stimuli", "abscissae", "quantity", "presented", "answer",
                   "share", "frequencies_hz", "gap_mm", "value", "low", "high", "trials",
                   "source"});
  Cell cell;
  cell.name = node.at("name", "a text").text();
  cell.task = named_value<ExperimentTask>(node.at("task", "the name of a task"));
  read_stimuli(node, of, cell);
  read_gap(node, cell);
  if (node.has("value")) cell.value = node.at("value", "a number").number(-kAnything, kAnything);
  if (node.has("low")) cell.low = node.at("low", "a number").number(-kAnything, kAnything);
  if (node.has("high")) cell.high = node.at("high", "a number").number(-kAnything, kAnything);
  if (node.has("trials")) cell.trials = node.at("trials", "a number").integer(1, 1'000'000);
  if (cell.trials > 0 && (!cell.value || *cell.value < 0.0 || *cell.value > 1.0))
    node.fail("has trials, so it must have a value between 0 and 1");
  if (!(cell.low < cell.high) || (std::isinf(cell.low) && std::isinf(cell.high)))
    node.fail("must have low or high, low below high");
  if (cell.value && (std::isinf(cell.low) || std::isinf(cell.high)))
    node.fail("has a value, so it must have low and high");
  cell.source = named_value<Source>(node.at("source", "text, figure or secondary"));
  return cell;
}

}  // namespace

Experiment parse_experiment(const std::string& text, const std::string& file) {
  const nlohmann::json document = parse_json(text, file);
  const JsonNode root(document, file);
  root.allow_only({"format", "id", "title", "paper", "paper_id", "doi", "place", "set",
                   "participants", "note", "height_mm", "stimuli", "cells", "agreement"});
  require_format(root, "prostm-experiment/1");
  Experiment out;
  out.id = root.at("id", "a text").text();
  out.title = root.at("title", "a text").text();
  out.paper = root.at("paper", "a text").text();
  out.paper_id = root.at("paper_id", "a text").text();
  out.doi = text_or_nothing(root, "doi");
  out.place = text_or_nothing(root, "place");
  out.set = named_value<ExperimentSet>(root.at("set", "fit or held-out"));
  out.participants = root.at("participants", "a text").text();
  out.note = root.at("note", "a text").text();
  out.height = from_milli(root.at("height_mm", "a height").number(50.0, 600.0));
  const JsonNode stimuli = root.at("stimuli", "an object of stimuli");
  if (!stimuli.value().is_object()) stimuli.fail("must be an object of stimuli");
  for (const auto& [name, value] : stimuli.value().items()) {
    const JsonNode node = stimuli.at(name.c_str(), "a stimulus");
    out.stimuli.emplace(name, stimulus_from_json(node));
    out.keys.emplace(name, node.value().dump());
  }
  const JsonNode cells = root.at("cells", "a list of cells");
  for (std::size_t i = 0; i < cells.array_size(); ++i)
    out.cells.push_back(cell_from_json(cells.at(i), out));
  if (out.cells.empty()) cells.fail("must have a cell");
  const JsonNode rule = root.at("agreement", "an object with least or rms");
  rule.allow_only({"least", "rms"});
  if (rule.has("least") == rule.has("rms")) rule.fail("must have least or rms, and not both");
  if (rule.has("least"))
    out.least =
        rule.at("least", "a number of cells").integer(1, static_cast<int>(out.cells.size()));
  if (rule.has("rms")) out.rms = rule.at("rms", "an error").number(1e-6, kAnything);
  return out;
}

const std::vector<Experiment>& published_experiments() {
  static const std::vector<Experiment> all = [] {
    std::vector<Experiment> out;
    for (const PublishedFile& file : published_files())
      out.push_back(parse_experiment(std::string(file.text), std::string(file.name)));
    return out;
  }();
  return all;
}

}  // namespace prostm
