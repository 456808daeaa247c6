#include "prostm/plan/detail/fit/felt/envelope.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace prostm::planning {
namespace {

constexpr float kLeastField = 1e-6F;  // keeps a field without pressure in reach from being all 0

}  // namespace

EnvelopeLack::EnvelopeLack(std::size_t most_cells) {
  nearest_.reserve(most_cells);
  for (Eigen::VectorXf* v : {&field_, &pull_}) v->setZero(static_cast<Eigen::Index>(most_cells));
}

void EnvelopeLack::set_points(const std::vector<FeltCells::Cell>& cells, const StepPoints& points,
                              float sigma) {
  nearest_.clear();
  sigma_ = sigma;
  for (const FeltCells::Cell& cell : cells) {
    const auto x = static_cast<float>(cell.x), y = static_cast<float>(cell.y);
    Nearest best;
    float least = std::numeric_limits<float>::max();
    for (std::size_t i = 0; i < points.x.size(); ++i) {
      const std::size_t j = points.next(i);
      const float ex = points.x[j] - points.x[i], ey = points.y[j] - points.y[i];
      const float dx = x - points.x[i], dy = y - points.y[i];
      const float along = (dx * ex + dy * ey) / std::max(ex * ex + ey * ey, 1e-12F);
      const float t = std::clamp(along, 0.0F, 1.0F);
      const float rx = dx - t * ex, ry = dy - t * ey, square = rx * rx + ry * ry;
      if (square >= least) continue;
      least = square;
      best = {static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j), 1.0F - t, t, t, rx, ry};
    }
    const float phi = std::exp(std::max(-0.5F * least / (sigma * sigma), -80.0F));
    best.a *= phi;
    best.b *= phi;
    nearest_.push_back(best);
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
