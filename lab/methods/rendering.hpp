#pragma once
/// What each way to render a target really puts on the skin, and what the skin makes of it.

#include <memory>
#include <string>
#include <vector>

#include "prostm/acoustics/array.hpp"
#include "prostm/core/worker_pool.hpp"
#include "prostm/score/felt.hpp"
#include "prostm/score/score.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm::bench {

/// The ways that are compared. BestNarrow is Best planned with the width of the array's own focus,
/// all others with the paper's σ. Flat is no array's doing: the same pressure on all skin,
/// modulated as AM is.
enum class Way { PaperValid, Best, BestNarrow, Am, Circles, Flat };
inline constexpr std::array kWays = {Way::PaperValid, Way::Best,    Way::BestNarrow,
                                     Way::Am,         Way::Circles, Way::Flat};
std::string to_string(Way way);

/// One way on one target, with the largest drive at 1; flat: with a pressure of 1 Pa. Radiation
/// pressures [Pa] and percepts [m] go with the square of the drives.
struct Rendering {
  Plan plan;
  double mean_power = 0.0;  ///< Σ |q|², mean over the loop; 0 of flat
  PhysicalField field;
  FeltField felt;
  Metrics of_envelope, of_felt;  ///< of field.envelope and of felt.percept, against the target
  Ghosts ghosts;
};

/// Plans, plays and feels. Keeps what it has worked out for a loop's period.
class Renderer {
 public:
  Renderer(const TransducerArray& array, const TargetField& raster);
  ~Renderer();

  /// @pre the target has the raster of the constructor, and pressure on skin.
  Rendering render(Way way, const TargetField& target);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace prostm::bench
