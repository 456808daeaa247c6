#include "prostm/io/detail/recording_layout.hpp"

#include <array>
#include <string>
#include <variant>

#include "prostm/plan/plan.hpp"
#include "prostm/stimulus/stimulus_gate.hpp"
#include "prostm/target/target_field.hpp"
#include "prostm/track/hand_frame.hpp"

namespace prostm::recording {
namespace {

std::string names_of(std::span<const Quantity<PlanStats>> numbers) {
  std::string names;
  for (const Quantity<PlanStats>& number : numbers)
    names += (names.empty() ? "" : ", ") + std::string(number.name);
  return names;
}

/// Returns "0 none, 1 no-hand, …".
std::string gate_problems() {
  std::string text;
  for (std::size_t i = 0; i < kNames<GateProblem>.size(); ++i) {
    text += (i == 0 ? "" : ", ") + std::to_string(i) + " " + std::string(kNames<GateProblem>[i]);
  }
  return text;
}

constexpr std::array<ShapeColumn, 7> kShape{{
    {"largest", &FieldShape::largest, "Pa", "largest pressure"},
    {"balance", &FieldShape::balance, "1", "the least of the maxima over the largest"},
    {"saddle", &FieldShape::saddle, "1",
     "highest level at which two maxima join, over the largest pressure"},
    {"least_spacing", &FieldShape::least_spacing, "m", "least distance of two maxima"},
    {"most_spacing", &FieldShape::most_spacing, "m",
     "largest distance of a maximum to its nearest other"},
    {"area", &FieldShape::area, "m2", "of at least half of the largest pressure"},
    {"force", &FieldShape::force, "N", "total force"},
}};

}  // namespace

std::span<const ShapeColumn> shape_columns() {
  return kShape;
}

std::vector<h5::Column> gate_columns() {
  const hsize_t most = FieldShape::kMaxMaxima;
  std::vector<h5::Column> columns = {
      {"passed", H5T_NATIVE_INT32, {}, "1", "1 = yes, 0 = no, -1 = nothing was asked"},
      {"share", H5T_NATIVE_DOUBLE, {}, "1", "of the last second's frames that have no problem"},
      {"problem", H5T_NATIVE_INT32, {}, "1", gate_problems()},
      {"value", H5T_NATIVE_DOUBLE, {}, "SI", "what the problem is about"},
      {"wanted", H5T_NATIVE_DOUBLE, {}, "SI", "the bound that it passes, or what the scene has"},
      {"away", H5T_NATIVE_DOUBLE, {2}, "m", "of the palm from the jets, where that is the problem"},
      {"maxima", H5T_NATIVE_INT32, {}, "1", "maxima of the target, of the first patch"},
      {"position",
       H5T_NATIVE_DOUBLE,
       {most, 2},
       "m",
       "of the maxima in the plane, padded with NaN"},
      {"pressure", H5T_NATIVE_DOUBLE, {most}, "Pa", "of the maxima, padded with NaN"}};
  for (const ShapeColumn& number : kShape)
    columns.push_back({number.name, H5T_NATIVE_DOUBLE, {}, number.unit, number.meaning});
  return columns;
}

std::vector<h5::Column> frame_columns() {
  return {{"time", H5T_NATIVE_DOUBLE, {}, "s", "time of the hand frame"},
          {"first_patch", H5T_NATIVE_INT64, {}, "1", "row of the frame's first patch in /target"},
          {"patches", H5T_NATIVE_INT32, {}, "1", "number of patches, one for each hand"}};
}

std::vector<h5::Column> target_columns() {
  return {{"frame", H5T_NATIVE_INT64, {}, "1", "row of the patch's frame in /frame"},
          {"rows", H5T_NATIVE_INT32, {}, "1", "rows of the raster"},
          {"cols", H5T_NATIVE_INT32, {}, "1", "columns of the raster"},
          {"offset",
           H5T_NATIVE_INT64,
           {},
           "1",
           "index of the raster's first cell in pressure and height"},
          {"cell", H5T_NATIVE_DOUBLE, {}, "m", "edge of a cell"},
          {"origin", H5T_NATIVE_DOUBLE, {2}, "m", "centre of the first cell in the plane, (x, y)"},
          {"pose",
           H5T_NATIVE_DOUBLE,
           {4, 4},
           "1, last column m",
           "X_DP: plane coordinates to the device's"},
          {"pressure",
           H5T_NATIVE_DOUBLE,
           {},
           "Pa",
           "rasters row by row, one after another; NaN = no skin"},
          {"height",
           H5T_NATIVE_DOUBLE,
           {},
           "m",
           "of the skin along the plane's normal, like pressure"}};
}

h5::Column weight_column() {
  return {"weight",
          H5T_NATIVE_DOUBLE,
          {},
          "1",
          "how much the error of a cell counts, like pressure; NaN = no skin, or no weights"};
}

h5::Column smoke_column() {
  return {
      "smoke",
      H5T_NATIVE_DOUBLE,
      {},
      "Pa",
      "part of the smoke that blows, of either sign, like pressure; NaN = no skin, or not known"};
}

h5::Column movement_column() {
  return {"movement",
          H5T_NATIVE_DOUBLE,
          {},
          "Pa",
          "part of the hand's own movement, of either sign, like pressure; NaN = no skin, or not "
          "known"};
}

std::vector<h5::Column> hand_columns() {
  return {
      {"id",
       H5T_NATIVE_INT64,
       {kHands},
       "1",
       "stays with a hand while it is tracked; -1 = no hand"},
      {"side", H5T_NATIVE_INT32, {kHands}, "1", "0 = left, 1 = right, -1 = no hand"},
      {"confidence", H5T_NATIVE_FLOAT, {kHands}, "1", "of the tracker, 0 to 1; NaN = no hand"},
      {"inferred",
       H5T_NATIVE_UINT32,
       {kHands},
       "1",
       "bit 0: metacarpals were rebuilt, bit 1: the wrist"},
      {"position",
       H5T_NATIVE_FLOAT,
       {kHands, kJointCount, 3},
       "m",
       "joints in OpenXR's order, frame D"},
      {"orientation",
       H5T_NATIVE_FLOAT,
       {kHands, kJointCount, 4},
       "1",
       "unit quaternions x, y, z, w"},
      {"radius", H5T_NATIVE_FLOAT, {kHands, kJointCount}, "m", "of the flesh around each joint"},
      {"velocity", H5T_NATIVE_FLOAT, {kHands, kJointCount, 3}, "m/s", "of each joint"}};
}

std::vector<Quantity<PlanStats>> plan_counts() {
  std::vector<Quantity<PlanStats>> counts;
  for (const Quantity<PlanStats>& quantity : quantities<PlanStats>()) {
    if (std::holds_alternative<int PlanStats::*>(quantity.value)) counts.push_back(quantity);
  }
  return counts;
}

std::vector<h5::Column> plan_columns() {
  const hsize_t paths = kMaxPaths, points = kMaxPathPoints;
  return {
      {"paths", H5T_NATIVE_INT32, {}, "1", "number of paths; -1 = no plan was made in this frame"},
      {"samples", H5T_NATIVE_INT32, {paths}, "1", "points of each path"},
      {"patch",
       H5T_NATIVE_INT32,
       {paths},
       "1",
       "the frame's patch that a path lies on; -1 = no path"},
      {"points",
       H5T_NATIVE_DOUBLE,
       {paths, points, 2},
       "m",
       "in the patch's plane, padded with NaN"},
      {"pressure",
       H5T_NATIVE_DOUBLE,
       {paths, points},
       "Pa",
       "rendered at each point, padded with NaN"},
      {"length", H5T_NATIVE_DOUBLE, {paths}, "m", "of each closed path"},
      {"speed", H5T_NATIVE_DOUBLE, {paths}, "m/s", "of the focal point, as played"},
      {"period", H5T_NATIVE_DOUBLE, {paths}, "s", "of a lap, as played"},
      {"foci", H5T_NATIVE_INT32, {}, "1", "number of foci of the method am; -1 as of paths"},
      {"focus_patch",
       H5T_NATIVE_INT32,
       {paths},
       "1",
       "the frame's patch that a focus lies on; -1 = no focus"},
      {"focus_position",
       H5T_NATIVE_DOUBLE,
       {paths, 2},
       "m",
       "in the patch's plane, padded with NaN"},
      {"focus_pressure",
       H5T_NATIVE_DOUBLE,
       {paths},
       "Pa",
       "rendered at the peak of the modulation, padded with NaN"},
      {kFocusPhase,
       H5T_NATIVE_DOUBLE,
       {paths},
       "1",
       "delay of the modulation as a share of its period, padded with NaN"},
      {kLoop,
       H5T_NATIVE_DOUBLE,
       {},
       "s",
       "period in which all paths come round together; 0 = each goes round on its own"},
      {"stage_time", H5T_NATIVE_DOUBLE, {kPlanStages}, "s", names_of(plan_stages())},
      {"counts", H5T_NATIVE_INT32, {plan_counts().size()}, "1", names_of(plan_counts())},
      {"cost", H5T_NATIVE_DOUBLE, {}, "1", "of Eqs. (2) to (5) after refinement"},
      {"full_scale_pressure", H5T_NATIVE_DOUBLE, {}, "Pa", "rendered pressure at intensity 1"},
      {"sigma",
       H5T_NATIVE_DOUBLE,
       {kMaxPatches},
       "m",
       "fall-off of a focal point that each patch was planned with, padded with NaN"}};
}

}  // namespace prostm::recording
