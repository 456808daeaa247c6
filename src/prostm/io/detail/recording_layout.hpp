#pragma once
/// The datasets of a recording, as docs/guides/recordings.md describes them. Private to io.

#include <span>
#include <vector>

#include "prostm/io/detail/hdf5.hpp"
#include "prostm/plan/plan_stats.hpp"
#include "prostm/target/field_shape.hpp"

namespace prostm::recording {

inline constexpr hsize_t kHands = 2;  ///< a row of /hand has room for

std::vector<h5::Column> frame_columns();   ///< of /frame
std::vector<h5::Column> target_columns();  ///< of /target, a row for each patch
h5::Column weight_column();                ///< of /target too, once a patch has weights
h5::Column smoke_column();                 ///< of /target too, once a patch has parts
h5::Column movement_column();              ///< of /target too, once a patch has parts
std::vector<h5::Column> hand_columns();    ///< of /hand, a row for each frame
std::vector<h5::Column> plan_columns();    ///< of /plan, a row for each frame
/// Tables of /plan that earlier versions did not write.
inline constexpr const char *kLoop = "loop", *kFocusPhase = "focus_phase";

std::vector<h5::Column> gate_columns();  ///< of /gate, a row for each frame

/// A number of a field's shape in /gate, in SI.
struct ShapeColumn {
  const char* name;
  double FieldShape::*value;
  const char* unit;
  const char* meaning;
};
std::span<const ShapeColumn> shape_columns();

/// The quantities in the column counts of /plan, in order; stage_time holds plan_stages().
std::vector<Quantity<PlanStats>> plan_counts();

}  // namespace prostm::recording
