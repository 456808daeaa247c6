#pragma once
/// Rendering error of closed paths in step, of the percept and of the field of Eq. (1), as a
/// function of pressures and points: (P19) and (P20).

#include <memory>
#include <span>
#include <vector>

#include "prostm/felt/felt_loss.hpp"
#include "prostm/felt/felt_tables.hpp"
#include "prostm/felt/step_path.hpp"
#include "prostm/plan/detail/fit/felt/common_loop.hpp"
#include "prostm/plan/detail/fit/felt/demand.hpp"
#include "prostm/plan/detail/fit/felt/envelope.hpp"
#include "prostm/plan/plan.hpp"
#include "prostm/plan/plan_settings.hpp"

namespace prostm::planning {

/// How a plan is felt by the planner's model.
struct FeltRating {
  float lack = 0.0F;      ///< 1 − S_8.5 of √e, the mean over the skins
  float strength = 0.0F;  ///< largest √e on the nominal skin over the output (P20) [µm per unit]
  float spill = 0.0F;     ///< of the field of Eq. (1)
};

/// The cells and skins on which plans are felt.
struct FeltScope {
  std::size_t most_cells = kFeltCells;
  std::size_t skins = kFeltSkins;  ///< number of skins, the first of felt_skins()
  /// Tables that several problems share; null: tables of its own.
  std::shared_ptr<FeltTables> tables = nullptr;
};
/// Moving points benefits from finer cells than choosing pressures does.
inline FeltScope felt_scope(const PlanSettings& settings) {
  return {.most_cells = settings.felt_points ? kFinerFeltCells : kFeltCells};
}

/// Maximum number of points of a plan whose pressures are chosen.
std::size_t most_felt_points(const PlanSettings& settings);

/// The cost of the felt step. Only construction allocates.
class FeltProblem {
 public:
  explicit FeltProblem(const PlanSettings& settings)
      : FeltProblem(settings, felt_scope(settings)) {}
  FeltProblem(const PlanSettings& settings, const FeltScope& scope);

  /// Sets the target. @param maximum its largest pressure, > 0. @param sigma σ of a focus [m].
  void set_target(const TargetField& target, double maximum, double sigma);
  /// Sets the points: each path begins at its first.
  void set_points(const StepPoints& points, const CommonLoop& loop);
  /// Returns (P19) as a function of the roots of the pressures.
  float evaluate(std::span<const float> root);
  /// Returns the same, and makes this loudness the one to keep; if points move, a little more.
  float keep_loudness(std::span<const float> root);
  /// Computes the gradient of the last evaluate() with respect to the roots.
  void gradient(std::span<const float> root, std::span<float> gradient);
  /// Computes the gradient, with respect to the points [1/mm], of the last evaluate() and of (P24),
  /// after gradient(). @return (P24).
  float slide(std::span<float> gradient_x, std::span<float> gradient_y);

  /// Loudness and output of the last evaluate().
  struct Loudness {
    float felt = 0.0F;    ///< rms percept [µm per unit of pressure]
    float output = 0.0F;  ///< (P20)
  };
  Loudness loudness() const { return {loss_.loudness() * output_, output_}; }
  /// Returns how the last evaluate() is felt.
  FeltRating rating();
  /// Area of the skin times mean p*² [mm²]: the scale of (P11).
  float square() const { return square_; }

 private:
  void normalise(std::span<const float> root);
  float add_envelope(float felt);

  const float weight_;
  const bool moves_;    // whether points move
  int first_ = 1;       // lowest harmonic of the model
  double sigma_ = 1.0;  // σ of a focus [m]
  float spare_ = 1.0F;  // factor on the loudness to keep, if points move
  float square_ = 1.0F, output_ = 1.0F;
  const std::size_t skins_;
  std::shared_ptr<FeltTables> tables_;
  FeltCells cells_;
  FeltLoss<float> loss_;
  EnvelopeLack envelope_;
  StepPoints points_;
  std::vector<StepPath<float>> paths_;
  std::vector<FeltSource<float>> sources_;
  // for each point: pressure, and gradients with respect to its pressure, time and share of a lap
  std::vector<float> pressure_, gradient_, felt_gradient_, by_time_, by_share_;
  Demand demand_;
  float along_ = 0.0F;  // Σ pressure · gradient of the last evaluate()
};

}  // namespace prostm::planning
