#include "prostm/plan/detail/fit/initial_loops.hpp"

#include <algorithm>
#include <cmath>

#include "prostm/plan/detail/fit/raster/distances.hpp"
#include "prostm/plan/detail/fit/raster/tile_kernels.hpp"

namespace prostm::planning {
namespace {

constexpr float kRelaxation = 1.5F;  // centres overshoot their means, which saves passes

/// Rounds coordinates below 4 m to multiples of 1/1024 mm. Many cells of a raster are at equal
/// distances from two centres, since centres begin at cells and may be the mean of a single cell.
/// Rounding breaks such ties in the same way whatever the last digits of the raster's geometry and
/// pressures are, e.g. in a single-precision copy of a target.
float snapped(float millimetres) {
  constexpr float kCoarse = 12288.0F;  // floats near it are 1/1024 apart
  return (millimetres + kCoarse) - kCoarse;
}

void snap(std::span<float> millimetres) {
  for (float& x : millimetres) x = snapped(x);
}

}  // namespace

InitialLoops::InitialLoops(std::size_t max_cells) {
  // with room for one vector past the end
  for (std::vector<float>* v : {&x_, &y_, &pressure_}) v->resize(max_cells + 8);
  for (std::vector<float>& v : sorted_) v.resize(max_cells);
  weight_.resize(max_cells);
  label_.resize(max_cells);
  moments_.reserve(max_cells);
}

void InitialLoops::set(const CellTiles& cells, float weak) {
  set(cells, weak, {}, 0, 0);
}

void InitialLoops::set(const CellTiles& cells, float weak,
                       const std::vector<ReconstructionScratch::TileFit>& fits, int lanes,
                       std::uint32_t owners) {
  size_ = 0;
  const float threshold = weak * cells.peak();
  for (std::size_t t = 0; t < cells.tiles().size(); ++t) {
    unsigned allowed = 0xffU;
    for (unsigned c = 0; c < 8 && lanes > 0; ++c) {
      const unsigned owned = owners >> (fits[t].segment[c] % lanes);
      allowed &= ~((~owned & 1U) << c);
    }
    size_ += list_strong_cells(cells.tiles()[t], cells.mean_weights(t), threshold, allowed,
                               {x_.data() + size_, y_.data() + size_, pressure_.data() + size_});
  }
  snap(std::span(x_).first(size_));
  snap(std::span(y_).first(size_));
}

/// Weights cells by the square root of their pressure. This spreads more stops over weak areas than
/// the pressure itself would, which renders better (RMSE 3 % lower on the gallery after the same
/// descent).
void InitialLoops::weigh() {
  for (std::size_t i = 0; i < size_; ++i) weight_[i] = std::sqrt(pressure_[i]);
}

/// Chooses the first `count` centres: cells at equal steps of the cumulative weight.
void InitialLoops::seed(Group group, std::size_t count, Random& random, Centres& cx,
                        Centres& cy) const {
  float total = 0.0F;
  for (std::size_t i = group.begin; i < group.end; ++i) total += weight_[i];
  const float step = total / static_cast<float>(count);
  float next = step * static_cast<float>(random.uniform()), passed = 0.0F;
  std::size_t seeds = 0;
  for (std::size_t i = group.begin; i < group.end && seeds < count; ++i) {
    passed += weight_[i];
    // take each cell at most once, even if several steps fall into it
    if (passed < next && group.end - i > count - seeds) continue;
    cx[seeds] = x_[i];
    cy[seeds] = y_[i];
    ++seeds;
    next += step;
  }
}

/// Runs Lloyd's iteration from seed(): fills centres_ and label_.
void InitialLoops::cluster(Group group, int k, int passes, Random& random) {
  const std::size_t count = static_cast<std::size_t>(k), cells = group.end - group.begin;
  moments_.clear();
  for (std::size_t i = group.begin; i < group.end; ++i) {
    moments_.emplace_back(weight_[i], weight_[i] * x_[i], weight_[i] * y_[i], 0.0F);
  }
  Centres cx{}, cy{}, mass{};
  seed(group, count, random, cx, cy);

  std::array<std::array<Moments, kMaxClusters>, 2> sums;
  for (int pass = 0; pass <= passes; ++pass) {
    for (auto& half : sums) std::fill_n(half.begin(), count, Moments::Zero());
    nearest_centres({x_.data() + group.begin, cells}, {y_.data() + group.begin, cells},
                    {cx.data(), count}, {cy.data(), count}, {label_.data() + group.begin, cells});
    // two sets of sums, for alternate cells: neighbours have the same centre, so with one set each
    // addition would depend on the one before
    for (std::size_t i = 0; i < cells; ++i) {
      sums[i % 2][static_cast<std::size_t>(label_[group.begin + i])] += moments_[i];
    }
    const float relaxation = pass < passes - 1 ? kRelaxation : 1.0F;
    for (std::size_t c = 0; c < count; ++c) {
      const Moments sum = sums[0][c] + sums[1][c];
      mass[c] = sum[0];
      if (mass[c] == 0.0F) continue;
      cx[c] += relaxation * (snapped(sum[1] / mass[c]) - cx[c]);
      cy[c] += relaxation * (snapped(sum[2] / mass[c]) - cy[c]);
    }
  }
  centres_.centre.clear();
  centres_.mass.clear();
  for (std::size_t c = 0; c < count; ++c) {
    centres_.centre.push_back(Vec2(static_cast<double>(cx[c]), static_cast<double>(cy[c])));
    centres_.mass.push_back(static_cast<double>(mass[c]));
  }
}

/// Sorts the cells by their labels. @param groups one group for each label.
void InitialLoops::sort_by_label(int k, std::array<Group, kMaxPaths>& groups) {
  std::array<std::size_t, kMaxPaths + 1> start{};
  for (std::size_t i = 0; i < size_; ++i) ++start[static_cast<std::size_t>(label_[i]) + 1];
  for (std::size_t c = 0; c < static_cast<std::size_t>(k); ++c) {
    start[c + 1] += start[c];
    groups[c] = {start[c], start[c]};
  }
  for (std::size_t i = 0; i < size_; ++i) {
    const std::size_t to = groups[static_cast<std::size_t>(label_[i])].end++;
    sorted_[0][to] = x_[i];
    sorted_[1][to] = y_[i];
    sorted_[2][to] = pressure_[i];
  }
  const auto n = static_cast<std::ptrdiff_t>(size_);
  std::copy_n(sorted_[0].begin(), n, x_.begin());
  std::copy_n(sorted_[1].begin(), n, y_.begin());
  std::copy_n(sorted_[2].begin(), n, pressure_.begin());
}

/// Writes the shortest tour found of centres_ as samples, without the stops that cost too much
/// length for their mass.
void InitialLoops::tour(const StartSettings& settings, std::span<Vec2> samples) {
  distance_.set(std::span<const Vec2>(centres_.centre.data(), centres_.centre.size()));
  Tour order;
  for (std::size_t c = 0; c < centres_.centre.size(); ++c) {
    if (centres_.mass[c] > 0.0) order.push_back(static_cast<std::uint8_t>(c));
  }
  // initial order: nearest neighbour first
  for (std::size_t i = 0; i + 2 < order.size(); ++i) {
    std::size_t nearest = i + 1;
    for (std::size_t j = i + 2; j < order.size(); ++j) {
      if (distance_(order[i], order[j]) < distance_(order[i], order[nearest])) nearest = j;
    }
    std::swap(order[i + 1], order[nearest]);
  }
  two_opt(distance_, std::span<std::uint8_t>(order.data(), order.size()));

  double length = tour_length(distance_, std::span<const std::uint8_t>(order.data(), order.size()));
  while (length > settings.most_length && order.size() > 3) {
    const std::size_t n = order.size();
    std::size_t worst = 0;
    double most = -1.0, saved = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t before = order[(i + n - 1) % n], after = order[(i + 1) % n];
      const double saving =
          distance_(before, order[i]) + distance_(order[i], after) - distance_(before, after);
      if (saving / centres_.mass[order[i]] > most) {
        most = saving / centres_.mass[order[i]];
        worst = i;
        saved = saving;
      }
    }
    order.erase(order.begin() + static_cast<std::ptrdiff_t>(worst));
    length -= saved;
  }
  resample_tour(centres_, std::span<const std::uint8_t>(order.data(), order.size()), samples);
}

void InitialLoops::make(const StartSettings& settings, int samples, Random& random, Loops& loops) {
  weigh();
  const int regions = std::min(settings.paths, static_cast<int>(size_));
  std::array<Group, kMaxPaths> groups{};
  cluster({0, size_}, regions, settings.region_passes, random);
  sort_by_label(regions, groups);
  const auto last = std::remove_if(groups.begin(), groups.begin() + regions,
                                   [](const Group& g) { return g.begin == g.end; });
  weigh();

  const auto paths = static_cast<int>(last - groups.begin());
  loops.reset(samples, paths);
  std::array<Vec2, kMaxPathPoints> storage;
  const std::span<Vec2> points(storage.data(), static_cast<std::size_t>(samples));
  for (int k = 0; k < paths; ++k) {
    const Group group = groups[static_cast<std::size_t>(k)];
    cluster(group, std::min(settings.stops, static_cast<int>(group.end - group.begin)),
            settings.stop_passes, random);
    tour(settings, points);
    for (int i = 0; i < samples; ++i) loops.set_point(i, k, points[static_cast<std::size_t>(i)]);
  }
}

}  // namespace prostm::planning
