#pragma once
/// Labelled pictures of fields, plans and the scene, as PNG, SVG or PDF by file extension.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "prostm/plan/planner.hpp"
#include "prostm/score/felt.hpp"
#include "prostm/score/physical.hpp"
#include "prostm/score/score.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm {

/// Checks early that a picture can be written. @throws InputError: the name does not end in .png,
/// .svg or .pdf, or the file cannot be written.
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
/// reconstruction; if the trace is empty because the preset has no such steps, only target, paths
/// and reconstruction; foci instead of paths, if the plan has foci. With axes in mm, one colour bar
/// for the fields, the length of each path, and the table. The panels of `beside`, a plan for the
/// same target, are below, and its metrics are in the table. @throws InputError when the file
/// cannot be written.
void draw_plan(const PlanFigure& figure, const std::string& path,
               const PlanFigure* beside = nullptr);

/// One planner's plan of a target.
struct GalleryPlan {
  std::string name;
  Plan plan;
  std::vector<double> rendered;  ///< Eq. (1), rows·cols of the target
  Metrics metrics;
  std::string second_caption = {};  ///< a line under the metrics
};
/// A target and each planner's plan of it.
struct GalleryField {
  std::string name;
  TargetField target;
  std::vector<GalleryPlan> plans;  ///< the same planners in the same order for every field
};
/// The number next to the RMSE under each plan.
enum class GalleryCaption : std::uint8_t { Skill, Correlation };
struct GalleryPage {
  std::string title;
  std::string note = {};  ///< a line under the explanation of the picture
  GalleryCaption caption = GalleryCaption::Skill;
  std::size_t fields_in_row = 3;  ///< ≥ 1
};
/// Draws for each field its target and, next to it, every plan's field with the paths or foci, all
/// coloured by pressure over the target's maximum. Under each plan are RMSE and skill_8, with the
/// best RMSE in bold, or RMSE and correlation without bold. @throws std::invalid_argument: no
/// field, different numbers of plans, or inconsistent sizes. @throws InputError when the file
/// cannot be written.
void draw_gallery(const GalleryPage& page, const std::vector<GalleryField>& fields,
                  const std::string& path);

/// The pressure of an array on the skin, and its target.
struct PhysicalFigure {
  const TargetField* raster = nullptr;  ///< the skin; the target if it is known
  const Plan* plan = nullptr;
  const PhysicalField* field = nullptr;
  const FeltField* felt = nullptr;  ///< the percept; null: not computed
  bool has_target = false;          ///< whether the raster is a target
  std::string title, summary;       ///< a line each
};
/// Draws panels side by side: target, envelope and percept, each over its own maximum, and the
/// difference of the percept (scaled as for its score) and the target, over the target's maximum;
/// the mean instead of the percept, and the difference of the envelope, if the percept is unknown.
/// Without a target the first and the last panel are omitted. With axes in mm and the paths.
/// @throws InputError when the file cannot be written.
void draw_physical(const PhysicalFigure& figure, const std::string& path);

/// A separate point of a chart.
struct ChartDot {
  double x = 0.0, y = 0.0;
  double area = 1.0;  ///< relative to the chart's other dots; > 0
};
/// An interval along x, with a value.
struct ChartSpan {
  double low = 0.0, value = 0.0, high = 0.0, y = 0.0;  ///< infinite: unbounded on that side
};
/// One line of a chart; x ascends.
struct ChartSeries {
  std::string name;
  std::vector<double> x, y;              ///< same number of each; > 0 on a logarithmic axis
  std::vector<std::string> labels = {};  ///< of the points: none, or one for each; a label that
                                         ///< would touch the previous one is omitted
  std::vector<ChartDot> dots = {};       ///< with dots, the line has no markers, and may be empty
  std::optional<ChartSpan> span = {};    ///< drawn without overlapping those of other series
};
struct Chart {
  std::string title, x_label, y_label;
  bool logarithmic_x = true;  ///< else linear
  std::vector<ChartSeries> series;
  bool logarithmic_y = true;  ///< else linear
};
/// Draws charts in rows, with a faint line of slope 1 if both axes are logarithmic. @param in_row
/// number of charts side by side; 0: all. @throws std::invalid_argument: no chart, or a chart
/// without points, with values that are not finite or, on a logarithmic axis, not positive, or with
/// labels for only some points. @throws InputError when the file cannot be written.
void draw_charts(const std::vector<Chart>& charts, const std::string& path, std::size_t in_row = 0);

