#include "prostm/psychophysics/prediction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/statistics/bivariate_statistics.hpp>
#include <cmath>
#include <limits>

#include "prostm/core/units.hpp"
#include "prostm/experiments/experiments.hpp"

namespace prostm {
namespace {

constexpr double kMostLoss = 8.0;     // of a cell: four standard errors
constexpr double kMissedBound = 2.0;  // of a bound: two standard errors
// gaps of two focal points that are computed [m]
constexpr double kFirstGap = 6e-3, kLastGap = 60e-3, kGapStep = 3e-3;
// gaps that are felt as one and as two in most answers [m]
constexpr double kOne = 15e-3, kTwo = 45e-3;

/// Whether a guess is a share of answers.
bool is_share(const Cell& cell) {
  const ExperimentTask task = cell.task;
  if (task == ExperimentTask::OneOrFour) return cell.trials > 0;
  return task == ExperimentTask::Stronger || task == ExperimentTask::TwoPoints ||
         task == ExperimentTask::Identify || task == ExperimentTask::Direction;
}

/// Negative log-likelihood of a counted share under a predicted one, over that of the best.
double deviance(double share, int trials, double predicted) {
  const double q = std::clamp(predicted, 0.5 / trials, 1.0 - 0.5 / trials);
  const auto part = [](double p, double of) { return p > 0.0 ? p * std::log(p / of) : 0.0; };
  return trials * (part(share, q) + part(1.0 - share, 1.0 - q));
}

}  // namespace

const FeltStimulus& Laboratory::felt(const Observer& observer, double height,
                                     const PresentedStimulus& stimulus, const std::string& key) {
  const FeltByModel& all = feeler_.feel(fmt::format("{} {}", height, key), stimulus, height);
  return all[static_cast<std::size_t>(observer.model())];
}

const FeltStimulus& Laboratory::felt(const Observer& observer, const Experiment& of,
                                     const std::string& stimulus) {
  return felt(observer, of.height, of.stimuli.at(stimulus), of.keys.at(stimulus));
}

const FeltStimulus& Laboratory::pair(const Observer& observer, double height, double gap,
                                     std::span<const double> frequencies) {
  const AmPoints points{{Vec2(-0.5 * gap, 0.0), Vec2(0.5 * gap, 0.0)},
                        {frequencies.begin(), frequencies.end()}};
  return felt(observer, height, points,
              fmt::format("pair {:.2f} {}", 1e3 * gap, fmt::join(frequencies, " ")));
}

double Laboratory::says_two(const Observer& observer, double height, double gap,
                            std::span<const double> frequencies) {
  const std::array ends = {Vec2(-0.5 * gap, 0.0), Vec2(0.5 * gap, 0.0)};
  return observer.says_two(pair(observer, height, gap, frequencies), ends,
                           pair(observer, height, kOne, frequencies),
                           pair(observer, height, kTwo, frequencies));
}

std::optional<double> Laboratory::gap_at(const Observer& observer, double height, double share,
                                         std::span<const double> frequencies) {
  // from the largest gap down, since small ones can be merged
  double gap = kLastGap, above = says_two(observer, height, gap, frequencies);
  if (above < share) return std::nullopt;
  while (gap - kGapStep > kFirstGap) {
    const double below = says_two(observer, height, gap - kGapStep, frequencies);
    if (below < share) return 1e3 * (gap - kGapStep * (above - share) / (above - below));
    gap -= kGapStep;
    above = below;
  }
  return std::nullopt;
}

std::optional<double> Laboratory::compared(const Observer& observer, const Experiment& of,
                                           const Cell& cell) {
  const FeltStimulus& a = felt(observer, of, cell.stimuli[0]);
  const FeltStimulus& b = felt(observer, of, cell.stimuli[1]);
  if (cell.task == ExperimentTask::Stronger) return observer.prefers(a, b);
  const double stronger = decibels(a.strength, b.strength);
  return cell.task == ExperimentTask::StrengthRatio ? stronger : -stronger;
}

std::optional<double> Laboratory::over_abscissae(const Observer& observer, const Experiment& of,
                                                 const Cell& cell) {
  std::vector<double> strengths;
  for (const std::string& name : cell.stimuli)
    strengths.push_back(felt(observer, of, name).strength);
  if (cell.task == ExperimentTask::StrongestSpeed)
    return experiments::peak_place(cell.abscissae, strengths);
  const double r = boost::math::statistics::correlation_coefficient(cell.abscissae, strengths);
  return std::isfinite(r) ? r : 0.0;  // strengths that are all the same
}

std::optional<double> Laboratory::identified(const Observer& observer, const Experiment& of,
                                             const Cell& cell) {
  if (observer.readout() == Readout::Category) {
    // it counts points; other alternatives do not differ in its one number
    double right = 0.0;
    for (const std::string& name : cell.stimuli) {
      const auto* points = std::get_if<AmPoints>(&of.stimuli.at(name));
      if (points == nullptr || !cell.answer.empty()) return std::nullopt;
      right += observer.counts(felt(observer, of, name), points->points);
    }
    return right / static_cast<double>(cell.stimuli.size());
  }
  std::vector<const FeltStimulus*> alternatives;
  for (const std::string& name : cell.stimuli) alternatives.push_back(&felt(observer, of, name));
  const auto matrix = observer.confusions(alternatives);
  if (!cell.answer.empty()) {
    const auto index = [&](const std::string& name) {
      return static_cast<std::size_t>(std::ranges::find(cell.stimuli, name) - cell.stimuli.begin());
    };
    return matrix[index(cell.presented)][index(cell.answer)];
  }
  double right = 0.0;
  for (std::size_t k = 0; k < matrix.size(); ++k)
    right += matrix[k][k] / static_cast<double>(matrix.size());
  return right;
}

std::optional<double> Laboratory::weber(const Observer& observer, const Experiment& of,
                                        const Cell& cell) {
  const AmPoints centre{{Vec2::Zero()}, {200.0}};
  const FeltStimulus& point = felt(observer, of.height, centre, "centre");
  double sum = 0.0;
  const std::size_t pairs = cell.stimuli.size() / 2;
  for (std::size_t i = 0; i < pairs; ++i) {
    const FeltStimulus& a = felt(observer, of, cell.stimuli[2 * i]);
    const FeltStimulus& b = felt(observer, of, cell.stimuli[2 * i + 1]);
    sum +=
        observer.curvature_weber(point, a, b, {cell.abscissae[2 * i], cell.abscissae[2 * i + 1]});
  }
  return sum / static_cast<double>(pairs);
}

std::optional<double> Laboratory::predict(const Observer& observer, const Experiment& of,
                                          const Cell& cell) {
  step_();
  switch (cell.task) {
    case ExperimentTask::ForceThreshold: {
      const auto& disk = std::get<Disk>(of.stimuli.at(cell.stimuli[0]));
      return 1e3 * disk.force * observer.parameters().threshold /
             felt(observer, of, cell.stimuli[0]).strength;
    }
    case ExperimentTask::ThresholdRatio:
    case ExperimentTask::Stronger:
    case ExperimentTask::StrengthRatio:
      return compared(observer, of, cell);
    case ExperimentTask::StrongestSpeed:
    case ExperimentTask::StrengthLinear:
      return over_abscissae(observer, of, cell);
    case ExperimentTask::TwoPoints:
      return says_two(observer, of.height, cell.gap, cell.frequencies);
    case ExperimentTask::Gap:
      return gap_at(observer, of.height, cell.share, cell.frequencies);
    case ExperimentTask::GapRatio: {
      const auto first =
          gap_at(observer, of.height, cell.share, std::span(cell.frequencies).first(1));
      const auto second =
          gap_at(observer, of.height, cell.share, std::span(cell.frequencies).last(1));
      if (!first || !second) return std::nullopt;
      return *first / *second;
    }
    case ExperimentTask::Locate:
      // the mean distance of a normal distribution in the plane
      return 1e3 * std::sqrt(0.5 * kPi) * observer.place_noise(felt(observer, of, cell.stimuli[0]));
    case ExperimentTask::Identify:
      return identified(observer, of, cell);
    case ExperimentTask::Direction:
      return observer.tells_direction(felt(observer, of, cell.stimuli[0]));
    case ExperimentTask::Curvature:
      return weber(observer, of, cell);
    case ExperimentTask::OneOrFour:
      return study_ ? study_(observer, cell.quantity) : std::nullopt;
  }
  return std::nullopt;
}

double loss_of_guess(const Cell& cell) {
  if (!is_share(cell)) return cell.value ? kMissedBound : 0.5 * kMissedBound;
  const bool identifies = cell.task == ExperimentTask::Identify;
  return loss_of(cell, identifies ? 1.0 / static_cast<double>(cell.stimuli.size()) : 0.5);
}

double loss_of(const Cell& cell, std::optional<double> predicted) {
  if (!predicted) return loss_of_guess(cell);
  if (!cell.value) return *predicted >= cell.low && *predicted <= cell.high ? 0.0 : kMissedBound;
  if (cell.trials > 0) return std::min(kMostLoss, deviance(*cell.value, cell.trials, *predicted));
  const double z = (*predicted - *cell.value) / ((cell.high - cell.low) / 3.92);
  return std::min(kMostLoss, 0.5 * z * z);
}

PredictedExperiment predict(Laboratory& laboratory, const Observer* observer,
                            const Experiment& of) {
  PredictedExperiment out;
  out.experiment = &of;
  double square = 0.0;
  int within = 0, predicted = 0;
  for (const Cell& cell : of.cells) {
    PredictedCell& one = out.cells.emplace_back();
    one.cell = &cell;
    if (observer != nullptr) one.predicted = laboratory.predict(*observer, of, cell);
    one.loss = loss_of(cell, one.predicted);
    one.within = one.predicted && *one.predicted >= cell.low && *one.predicted <= cell.high;
    out.loss += one.loss / static_cast<double>(of.cells.size());
    within += one.within ? 1 : 0;
    if (!one.predicted || !cell.value) continue;
    square += std::pow(*one.predicted - *cell.value, 2);
    ++predicted;
  }
  out.agrees =
      of.rms > 0.0 ? predicted > 0 && std::sqrt(square / predicted) <= of.rms : within >= of.least;
  return out;
}

std::vector<PaperLoss> paper_losses(std::span<const PredictedExperiment> experiments) {
  std::vector<PaperLoss> out;
  std::vector<double> cells;
  for (const PredictedExperiment& one : experiments) {
    const std::string& id = one.experiment->paper_id;
    auto at = std::ranges::find(out, id, &PaperLoss::paper_id);
    if (at == out.end()) {
      out.push_back({id, one.experiment->set, 0.0});
      cells.push_back(0.0);
      at = out.end() - 1;
    }
    at->loss += one.loss * static_cast<double>(one.cells.size());
    cells[static_cast<std::size_t>(at - out.begin())] += static_cast<double>(one.cells.size());
  }
  for (std::size_t i = 0; i < out.size(); ++i) out[i].loss /= cells[i];
  return out;
}

double sum_of(std::span<const PaperLoss> papers, ExperimentSet set) {
  double sum = 0.0;
  for (const PaperLoss& paper : papers) sum += paper.set == set ? paper.loss : 0.0;
  return sum;
}

double sum_without(std::span<const PaperLoss> papers, std::string_view paper_id) {
  double sum = 0.0;
  for (const PaperLoss& paper : papers) sum += paper.paper_id == paper_id ? 0.0 : paper.loss;
  return sum;
}

}  // namespace prostm
