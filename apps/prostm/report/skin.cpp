#include <algorithm>

#include "prostm/experiments/experiments.hpp"
#include "report/report.hpp"

namespace prostm::app {
namespace {

using Json = nlohmann::ordered_json;

/// Counts the steps of the part for its progress.
class Steps {
 public:
  Steps(const ReportWork& work, double all) : work_(work), all_(all) {}
  experiments::Step step(double weight) {
    return [this, weight] { work_.progress(std::min(1.0, (done_ += weight) / all_)); };
  }

 private:
  const ReportWork& work_;
  double all_, done_ = 0.0;
};

/// Adds the minimum and maximum of values that depend on the skin.
void add_range(Json& row, const std::vector<double>& values) {
  row["low"] = std::ranges::min(values);
  row["high"] = std::ranges::max(values);
}

const std::vector<report::Column> kRange = {{"low", "lowest", "", 1}, {"high", "highest", "", 1}};

std::vector<report::Column> with_range(std::vector<report::Column> columns) {
  columns.insert(columns.end(), kRange.begin(), kRange.end());
  return columns;
}

double peak(const experiments::Curve& curve) {
  return experiments::peak_place(experiments::circle_speeds(), curve.intensity);
}

void add_circles(const ReportWork& work, experiments::Skins skins, Steps& steps, Json& blocks) {
  std::vector<double> circles(experiments::kCircumferences.begin(),
                              experiments::kCircumferences.end());
  if (work.quick) circles = {experiments::kCircumferences[1]};
  const auto all = experiments::circle_curves(circles, skins, steps.step(10.0));
  Json rows = Json::array();
  for (const experiments::CircleCurves& curves : all) {
    Json& row = rows.emplace_back();
    row = {{"circle", 1e3 * curves.circumference},
           {"peak", peak(curves.nominal())},
           {"memoryless", peak(curves.memoryless)}};
    std::vector<double> peaks;
    for (const experiments::Curve& curve : curves.skins) peaks.push_back(peak(curve));
    add_range(row, peaks);
  }
  experiments::draw_circles(all, work.folder.path("skin-circles.svg"));
  blocks.push_back(report::heading_block("Circles"));
  blocks.push_back(report::text_block(
      "Published [Frier 2018]: circles are strongest at 5 to 8 m/s, whatever their size."));
  blocks.push_back(report::table_block(
      "The speed at which a circle feels strongest: on the nominal skin, with transducers that "
      "follow at once, and lowest and highest on all skins [m/s]",
      with_range({{"circle", "circumference", "mm", 0},
                  {"peak", "peak", "m/s", 1},
                  {"memoryless", "no lag", "m/s", 1}}),
      rows));
  blocks.push_back(report::figure_block("skin-circles.svg",
                                        "Strength by speed, on the nominal skin",
                                        "Two charts of strength against speed"));
}

void add_squares(const ReportWork& work, experiments::Skins skins, Steps& steps, Json& blocks) {
  std::vector<double> speeds = {2, 4, 6, 8, 10, 12};
  if (work.quick) speeds = {8};
  Json rows = Json::array();
  for (const double side : experiments::kSquareSides) {
    const auto looks = experiments::square_looks(side, speeds, skins, steps.step(1.0));
    const experiments::SquareLooks& nominal = looks[looks.size() / 2];
    for (std::size_t i = 0; i < speeds.size(); ++i) {
      const auto peaks = std::ranges::count_if(
          looks, [&](const experiments::SquareLooks& of) { return of.rms[i].peak_inside; });
      rows.push_back({{"side", 100.0 * side},
                      {"speed", speeds[i]},
                      {"middle", nominal.rms[i].middle},
                      {"inside", nominal.rms[i].inside},
                      {"width", 1e3 * nominal.rms[i].half_width},
                      {"peaks", peaks}});
    }
  }
  blocks.push_back(report::heading_block("Squares"));
  blocks.push_back(
      report::text_block("Published [Reardon 2023]: a 3-cm square vibrates most inside at 8 to 10 "
                         "m/s; a 1-cm square is "
                         "blurred at all speeds."));
  blocks.push_back(
      report::table_block("The skin's rms velocity under squares, on the nominal skin; the last "
                          "column is the number of "
                          "skins with a maximum in the inner half",
                          {{"side", "side", "cm", 0},
                           {"speed", "speed", "m/s", 0},
                           {"middle", "middle over outline", "", 2},
                           {"inside", "inner half over all", "", 2},
                           {"width", "width of the upper half", "mm", 0},
                           {"peaks", "skins with a maximum inside", "", 0}},
                          rows));
}

void add_lines(const ReportWork& work, experiments::Skins skins, Steps& steps, Json& blocks) {
  std::vector<double> speeds = {2, 4, 5, 6, 7, 8, 10, 12};
  if (work.quick) speeds = {4, 8};
  Json rows = Json::array();
  for (const experiments::SpeedReach& at :
       experiments::line_reaches(speeds, skins, steps.step(3.0))) {
    Json& row = rows.emplace_back();
    row = {{"speed", at.speed},
           {"ahead", 1e3 * at.nominal.ahead},
           {"behind", 1e3 * at.nominal.behind},
           {"ratio", at.nominal.behind / at.nominal.ahead},
           {"even", at.even.behind / at.even.ahead}};
    add_range(row, at.ratios);
  }
  blocks.push_back(report::heading_block("Lines"));
  blocks.push_back(report::text_block(
      "Published [Reardon 2019]: above 4 m/s waves are compressed ahead of a focal point, within "
      "1 cm, and trail behind it."));
  blocks.push_back(report::table_block(
      "How far the skin moves (rms) about a focal point on a straight line, 80 mm ahead and 220 mm "
      "behind; behind over ahead also within 80 mm both ways; its lowest and highest on all skins",
      with_range({{"speed", "speed", "m/s", 0},
                  {"ahead", "ahead", "mm", 1},
                  {"behind", "behind", "mm", 1},
                  {"ratio", "behind over ahead", "", 1},
                  {"even", "within 80 mm", "", 1}}),
      rows));
}

void add_gap(const ReportWork& work, experiments::Skins skins, Steps& steps, Json& blocks) {
  const experiments::GapCurves curves = experiments::gap_curves(skins, steps.step(1.0));
  constexpr double kDips[] = {0.99, experiments::kNoticed};
  Json rows = Json::array();
  const auto gap = [&](const std::vector<double>& dips, double level) {
    const double at = experiments::gap_where(curves.gaps, dips, level);
    return at > 0.0 ? Json(1e3 * at) : Json(nullptr);
  };
  for (const double level : kDips) {
    rows.push_back({{"dip", 100.0 * (1.0 - level)},
                    {"pressure", gap(curves.acoustic, level)},
                    {"felt", gap(curves.felt[curves.felt.size() / 2], level)}});
  }
  experiments::draw_gap(curves, work.folder.path("skin-gap.svg"));
  blocks.push_back(report::heading_block("Two foci"));
  blocks.push_back(report::text_block(
      "Published [Howard 2023]: two foci at 200 Hz merge acoustically below 15 to 18 mm; they feel "
      "like one below 15 mm, and like two to half of all people at 32 mm."));
  blocks.push_back(report::table_block(
      "The gap from which the middle dips so far below the peaks; a dash where it never does",
      {{"dip", "dip", "%", 0}, {"pressure", "pressure", "mm", 1}, {"felt", "felt", "mm", 1}},
      rows));
  blocks.push_back(report::figure_block("skin-gap.svg",
                                        "The middle between two foci over the higher peak",
                                        "A chart of the dip against the gap"));
}

}  // namespace

void make_skin(const ReportWork& work, Json& document) {
  const auto interval = skin_settings_interval();
  std::vector<SkinSettings> skins(interval.begin(), interval.end());
  if (work.quick) skins = {interval[interval.size() / 2]};
  document["values"] = {{"skins", skins.size()}};
  auto& blocks = document["blocks"];
  blocks.push_back(report::text_block(
      "Published experiments with focal points, computed with the model of the skin, whose "
      "parameters were fixed from measurements of skin before. {/values/skins} skins, within the "
      "intervals of what was measured, the nominal one in the middle. docs/experiments says where "
      "the model agrees and where it fails."));
  Steps steps(work, work.full_or_quick(840.0, 200.0));
  add_circles(work, skins, steps, blocks);
  add_squares(work, skins, steps, blocks);
  add_lines(work, skins, steps, blocks);
  add_gap(work, skins, steps, blocks);
}

}  // namespace prostm::app
