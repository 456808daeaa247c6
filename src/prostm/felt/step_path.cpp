#include "prostm/felt/step_path.hpp"

#include <algorithm>
#include <cmath>

#include "prostm/core/units.hpp"

namespace prostm {

template <class Real>
void StepPath<Real>::set(std::span<const Real> x, std::span<const Real> y, int laps) {
  laps_ = laps;
  count_ = x.size();
  std::copy(x.begin(), x.end(), x_.begin());
  std::copy(y.begin(), y.end(), y_.begin());
  length_ = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    const std::size_t next = (i + 1) % count_;
    passed_[i] = length_;
    segment_[i] = std::hypot(x_[next] - x_[i], y_[next] - y_[i]);
    length_ += segment_[i];
  }
}

template <class Real>
void StepPath<Real>::sources(int first, std::span<FeltSource<Real>> out) const {
  for (std::size_t i = 0; i < count_; ++i) {
    out[i].x = x_[i];
    out[i].y = y_[i];
    const Real weight = share(i), angle = -2 * static_cast<Real>(kPi) * time(i);
    for (int n = 0; n < kFeltHarmonics; ++n) {
      // with several laps, only harmonics divisible by their number are left
      const int of_lap = (first + n) / laps_;
      const Real felt = of_lap * laps_ == first + n ? weight : Real(0);
      const Real phase = angle * static_cast<Real>(of_lap);
      const auto part = static_cast<std::size_t>(n);
      out[i].spectrum[part] = felt * std::cos(phase);
      out[i].spectrum[part + kFeltParts / 2] = felt * std::sin(phase);
    }
  }
}

template <class Real>
void StepPath<Real>::add_gradient(std::span<const Real> by_time, std::span<const Real> by_share,
                                  std::span<Real> gradient_x, std::span<Real> gradient_y) const {
  // a longer path reduces all times and shares; a longer segment delays the points after it
  Real whole = 0, later = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    whole += by_time[i] * time(i) + by_share[i] * share(i);
    later += by_time[i];
  }
  for (std::size_t i = 0; i < count_; ++i) {
    const std::size_t next = (i + 1) % count_;
    later -= by_time[i];
    if (segment_[i] <= 0) continue;
    const Real pull = (later + by_share[i] + by_share[next] - whole) / (length_ * segment_[i]);
    const Real dx = pull * (x_[next] - x_[i]), dy = pull * (y_[next] - y_[i]);
    gradient_x[next] += dx;
    gradient_y[next] += dy;
    gradient_x[i] -= dx;
    gradient_y[i] -= dy;
  }
}

template class StepPath<float>;
template class StepPath<double>;

}  // namespace prostm
