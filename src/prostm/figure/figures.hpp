#pragma once
/// Labelled pictures of fields, plans and the scene; PNG, SVG or PDF by the ending of the name.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "prostm/plan/planner.hpp"
#include "prostm/score/physical.hpp"
#include "prostm/score/score.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm {

/// Tries whether a picture could be written, before the work that it is to show. @throws
/// InputError: the name ends in none of .png, .svg and .pdf, or the file cannot be written.
void check_figure(const std::string& path);

/// The data of the panels of the paper's Fig. 2.
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
/// reconstruction; where the trace is empty, since the preset has no such steps, only target, paths
/// and reconstruction; foci take the place of paths. With axes in mm, one colour bar for the
/// fields, a length for each path, and the table. The panels of `beside`, a plan for the same
/// target, stand under them and its metrics in the table. @throws InputError when the file cannot
/// be written.
void draw_plan(const PlanFigure& figure, const std::string& path,
               const PlanFigure* beside = nullptr);

/// One planner's plan of a target.
struct GalleryPlan {
  std::string name;
  Plan plan;
  std::vector<double> rendered;  ///< Eq. (1), rows·cols of the target
  Metrics metrics;
};
/// A target, and what each planner makes of it.
struct GalleryField {
  std::string name;
  TargetField target;
  std::vector<GalleryPlan> plans;  ///< the same planners in the same order for every field
};
/// The number beside the RMSE under each plan.
enum class GalleryCaption : std::uint8_t { Skill, Correlation };
struct GalleryPage {
  std::string title;
  std::string note = {};  ///< a line under the one that explains the picture
  GalleryCaption caption = GalleryCaption::Skill;
  std::size_t fields_in_row = 3;  ///< ≥ 1
};
/// For each field its target and beside it every plan's field with the paths or foci, all coloured
/// by pressure over the target's maximum; RMSE and skill_8 under each plan, those of the better
/// RMSE in bold, or RMSE and correlation, none in bold. @throws std::invalid_argument: no field,
/// plans that differ in number, or sizes that disagree. @throws InputError when the file cannot be
/// written.
void draw_gallery(const GalleryPage& page, const std::vector<GalleryField>& fields,
                  const std::string& path);

/// The pressure that an array puts on the skin, and its target.
struct PhysicalFigure {
  const TargetField* raster = nullptr;  ///< the skin; the target if it is known
  const Plan* plan = nullptr;
  const PhysicalField* field = nullptr;
  const Metrics* metrics = nullptr;  ///< of the envelope; without them there is no target to show
  std::string title;
};
/// Panels beside each other: the target, the envelope and the mean, each over its own largest
/// value, and the envelope, scaled as it is scored, minus the target, over the target's largest;
/// without a target only the two in the middle. With axes in mm and the paths. @throws InputError
/// when the file cannot be written.
void draw_physical(const PhysicalFigure& figure, const std::string& path);

/// One point beside a chart's lines.
struct ChartDot {
  double x = 0.0, y = 0.0;
  double area = 1.0;  ///< in proportion to those of the chart's other dots; > 0
};
/// An interval along x, with a value in it.
struct ChartSpan {
  double low = 0.0, value = 0.0, high = 0.0, y = 0.0;  ///< infinite: open to that side
};
/// One line of a chart; x ascends.
struct ChartSeries {
  std::string name;
  std::vector<double> x, y;              ///< as many of each; > 0 on a logarithmic axis
  std::vector<std::string> labels = {};  ///< of the points: none, or one for each; what
                                         ///< would touch the one before is left out
  std::vector<ChartDot> dots = {};       ///< where there are any, the line has no marks of its own
                                         ///< and may have no points
  std::optional<ChartSpan> span = {};    ///< drawn beside those of other series, not over them
};
struct Chart {
  std::string title, x_label, y_label;
  bool logarithmic_x = true;  ///< else linear
  std::vector<ChartSeries> series;
  bool logarithmic_y = true;  ///< else linear
};
/// Charts in rows, with a faint line of slope 1 where both axes are logarithmic. @param in_row
/// charts side by side; 0: all. @throws std::invalid_argument: no chart, or a chart without points
/// or with values that are not finite or have no logarithm where one is taken, or labels for only
/// some points. @throws InputError when the file cannot be written.
void draw_charts(const std::vector<Chart>& charts, const std::string& path, std::size_t in_row = 0);

/// A share with its interval and what it is made of, all 0..1.
struct ShareBar {
  double share = 0.0, low = 0.0, high = 0.0;
  std::vector<double> dots = {};  ///< e.g. each participant's own share
};
/// Joins two bars of a group.
struct ShareBracket {
  std::size_t from = 0, to = 1;
  std::vector<std::string> lines;  ///< above it
};
struct ShareGroup {
  std::string name;
  std::vector<ShareBar> bars;
  std::vector<ShareBracket> brackets = {};
};
struct ShareFigure {
  std::string title, y_label;
  std::vector<std::string> names;  ///< of the bars, the same in each group
  std::vector<ShareGroup> groups;
  double chance = 0.5;  ///< a line across, 0..1
  std::string note;     ///< under the picture
};
/// Groups of bars in per cent, as the paper's Fig. 4: intervals, dots side by side where they would
/// cover each other, brackets one over the other, and a line at chance. What is too long for its
/// place ends in "…". @throws std::invalid_argument: no group or name, a group whose bars are not
/// one for each name, a value outside 0..1, or a bracket without two bars. @throws InputError when
/// the file cannot be written.
void draw_shares(const ShareFigure& figure, const std::string& path);

/// A map over a raster of a plane.
struct FieldMap {
  std::string title, note;  ///< above and below it
  int rows = 0, cols = 0;
  double cell = 0.0;               ///< [m]
  std::vector<double> values;      ///< rows·cols, >= 0; the largest is at the end of the colours
  std::vector<Vec2> outline = {};  ///< a closed line over it, or none [m] from its middle
};
struct MapFigure {
  std::string title, scale;  ///< of the whole, and what stands beside the colour bar
  int columns = 1;
  std::vector<FieldMap> maps;
};
/// Maps in rows, with one colour bar. @throws std::invalid_argument: no map or column, or a map
/// whose values are not one for each cell. @throws InputError when the file cannot be written.
void draw_maps(const MapFigure& maps, const std::string& path);

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
/// The scene from the side with array, smoke, hand, focal points and the planes of the targets;
/// beside it target and reconstruction with the paths. Axes along a target's plane read 0 above the
/// array's middle. @throws std::invalid_argument: sizes that disagree, or an upright plane.
void draw_scene(const SceneFigure& figure, const std::string& path);

/// Where the transducers of an array are.
struct ArrayFigure {
  std::string title;
  std::vector<Vec3> position;  ///< in D [m]
  std::vector<int> unit;       ///< of each transducer, from 0; each has a colour of its own
  double radius = 4.5e-3;      ///< of a transducer [m]
};
/// The array seen from above, with D's axes and origin, and transducer 0 marked.
/// @throws std::invalid_argument: no transducer, or not as many units as transducers. @throws
/// InputError when the file cannot be written.
void draw_array(const ArrayFigure& figure, const std::string& path);

}  // namespace prostm
