#include "prostm/study/analysis/adjusted.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <map>

namespace prostm {
namespace {

double mean_of(std::span<const double> values) {
  double sum = 0.0;
  for (const double x : values) sum += x;
  return sum / static_cast<double>(values.size());
}

std::optional<double> deviation_of(std::span<const double> values) {
  if (values.size() < 2) return {};
  const double mean = mean_of(values);
  double squares = 0.0;
  for (const double x : values) squares += (x - mean) * (x - mean);
  return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

/// Completes a result from each participant's levels.
void summarise(const std::map<std::string, std::vector<double>>& levels, double level,
               AdjustedResult& out) {
  std::vector<double> means;
  for (const auto& [participant, own] : levels) {
    out.participants.push_back(
        {participant, static_cast<int>(own.size()), mean_of(own), deviation_of(own)});
    means.push_back(out.participants.back().mean);
  }
  out.mean = mean_of(means);
  out.deviation = deviation_of(means);
  if (!out.deviation) return;
  const auto n = static_cast<double>(means.size());
  const boost::math::students_t t(n - 1.0);
  const double half = boost::math::quantile(t, 0.5 + 0.5 * level) * *out.deviation / std::sqrt(n);
  out.interval = Interval{out.mean - half, out.mean + half};
}

}  // namespace

std::vector<AdjustedResult> adjusted_levels(std::span<const Answer> answers, double level) {
  std::vector<AdjustedResult> out;
  std::vector<std::map<std::string, std::vector<double>>> levels;
  for (const Answer& a : answers) {
    const auto found = std::find_if(out.begin(), out.end(), [&](const AdjustedResult& r) {
      return r.method == a.method && r.scene == a.scene;
    });
    const auto place = static_cast<std::size_t>(found - out.begin());
    if (found == out.end()) {
      AdjustedResult& result = out.emplace_back();
      result.method = a.method;
      result.scene = a.scene;
      levels.emplace_back();
    }
    levels[place][a.participant].push_back(*a.level);
  }
  for (std::size_t i = 0; i < out.size(); ++i) summarise(levels[i], level, out[i]);
  return out;
}

std::string in_words(std::span<const AdjustedResult> results, double level) {
  std::string text;
  for (const AdjustedResult& of : results) {
    text += fmt::format("With {} in {}, it felt alike at {:.4g}", of.method, of.scene, of.mean);
    if (of.interval) {
      text += fmt::format(
          ", the mean of {} participants (standard deviation {:.3g}, {:g} % interval {:.4g} to "
          "{:.4g}). ",
          of.participants.size(), *of.deviation, 100.0 * level, of.interval->low,
          of.interval->high);
    } else {
      text += fmt::format(" for the only participant, {}, which says nothing about other people. ",
                          of.participants.front().participant);
    }
  }
  return text + "Intervals are over participants; each participant's mean counts once.";
}

}  // namespace prostm
