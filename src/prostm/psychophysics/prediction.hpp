#pragma once
/// Predictions of published numbers, and their agreement: (X13) to (X16) of
/// docs/design/psychophysics.md.

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "prostm/psychophysics/experiment.hpp"
#include "prostm/psychophysics/observer.hpp"

namespace prostm {

/// Predicts the cells of experiments for observers.
class Laboratory {
 public:
  /// @param step called repeatedly; an exception that it throws ends the computation.
  Laboratory(const SkinSettings& skin, const TransducerArray& array, std::function<void()> step)
      : step_(std::move(step)), feeler_(skin, array, step_) {}

  /// Predicts a quantity of the paper's study, one of kStudyQuantities.
  using Study = std::function<std::optional<double>(const Observer&, const std::string& quantity)>;
  /// Sets the simulation of the paper's study; without it, that study is guessed.
  void simulate_with(Study study) { study_ = std::move(study); }

  /// Returns the predicted number of a cell in its unit; nothing where the observer has no answer.
  std::optional<double> predict(const Observer& observer, const Experiment& of, const Cell& cell);

 private:
  const FeltStimulus& felt(const Observer& observer, const Experiment& of,
                           const std::string& stimulus);
  const FeltStimulus& felt(const Observer& observer, double height,
                           const PresentedStimulus& stimulus, const std::string& key);
  const FeltStimulus& pair(const Observer& observer, double height, double gap,
                           std::span<const double> frequencies);
  double says_two(const Observer& observer, double height, double gap,
                  std::span<const double> frequencies);
  std::optional<double> gap_at(const Observer& observer, double height, double share,
                               std::span<const double> frequencies);
  std::optional<double> compared(const Observer& observer, const Experiment& of, const Cell& cell);
  std::optional<double> over_abscissae(const Observer& observer, const Experiment& of,
                                       const Cell& cell);
  std::optional<double> identified(const Observer& observer, const Experiment& of,
                                   const Cell& cell);
  std::optional<double> weber(const Observer& observer, const Experiment& of, const Cell& cell);

  std::function<void()> step_;
  Feeler feeler_;
  Study study_;
};

/// One cell as predicted. Without an observer, or without its answer, it is guessed.
struct PredictedCell {
  const Cell* cell = nullptr;
  std::optional<double> predicted;  ///< nothing: no answer
  double loss = 0.0;                ///< (X14)
  bool within = false;              ///< within the published bounds
};
/// Returns the loss of a prediction, (X14).
double loss_of(const Cell& cell, std::optional<double> predicted);
/// Returns the loss of a guess.
double loss_of_guess(const Cell& cell);

/// An experiment as predicted.
struct PredictedExperiment {
  const Experiment* experiment = nullptr;
  std::vector<PredictedCell> cells;
  double loss = 0.0;    ///< mean of the cells
  bool agrees = false;  ///< (X15)
};
/// Guesses if `observer` is null.
PredictedExperiment predict(Laboratory& laboratory, const Observer* observer, const Experiment& of);

/// Loss of a paper: the mean over the cells of its experiments.
struct PaperLoss {
  std::string paper_id;
  ExperimentSet set = ExperimentSet::Fit;
  double loss = 0.0;
};
/// Returns the losses of the papers, in the order of the experiments.
std::vector<PaperLoss> paper_losses(std::span<const PredictedExperiment> experiments);
/// Returns the sum of the losses of a set's papers, (X16).
double sum_of(std::span<const PaperLoss> papers, ExperimentSet set);
/// Returns the sum of the losses of all papers but one.
double sum_without(std::span<const PaperLoss> papers, std::string_view paper_id);

}  // namespace prostm
