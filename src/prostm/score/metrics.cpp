#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "prostm/score/score.hpp"

namespace prostm {
namespace {

using Member = double Metrics::*;

constexpr std::array<Quantity<Metrics>, 9> kMetrics{{
    {.name = "rmse",
     .unit = "",
     .help = "Root mean square difference over max p*.",
     .value = &Metrics::rmse,
     .better = Better::Less,
     .label = "RMSE"},
    {.name = "correlation",
     .unit = "",
     .help = "Pearson's correlation; 0 if either field is constant.",
     .value = &Metrics::correlation,
     .better = Better::More,
     .label = "corr"},
    {.name = "coverage",
     .unit = "",
     .help = "Share of the sum of p* within sigma of a path.",
     .value = &Metrics::coverage,
     .better = Better::More,
     .label = "cover"},
    {.name = "skill_0",
     .unit = "",
     .help = "1 - min_g sum (p* - g p)^2 / sum (p* - mean)^2; 0 = a flat field.",
     .value = &Metrics::skill_0,
     .better = Better::More,
     .label = "skill_0"},
    {.name = "skill_8",
     .unit = "",
     .help = "skill_0 after a Gaussian blur of both fields by 8.5 mm.",
     .value = &Metrics::skill_8,
     .better = Better::More,
     .label = "skill_8"},
    {.name = "overlap",
     .unit = "",
     .help = "sum min(p*, g p) / sum max(p*, g p), with the g of skill_0.",
     .value = &Metrics::overlap,
     .better = Better::More,
     .label = "overlap"},
    {.name = "spill",
     .unit = "",
     .help = "Share of the rendered field on skin where p* < 0.1 max p*.",
     .value = &Metrics::spill,
     .better = Better::Less,
     .label = "spill"},
    {.name = "felt_skill",
     .unit = "",
     .help = "skill_8 of the percept of the field as an array plays it; NaN without an array.",
     .value = &Metrics::felt_skill,
     .better = Better::More,
     .optional = true,
     .label = "felt"},
    {.name = "sensation_level",
     .unit = "dB",
     .help = "Strongest place of that percept relative to the threshold of touch; NaN without an "
             "array.",
     .value = &Metrics::sensation_level,
     .better = Better::More,
     .optional = true,
     .label = "dB SL"},
}};

/// Applies `of` to the values of each metric; NaN if any value is NaN.
template <class Of>
Metrics each(std::span<const Metrics> all, const Of& of) {
  Metrics out;
  std::vector<double> values(all.size());
  for (const Quantity<Metrics>& quantity : kMetrics) {
    const Member member = std::get<Member>(quantity.value);
    bool known = true;
    for (std::size_t i = 0; i < all.size(); ++i) {
      values[i] = all[i].*member;
      known = known && !std::isnan(values[i]);
    }
    out.*member = known ? of(values) : std::numeric_limits<double>::quiet_NaN();
  }
  return out;
}

}  // namespace

template <>
std::span<const Quantity<Metrics>> quantities<Metrics>() {
  return kMetrics;
}

Metrics mean(std::span<const Metrics> all) {
  return each(all, [](const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) sum += value / static_cast<double>(values.size());
    return sum;
  });
}

Metrics median(std::span<const Metrics> all) {
  return each(all, [](std::vector<double>& values) {
    std::sort(values.begin(), values.end());
    return 0.5 * (values[(values.size() - 1) / 2] + values[values.size() / 2]);
  });
}

}  // namespace prostm
