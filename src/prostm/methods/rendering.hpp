#pragma once
/// The pressure on the skin and the percept for each way of rendering a target.

#include <memory>
#include <string>
#include <vector>

#include "prostm/acoustics/array/array.hpp"
#include "prostm/core/worker_pool.hpp"
#include "prostm/score/felt.hpp"
#include "prostm/score/score.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm::methods {

/// The compared ways. BestNarrow is Best planned with the width of the array's own focus, like
/// Felt. AmFelt optimises the percept of AM's foci, with the σ that suits it best, and chooses
/// their number for each target by (P25) without spill. Circle is a single circle about the centre
/// of mass; its radius is the pressure's mean distance from there. RandomCircles are placed without
/// regard to the target, and get its least-squares pressures. All others use the paper's σ. Flat
/// needs no array: the same pressure on all skin, modulated as in AM.
enum class Way {
  PaperValid,
  Best,
  BestNarrow,
  Felt,
  Am,
  AmFelt,
  Circle,
  Circles,
  RandomCircles,
  Flat
};
inline constexpr std::array kWays = {
    Way::PaperValid, Way::Best,   Way::BestNarrow, Way::Felt,          Way::Am,
    Way::AmFelt,     Way::Circle, Way::Circles,    Way::RandomCircles, Way::Flat};
std::string to_string(Way way);

/// One way on one target, with the largest drive at 1; for Flat, with a pressure of 1 Pa. Radiation
/// pressures [Pa] and percepts [m] scale with the square of the drives. `field.part` is empty.
struct Rendering {
  Plan plan;
  /// Whether the loop is short enough for the percept, is_felt(); if not, only the plan is set.
  bool felt_at_all = true;
  double mean_power = 0.0;  ///< mean of Σ |q|² over the loop; 0 for Flat
  PhysicalField field;
  FeltField felt;
  Metrics of_model;              ///< metrics of the plan by Eq. (1) with the paper's width
  Metrics of_envelope, of_felt;  ///< metrics of field.envelope and felt.percept
  Ghosts ghosts;
};

/// Plans, simulates the array and computes percepts. Caches the skin's response by loop period.
class Renderer {
 public:
  /// @param threads number of threads, on which no result depends.
  Renderer(const TransducerArray& array, const TargetField& raster, int threads = 2);
  ~Renderer();

  /// @pre `target` has the raster of the constructor, and pressure on skin.
  Rendering render(Way way, const TargetField& target);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace prostm::methods
