#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>

#include "prostm/core/run_all.hpp"
#include "prostm/experiments/experiments.hpp"
#include "prostm/report/findings.hpp"
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
  double all_;
  std::atomic<double> done_ = 0.0;
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

double peak(const experiments::CircleCurves& of, const experiments::Curve& curve) {
  return experiments::peak_place(of.speeds, curve.intensity);
}

using Verdicts = std::vector<report::Verdict>;

constexpr double kNone = -std::numeric_limits<double>::infinity();  // as a published bound
constexpr double kAny = std::numeric_limits<double>::infinity();

/// Extent of the experiments; a quick report has fewer circles and speeds.
struct Extent {
  std::vector<double> circles, square_speeds, line_speeds;
};

Extent extent_of(const ReportWork& work, Json& document) {
  if (work.quick) {
    document["lowered"].push_back("one circle instead of four");
    document["lowered"].push_back("one speed of squares instead of six");
    document["lowered"].push_back("two speeds of lines instead of eight");
    return {{0.1}, {8}, {4, 8}};
  }
  return {{experiments::kCircumferences.begin(), experiments::kCircumferences.end()},
          {2, 4, 6, 8, 10, 12},
          {2, 4, 5, 6, 7, 8, 10, 12}};
}

struct Results {
  std::vector<experiments::CircleCurves> circles;
  std::array<std::vector<experiments::SquareLooks>, experiments::kSquareSides.size()> squares;
  std::vector<experiments::SpeedReach> lines;
  experiments::GapCurves gap;
};

/// Computes all experiments, on two threads.
Results computed(const ReportWork& work, const Extent& extent, experiments::Skins skins) {
  constexpr double kCircle = 10.0, kSquare = 1.0, kLine = 3.0, kGap = 1.0;  // time of a step
  Steps steps(work, work.quick ? 200.0 : 840.0);
  Results out;
  // the longest first
  const std::size_t circles = extent.circles.size(), squares = experiments::kSquareSides.size();
  out.circles.resize(circles);
  WorkerPool pool(2);
  run_all(pool, static_cast<int>(circles + squares + 2), [&](int i) {
    const auto task = static_cast<std::size_t>(i);
    if (task < circles) {
      out.circles[task] = std::move(
          experiments::circle_curves(std::array{extent.circles[task]}, skins, steps.step(kCircle))
              .front());
    } else if (task == circles) {
      out.gap = experiments::gap_curves(skins, steps.step(kGap));
    } else if (task == circles + 1) {
      out.lines = experiments::line_reaches(extent.line_speeds, skins, steps.step(kLine));
    } else {
      const std::size_t side = task - circles - 2;
      out.squares[side] = experiments::square_looks(
          experiments::kSquareSides[side], extent.square_speeds, skins, steps.step(kSquare));
    }
  });
  return out;
}

void add_circles(const ReportWork& work, const std::vector<experiments::CircleCurves>& all,
                 Json& blocks, Verdicts& verdicts) {
  Json rows = Json::array();
  for (const experiments::CircleCurves& curves : all) {
    Json& row = rows.emplace_back();
    row = {{"circle", 1e3 * curves.circumference},
           {"peak", peak(curves, curves.nominal())},
           {"memoryless", peak(curves, curves.memoryless)}};
    std::vector<double> peaks;
    for (const experiments::Curve& curve : curves.skins) peaks.push_back(peak(curves, curve));
    add_range(row, peaks);
    verdicts.push_back(report::compare(
        fmt::format("A circle of {:.0f} mm feels strongest at", 1e3 * curves.circumference),
        peak(curves, curves.nominal()), {5.0, 8.0}, {1, " m/s"}));
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

void add_squares(const Results& results, const std::vector<double>& speeds, Json& blocks,
                 Verdicts& verdicts) {
  Json rows = Json::array();
  for (std::size_t k = 0; k < experiments::kSquareSides.size(); ++k) {
    const double side = experiments::kSquareSides[k];
    const std::vector<experiments::SquareLooks>& looks = results.squares[k];
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
      if (side < 0.03 || speeds[i] < 8.0 || speeds[i] > 10.0) continue;
      const report::Finding of =
          report::squares(static_cast<int>(peaks), static_cast<int>(looks.size()));
      verdicts.push_back({of.agreement, fmt::format("At {:.0f} m/s: {}", speeds[i], of.text)});
    }
  }
  verdicts.push_back(report::not_comparable(
      "A square of 1 cm is published as blurred, without a measure of blur."));
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

void add_lines(const std::vector<experiments::SpeedReach>& reaches, Json& blocks,
               Verdicts& verdicts) {
  Json rows = Json::array();
  double farthest = 0.0, least = kAny;
  for (const experiments::SpeedReach& at : reaches) {
    if (at.speed > 4.0) {
      farthest = std::max(farthest, 1e3 * at.nominal.ahead);
      least = std::min(least, at.even.behind / at.even.ahead);
    }
    Json& row = rows.emplace_back();
    row = {{"speed", at.speed},
           {"ahead", 1e3 * at.nominal.ahead},
           {"behind", 1e3 * at.nominal.behind},
           {"ratio", at.nominal.behind / at.nominal.ahead},
           {"even", at.even.behind / at.even.ahead}};
    add_range(row, at.ratios);
  }
  verdicts.push_back(report::compare("Above 4 m/s waves reach at most this far ahead:", farthest,
                                     {kNone, 10.0}, {1, " mm"}));
  verdicts.push_back(
      report::compare("Above 4 m/s waves trail: distance behind over distance ahead is at least",
                      least, {1.0, kAny}, {1, ""}));
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

void add_gap(const ReportWork& work, const experiments::GapCurves& curves, Json& blocks,
             Verdicts& verdicts) {
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
  verdicts.push_back(
      report::compare("Two foci begin to merge in pressure below a gap of",
                      1e3 * experiments::gap_where(curves.gaps, curves.acoustic, kDips[0]),
                      {15.0, 18.0}, {1, " mm"}));
  verdicts.push_back(
      report::compare("The percept of two foci dips by a Weber fraction from a gap of",
                      1e3 * experiments::gap_where(curves.gaps, curves.felt[curves.felt.size() / 2],
                                                   experiments::kNoticed),
                      {15.0, 32.0}, {1, " mm"}));
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
  if (work.quick) {
    skins = {interval[interval.size() / 2]};
    document["lowered"].push_back(fmt::format("one skin instead of {}", interval.size()));
  }
  document["values"] = {{"skins", skins.size()}};
  auto& blocks = document["blocks"];
  blocks.push_back(report::text_block(
      "Published experiments with focal points, computed with the model of the skin, whose "
      "parameters were fixed from measurements of skin before. {/values/skins} skins, within the "
      "intervals of what was measured, the nominal one in the middle. docs/experiments says where "
      "the model agrees and where it fails."));
  const Extent extent = extent_of(work, document);
  const Results results = computed(work, extent, skins);
  Verdicts verdicts;
  add_circles(work, results.circles, blocks, verdicts);
  add_squares(results, extent.square_speeds, blocks, verdicts);
  add_lines(results.lines, blocks, verdicts);
  add_gap(work, results.gap, blocks, verdicts);
  report::add_verdicts(blocks, verdicts);
}

}  // namespace prostm::app
