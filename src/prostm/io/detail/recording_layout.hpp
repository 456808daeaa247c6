#pragma once
/// The datasets of a recording, described in docs/guides/recordings.md. Private to io.

#include <span>
#include <vector>

#include "prostm/io/detail/hdf5.hpp"
#include "prostm/plan/plan_stats.hpp"
#include "prostm/target/field_shape.hpp"

namespace prostm::recording {

inline constexpr hsize_t kHands = 2;  ///< hands per row of /hand

std::vector<h5::Column> frame_columns();   ///< of /frame
std::vector<h5::Column> target_columns();  ///< of /target, one row per patch
h5::Column weight_column();                ///< of /target, created when a patch first has weights
h5::Column smoke_column();                 ///< of /target, created when a patch first has parts
h5::Column movement_column();              ///< of /target, created when a patch first has parts
std::vector<h5::Column> hand_columns();    ///< of /hand, one row per frame
std::vector<h5::Column> plan_columns();    ///< of /plan, one row per frame
/// Tables of /plan that earlier versions did not write.
inline constexpr const char *kLoop = "loop", *kFocusPhase = "focus_phase";

std::vector<h5::Column> gate_columns();  ///< of /gate, one row per frame

/// A number in /gate that describes a field's shape, in SI.
struct ShapeColumn {
  const char* name;
  double FieldShape::*value;
  const char* unit;
  const char* meaning;
};
std::span<const ShapeColumn> shape_columns();

/// The quantities in the column counts of /plan, in order. (The column stage_time has those of
/// plan_stages().)
std::vector<Quantity<PlanStats>> plan_counts();

}  // namespace prostm::recording
