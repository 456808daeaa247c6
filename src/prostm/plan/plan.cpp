#include "prostm/plan/plan.hpp"

#include <stdexcept>
#include <string>

#include "prostm/core/text/number_text.hpp"

namespace prostm {

double closed_length(const FocalPath& path) {
  double length = 0.0;
  const std::size_t n = path.points.size();
  for (std::size_t i = 0; i < n; ++i) length += (path.points[(i + 1) % n] - path.points[i]).norm();
  return length;
}

void require_loop(double loop) {
  if (is_loop(loop)) return;
  throw std::invalid_argument("loop = " + number_text(loop) + " s must be 0 or between " +
                              number_text(kShortestLoop) + " and " + number_text(kLongestLoop) +
                              " s");
}

void translate(Plan& plan, const Vec2& shift) {
  for (FocalPath& path : plan.paths) {
    for (Vec2& x : path.points) x += shift;
  }
  for (FocalPoint& focus : plan.foci) focus.position += shift;
}

}  // namespace prostm
