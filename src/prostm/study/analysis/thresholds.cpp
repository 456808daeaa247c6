#include "prostm/study/analysis/thresholds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace prostm {
namespace {

using Levels = std::map<double, Proportion>;

/// The answers of one method in one scene, by participant; the empty name stands for all
/// participants together.
struct Cell {
  std::string method, scene;
  std::map<std::string, Levels> participants;
};

/// Cells in the order in which scenes, and then methods, first appear.
std::vector<Cell> cells_of(std::span<const Answer> answers) {
  std::vector<std::string> methods, scenes;
  const auto place = [](std::vector<std::string>& names, const std::string& name) {
    const auto at = std::find(names.begin(), names.end(), name);
    if (at != names.end()) return at - names.begin();
    names.push_back(name);
    return std::ssize(names) - 1;
  };
  std::map<std::pair<std::ptrdiff_t, std::ptrdiff_t>, Cell> cells;
  for (const Answer& a : answers) {
    Cell& cell = cells[{place(scenes, a.scene), place(methods, a.method)}];
    cell.method = a.method;
    cell.scene = a.scene;
    for (const std::string& of : {std::string(), a.participant}) {
      Proportion& score = cell.participants[of][*a.level];
      ++score.trials;
      score.successes += a.correct ? 1 : 0;
    }
  }
  std::vector<Cell> out;
  for (auto& [where, cell] : cells) out.push_back(std::move(cell));
  return out;
}

}  // namespace

std::vector<ThresholdResult> fit_thresholds(std::span<const Answer> answers,
                                            const PsychometricSettings& settings) {
  std::vector<ThresholdResult> out;
  for (const Cell& cell : cells_of(answers)) {
    for (const auto& [participant, levels] : cell.participants) {
      ThresholdResult& result = out.emplace_back();
      result.method = cell.method;
      result.scene = cell.scene;
      result.participant = participant;
      for (const auto& [x, score] : levels) result.scores.push_back({x, score});
      PsychometricResult found = fit_psychometric(result.scores, settings);
      result.fit = found.fit;
      result.no_fit = found.no_fit;
      result.bounds = found.bounds;
    }
  }
  return out;
}

int level_digits(std::span<const LevelScore> scores) {
  constexpr int kOfRange = 4, kMost = 15;
  const double low = scores.front().level, high = scores.back().level;
  if (!(high > low)) return kOfRange;
  const double more = std::log10(std::max(std::abs(low), std::abs(high)) / (high - low));
  return std::min(kMost, kOfRange + std::max(0, static_cast<int>(more)));
}

std::string in_words(NoFit reason, AnswerKind kind) {
  const std::string answers = kind == AnswerKind::Right ? "right answers" : "answers for the level";
  switch (reason) {
    case NoFit::TooFewLevels:
      return "all answers are at one level";
    case NoFit::NotGrowing:
      return answers + " hardly grow with the level, or not at all";
    case NoFit::Falling:
      return answers + " fall with the level";
    case NoFit::Step:
      return "a step fits as well as any slope";
    case NoFit::BelowLevels:
      return answers + " are already at their maximum at the lowest level";
    case NoFit::AboveLevels:
      return answers + " are still at their minimum at the highest level";
  }
  return "";
}

std::string bounds_text(const Interval& of, int digits) {
  if (std::isinf(of.low)) return fmt::format("below {:.{}g}", of.high, digits);
  if (std::isinf(of.high)) return fmt::format("above {:.{}g}", of.low, digits);
  return fmt::format("{:.{}g} to {:.{}g}", of.low, digits, of.high, digits);
}

}  // namespace prostm