/// A share with its interval and the individual values, all 0..1.
struct ShareBar {
  double share = 0.0, low = 0.0, high = 0.0;
  std::vector<double> dots = {};  ///< e.g. each participant's own share
};
/// A bracket that joins two bars of a group.
struct ShareBracket {
  std::size_t from = 0, to = 1;
  std::vector<std::string> lines;  ///< text above it
};
struct ShareGroup {
  std::string name;
  std::vector<ShareBar> bars;
  std::vector<ShareBracket> brackets = {};
};
struct ShareFigure {
  std::string title, y_label;
  std::vector<std::string> names;  ///< names of the bars, the same in each group
  std::vector<ShareGroup> groups;
  double chance = 0.5;  ///< drawn as a horizontal line, 0..1
  std::string note;     ///< under the picture
};
/// Draws groups of bars in per cent, like the paper's Fig. 4, with intervals, dots (side by side if
/// they would overlap), stacked brackets, and a line at chance. Texts that are too long end in "…".
/// @throws std::invalid_argument: no group or name, a group without exactly one bar for each name,
/// a value outside 0..1, or a bracket without two bars. @throws InputError when the file cannot be
/// written.
void draw_shares(const ShareFigure& figure, const std::string& path);

/// A map over a raster of a plane.
struct FieldMap {
  std::string title, note;  ///< above and below the map
  int rows = 0, cols = 0;
  double cell = 0.0;           ///< [m]
  std::vector<double> values;  ///< rows·cols, >= 0; the largest is at the end of the colour map
  std::vector<Vec2> outline = {};  ///< closed line over it, if any, from its middle [m]
};
struct MapFigure {
  std::string title, scale;  ///< title of the figure, and label of the colour bar
  int columns = 1;
  std::vector<FieldMap> maps;
};
/// Draws maps in rows, with one colour bar. @throws std::invalid_argument: no map or column, or a
/// map without exactly one value for each cell. @throws InputError when the file cannot be written.
void draw_maps(const MapFigure& maps, const std::string& path);

/// One instant of the whole pipeline.
struct SceneFigure {
  // the scene from the side: the x–z plane through the hand's middle, frame D
  int nx = 0, nz = 0;              ///< cells of the slice
  double cell = 0;                 ///< [m]
  Vec2 origin = Vec2::Zero();      ///< centre of the slice's cell (0, 0), (x, z) [m]
  std::vector<float> smoke;        ///< nx·nz, 0..1, x fastest: largest along y
  std::vector<std::uint8_t> hand;  ///< nx·nz, 1 where there is a hand at any y
  std::vector<Vec3> foci;          ///< focal points of the last loop, in D [m]
  std::vector<Vec2> array;         ///< transducers (x, z) [m]
  // the field on the skin
  std::vector<TargetField> targets;  ///< one patch per hand
  std::vector<std::vector<double>> reconstructions;
  Plan plan;
  std::string title;
};
/// Draws the scene from the side with array, smoke, hand, focal points and the planes of the
/// targets; next to it target and reconstruction with the paths. Axes along a target's plane are 0
/// above the array's middle. @throws std::invalid_argument: inconsistent sizes, or an upright
/// plane.
void draw_scene(const SceneFigure& figure, const std::string& path);

/// The positions of an array's transducers.
struct ArrayFigure {
  std::string title;
  std::vector<Vec3> position;  ///< in D [m]
  std::vector<int> unit;       ///< unit of each transducer, from 0; each unit has its own colour
  double radius = 4.5e-3;      ///< of a transducer [m]
};
/// Draws the array seen from above, with D's axes and origin, and transducer 0 marked. @throws
/// std::invalid_argument: no transducer, or a number of units other than that of transducers.
/// @throws InputError when the file cannot be written.
void draw_array(const ArrayFigure& figure, const std::string& path);

}  // namespace prostm
