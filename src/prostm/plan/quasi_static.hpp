#pragma once
/// The paper's Eq. (1), (P10) of docs/design.md: the quasi-static pressure field of a plan; of foci
/// (B2).

#include <span>
#include <vector>

#include "prostm/plan/gain.hpp"
#include "prostm/plan/plan.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm {

/// Rendered pressures along a plan's segments that stand in for its own p_i, e.g. those that are
/// played. Of each segment of each path, one path after the other, then of each focus: some, evenly
/// spaced from the segment's first point to its second; one or more.
struct SegmentPressures {
  std::vector<double> pressure;  ///< unit of the target
  std::vector<std::size_t> end;  ///< of each segment in `pressure`, past its last

  /// @param along 0 at the segment's first point, 1 at its second.
  double at(std::size_t segment, double along) const;
};

/// p(x) = p_i/γ · exp(−‖x − x_i‖² / 2σ²), γ that of the path, with x_i the closest point to x over
/// all segments of all paths of `patch`, and p_i linear between the samples of its segment. Written
/// to `out` (rows·cols of `raster`) for every cell, skin or not; all zeros when the patch has no
/// path. Of two equally near points the one of the lower path and segment index counts. For foci
/// x_i is the nearest focus and γ = 1.
/// @param sigma fall-off of a focal point [m], > 0.  @param gain γ of each path.  @param instead
/// pressures of the whole plan that count in place of its own.  @pre out.size() == raster.size().
void quasi_static_field(const Plan& plan, int patch, const TargetField& raster, double sigma,
                        const GainLaw& gain, std::span<double> out,
                        const SegmentPressures* instead = nullptr);

}  // namespace prostm
