#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "prostm/figure/figures.hpp"
#include "study/study.hpp"

namespace prostm::app {
namespace {

/// Returns brackets that join methods that differ by either test, with both p values.
std::vector<ShareBracket> brackets_of(const SceneResult& scene, double alpha) {
  std::vector<ShareBracket> out;
  const auto place = [&](const std::string& method) {
    const auto at = std::find_if(scene.methods.begin(), scene.methods.end(),
                                 [&](const MethodResult& m) { return m.method == method; });
    return static_cast<std::size_t>(at - scene.methods.begin());
  };
  for (const Comparison& of : scene.comparisons) {
    const bool over_people = of.permutation && of.permutation->p < alpha;
    if (of.pooled_z.p >= alpha && !over_people) continue;
    std::vector<std::string> lines = {"answers: " + p_in_words(of.pooled_z.p)};
    if (of.permutation) lines.push_back("participants: " + p_in_words(of.permutation->p));
    out.push_back({place(of.first), place(of.second), lines});
  }
  return out;
}

ShareFigure share_figure(const Analysis& analysis) {
  const double alpha = 1.0 - analysis.settings.level;
  ShareFigure out;
  const std::size_t people = analysis.participants.size();
  out.title = fmt::format("Right answers of {} participant{}", people, people == 1 ? "" : "s");
  out.y_label = "right answers / %";
  out.chance = analysis.settings.chance;
  for (const MethodResult& m : analysis.scenes.front().methods) out.names.push_back(m.method);
  for (const SceneResult& scene : analysis.scenes) {
    ShareGroup& group = out.groups.emplace_back();
    group.name = scene_name(scene);
    for (const MethodResult& m : scene.methods) {
      group.bars.push_back({m.correct.value(), m.interval.low, m.interval.high, m.of_participants});
    }
    group.brackets = brackets_of(scene, alpha);
  }
  out.note = fmt::format(
      "Dots: each participant's own share. Lines: Wilson's {:g} % intervals, as if all answers "
      "were independent.",
      100.0 * analysis.settings.level);
  const bool any = std::ranges::any_of(
      out.groups, [](const ShareGroup& group) { return !group.brackets.empty(); });
  if (any) {
    out.note += fmt::format(
        " Brackets: where either p is below {:.2g}, that of the pooled z over answers, which takes "
        "them as independent, or that of the permutation over participants, which holds for other "
        "people. No p is corrected for the number of comparisons.",
        alpha);
  } else if (out.names.size() > 1) {
    out.note += fmt::format(
        " No two methods differ with p below {:.2g}, neither by the pooled z over answers nor by "
        "the permutation over participants.",
        alpha);
  }
  return out;
}

/// The curve over all levels and the threshold's interval.
void add_curve(const PsychometricFit& fit, ChartSeries& series) {
  constexpr int kPoints = 200;
  const Psychometric& psi = fit.function;
  double low = std::min(series.dots.front().x, psi.threshold),
         high = std::max(series.dots.back().x, psi.threshold);
  ChartSpan span{-HUGE_VAL, psi.threshold, HUGE_VAL, 100.0 * psi.at(psi.threshold)};
  if (fit.threshold) {
    span.low = fit.threshold->low;
    span.high = fit.threshold->high;
    if (std::isfinite(span.low)) low = std::min(low, span.low);
    if (std::isfinite(span.high)) high = std::max(high, span.high);
  }
  for (int i = 0; i <= kPoints; ++i) {
    const double x = std::lerp(low, high, static_cast<double>(i) / kPoints);
    series.x.push_back(x);
    series.y.push_back(100.0 * psi.at(x));
  }
  series.span = span;
}

/// A chart for each scene, a curve for each method; all participants together.
std::vector<Chart> threshold_charts(const Analysis& analysis) {
  std::vector<Chart> charts;
  for (const ThresholdResult& of : analysis.thresholds) {
    if (!of.participant.empty()) continue;
    if (charts.empty() || charts.back().title != of.scene) {
      Chart& chart = charts.emplace_back();
      chart.title = of.scene;
      chart.x_label = fmt::format("level (bars: thresholds with {:g} % intervals)",
                                  100.0 * analysis.settings.level);
      chart.y_label =
          analysis.kind == AnswerKind::Felt ? "answers for the level / %" : "right answers / %";
      chart.logarithmic_x = chart.logarithmic_y = false;
    }
    ChartSeries& series = charts.back().series.emplace_back();
    series.name = of.fit ? of.method : "no fit: " + of.method;
    for (const LevelScore& score : of.scores) {
      series.dots.push_back(
          {score.level, 100.0 * score.correct.value(), static_cast<double>(score.correct.trials)});
    }
    if (of.fit) add_curve(*of.fit, series);
  }
  return charts;
}

}  // namespace

void draw_analysis(const Analysis& analysis, const std::string& path) {
  constexpr std::size_t kInRow = 3;
  if (analysis.thresholds.empty()) {
    draw_shares(share_figure(analysis), path);
  } else {
    draw_charts(threshold_charts(analysis), path, kInRow);
  }
}

}  // namespace prostm::app
