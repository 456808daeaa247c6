#include "prostm/plan/detail/fit/felt/envelope.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace prostm::planning {
namespace {

constexpr double kSpillBelow = 0.1;   // of the target's maximum, as in Metrics::spill
constexpr float kLeastField = 1e-6F;  // keeps the field above 0 where no path is in reach

/// A segment from one point to the next.
struct Segment {
  Segment(const StepPoints& points, std::size_t i)
      : x(points.x[i]),
        y(points.y[i]),
        ex(points.x[points.next(i)] - x),
        ey(points.y[points.next(i)] - y),
        per_square(1.0F / std::max(ex * ex + ey * ey, 1e-12F)) {}

  /// Returns where it is closest to the point at (dx, dy) from its start, 0 (start) to 1 (end).
  float share(float dx, float dy) const {
    const float along = (dx * ex + dy * ey) * per_square, forward = along < 0.0F ? 0.0F : along;
    return forward > 1.0F ? 1.0F : forward;
  }

  float x, y, ex, ey, per_square;
};

}  // namespace

EnvelopeLack::EnvelopeLack(std::size_t most_cells) {
  nearest_.reserve(most_cells);
  segment_.reserve(most_cells);
  for (auto* list : {&x_, &y_, &least_}) list->reserve(most_cells);
  for (Eigen::VectorXf* v : {&field_, &pull_}) v->setZero(static_cast<Eigen::Index>(most_cells));
}

/// Sets segment_ and least_ of each cell. The loop over cells is the inner one, so that it
/// vectorises.
void EnvelopeLack::find_nearest(const StepPoints& points) {
  const std::size_t cells = x_.size();
  least_.assign(cells, std::numeric_limits<float>::max());
  segment_.assign(cells, 0);
  const float *x = x_.data(), *y = y_.data();
  float* least = least_.data();
  std::int32_t* segment = segment_.data();
  for (std::size_t i = 0; i < points.x.size(); ++i) {
    const Segment s(points, i);
    const auto number = static_cast<std::int32_t>(i);
    for (std::size_t c = 0; c < cells; ++c) {
      const float dx = x[c] - s.x, dy = y[c] - s.y;
      const float t = s.share(dx, dy);
      const float rx = dx - t * s.ex, ry = dy - t * s.ey, square = rx * rx + ry * ry;
      segment[c] = square < least[c] ? number : segment[c];
      least[c] = square < least[c] ? square : least[c];
    }
  }
}

void EnvelopeLack::set_points(const std::vector<FeltCells::Cell>& cells, const StepPoints& points,
                              float sigma) {
  sigma_ = sigma;
  x_.clear();
  y_.clear();
  for (const FeltCells::Cell& cell : cells) {
    x_.push_back(static_cast<float>(cell.x));
    y_.push_back(static_cast<float>(cell.y));
  }
  find_nearest(points);
  nearest_.clear();
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const auto i = static_cast<std::size_t>(segment_[c]);
    const Segment s(points, i);
    const float dx = x_[c] - s.x, dy = y_[c] - s.y, t = s.share(dx, dy);
    const float phi = std::exp(std::max(-0.5F * least_[c] / (sigma * sigma), -80.0F));
    nearest_.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(points.next(i)),
                        (1.0F - t) * phi, t * phi, t, dx - t * s.ex, dy - t * s.ey});
  }
}

float EnvelopeLack::evaluate(RenderLack<float>& rendering, std::span<const float> pressure) {
  const auto n = static_cast<Eigen::Index>(nearest_.size());
  auto field = field_.head(n);
  for (Eigen::Index c = 0; c < n; ++c) {
    const Nearest& at = nearest_[static_cast<std::size_t>(c)];
    field[c] = kLeastField + at.a * pressure[at.first] + at.b * pressure[at.second];
  }
  return rendering.of(field, 0.0F, pull_.head(n));
}

float EnvelopeLack::spill(const std::vector<FeltCells::Cell>& cells,
                          std::span<const float> pressure) const {
  float all = 0.0F, outside = 0.0F;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const Nearest& at = nearest_[c];
    const float field = static_cast<float>(cells[c].area) *
                        (at.a * pressure[at.first] + at.b * pressure[at.second]);
    all += field;
    if (cells[c].pressure < kSpillBelow) outside += field;
  }
  return all > 0.0F ? outside / all : 0.0F;
}

void EnvelopeLack::add_gradient(float weight, std::span<float> gradient) const {
  for (std::size_t c = 0; c < nearest_.size(); ++c) {
    const Nearest& at = nearest_[c];
    const float pull = weight * pull_[static_cast<Eigen::Index>(c)];
    gradient[at.first] += pull * at.a;
    gradient[at.second] += pull * at.b;
  }
}

void EnvelopeLack::add_slide(float weight, const StepPoints& points,
                             std::span<const float> pressure, std::span<float> gradient_x,
                             std::span<float> gradient_y) const {
  for (std::size_t c = 0; c < nearest_.size(); ++c) {
    const Nearest& at = nearest_[c];
    const std::size_t i = at.first, j = at.second;
    const float phi = at.a + at.b, t = at.along;
    const float ex = points.x[j] - points.x[i], ey = points.y[j] - points.y[i];
    const float each = weight * pull_[static_cast<Eigen::Index>(c)] * phi;
    const float p = (1.0F - t) * pressure[i] + t * pressure[j];
    const float nearer = each * p / (sigma_ * sigma_);
    const bool inside = t > 0.0F && t < 1.0F;
    const float further = inside ? each * (pressure[j] - pressure[i]) / (ex * ex + ey * ey) : 0.0F;
    const float first = nearer * (1.0F - t) - further, second = nearer * t + further;
    gradient_x[i] += first * at.dx - further * (1.0F - t) * ex;
    gradient_y[i] += first * at.dy - further * (1.0F - t) * ey;
    gradient_x[j] += second * at.dx - further * t * ex;
    gradient_y[j] += second * at.dy - further * t * ey;
  }
}

}  // namespace prostm::planning
