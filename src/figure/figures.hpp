#pragma once
/// Labelled pictures of fields, plans and the scene; PNG or SVG by the ending of the name.

#include <cstdint>
#include <string>
#include <vector>

#include "plan/planner.hpp"
#include "score/score.hpp"
#include "target/target_field.hpp"

namespace prostm {

/// Tries whether a picture could be written, before the work that it is to show. @throws
/// InputError: the name ends in neither .png nor .svg, or the file cannot be written.
void check_figure(const std::string& path);

/// What the six panels of the paper's Fig. 2 show.
struct PlanFigure {
  const TargetField* target = nullptr;
  const Plan* plan = nullptr;
  const PlanTrace* trace = nullptr;
  std::vector<double> reconstruction;  ///< Eq. (1), rows·cols
  Metrics metrics;
  std::vector<Control> controls;  ///< drawn as a table under the panels
  std::string title;
};
/// (a) target, (b) clusters, (c) initial tour, (d) split tours, (e) refined paths, (f)
/// reconstruction, with axes in mm, one colour bar for (a) and (f), a length for each path, and the
/// table. The panels of `beside`, a plan for the same target, stand under them and its metrics in
/// the table. @throws InputError when the file cannot be written.
void draw_plan(const PlanFigure& figure, const std::string& path,
               const PlanFigure* beside = nullptr);

/// One instant of the whole pipeline.
struct SceneFigure {
  // the scene from the side: the x–z plane through the hand's middle, frame D
  int nx = 0, nz = 0;              ///< cells of the slice
  double cell = 0;                 ///< [m]
  Vec2 origin = Vec2::Zero();      ///< centre of the slice's cell (0, 0), (x, z) [m]
  std::vector<float> smoke;        ///< nx·nz, 0..1, x fastest: largest along y
  std::vector<std::uint8_t> hand;  ///< nx·nz, 1 where a hand is in front or behind
  std::vector<Vec3> foci;          ///< the focal points of the last lap in D [m]
  std::vector<Vec2> array;         ///< transducers (x, z) [m]
  // the field on the skin
  std::vector<TargetField> targets;  ///< a patch per hand
  std::vector<std::vector<double>> reconstructions;
  Plan plan;
  std::string title;
};
/// The scene from the side with array, smoke, hand and focal points; beside it target and
/// reconstruction with the paths.
void draw_scene(const SceneFigure& figure, const std::string& path);

}  // namespace prostm
