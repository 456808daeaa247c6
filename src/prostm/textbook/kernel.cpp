#include "prostm/textbook/kernel.hpp"

#include <algorithm>

#include "prostm/core/random.hpp"
#include "prostm/core/stage_timer.hpp"
#include "prostm/target/pressure_share.hpp"

// The baseline is compiled for every instruction set and dispatched at run time, so that one
// program runs everywhere and is as fast as one compiled for the present processor.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "prostm/textbook/kernel.cpp"
#include <hwy/foreach_target.h>
// after the line above, which includes this file once for each target
#include <hwy/highway.h>

#include "prostm/textbook/descent-inl.hpp"
#include "prostm/textbook/initial_paths-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace prostm::textbook {
namespace HWY_NAMESPACE {
namespace {

double maximum_on_skin(const Field& field) {
  double maximum = 0.0;
  const auto cells = static_cast<std::size_t>(field.rows) * static_cast<std::size_t>(field.cols);
  for (std::size_t i = 0; i < cells; ++i) {
    if (field.skin[i] != 0) maximum = std::max(maximum, field.pressure[i]);
  }
  return maximum;
}

Points strong_points(const Field& field, double maximum, double weak) {
  Points points;
  const double least = pressure_share(weak, 1.0);  // rounded like the cells
  for (int j = 0; j < field.rows; ++j) {
    for (int i = 0; i < field.cols; ++i) {
      const auto at = static_cast<std::size_t>(j) * static_cast<std::size_t>(field.cols) +
                      static_cast<std::size_t>(i);
      const double share = pressure_share(field.pressure[at], maximum);
      if (field.skin[at] == 0 || share < least) continue;
      points.x.push_back(field.cell * i);
      points.y.push_back(field.cell * j);
      points.weight.push_back(share);
    }
  }
  return points;
}

/// See run().
Result Run(const Field& field, const Settings& s) {
  StageTimer total, timer;
  Result result;
  const double maximum = maximum_on_skin(field);
  if (!(maximum > 0.0)) return result;
  Random random(s.seed);
  const Points points = strong_points(field, maximum, s.weak_pressure);
  const Bicubic raster(field, maximum);
  result.init = timer.lap();

  const Points clusters =
      lloyd(points, s.clusters, s.lloyd_iterations, random, result.lloyd_iterations);
  result.clusters = static_cast<int>(clusters.size());
  result.kmeans = timer.lap();

  Tour whole(clusters.size());
  for (std::size_t i = 0; i < whole.size(); ++i) whole[i] = static_cast<int>(i);
  two_opt(clusters, whole, random);
  result.tour = timer.lap();

  const std::vector<Tour> leaves = split(clusters, whole, s.max_length, random);
  result.leaves = static_cast<int>(leaves.size());
  result.split = timer.lap();

  std::vector<double> x, y;
  const std::size_t kept = std::min(leaves.size(), static_cast<std::size_t>(s.paths));
  for (std::size_t k = 0; k < kept; ++k) resample(clusters, leaves[k], s.samples, x, y);
  result.resample = timer.lap();

  Descent(raster, s).run(x, y, result);
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (i % static_cast<std::size_t>(s.samples) == 0) result.paths.emplace_back();
    Path& path = result.paths.back();
    path.x.push_back(x[i]);
    path.y.push_back(y[i]);
    path.pressure.push_back(std::max(raster.value(x[i], y[i]), 0.0) * maximum);
  }
  result.refine = timer.lap();
  result.total = total.seconds();
  return result;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace prostm::textbook
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace prostm::textbook {
namespace {

HWY_EXPORT(Run);

}  // namespace

Result run(const Field& field, const Settings& settings) {
  return HWY_DYNAMIC_DISPATCH(Run)(field, settings);
}

}  // namespace prostm::textbook
#endif  // HWY_ONCE
