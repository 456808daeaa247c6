#include "prostm/am/detail/felt_foci.hpp"

#include <algorithm>
#include <cmath>

#include "prostm/core/random.hpp"
#include "prostm/core/units.hpp"

namespace prostm {
namespace {

constexpr double kMm = 1e3;         // per metre
constexpr int kStarts = 4;          // the first in phase, the others with random phases
constexpr int kEvaluations = 20;    // evaluations per start
constexpr float kFirstStep = 0.3F;  // length of the first step, over the largest pressure
constexpr float kNorm = 16.0F;      // exponent of the norm that approximates the maximum
constexpr float kTiny = 1e-6F;      // keeps the gradient of a silent focus defined

/// Cosine and sine of the phase at a moment of the period.
struct Moment {
  float cosine, sine;
};
template <std::size_t kCount>
std::array<Moment, kCount> moments() {
  std::array<Moment, kCount> out{};
  for (std::size_t t = 0; t < kCount; ++t) {
    const double angle = 2.0 * kPi * static_cast<double>(t) / kCount;
    out[t] = {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
  }
  return out;
}

}  // namespace

FeltFoci::FeltFoci(const AmSettings& settings)
    : settings_(settings),
      cells_(kFeltCells),
      loss_(kFeltSkins, kFeltCells, 2 * kMost, FeltWeights(), false),
      descent_(2 * kMost) {
  nearest_.reserve(kFeltCells);
  reach_.reserve(kFeltCells);
  sources_.reserve(2 * kMost);
  for (Eigen::VectorXf* v : {&field_, &pull_}) v->setZero(static_cast<Eigen::Index>(kFeltCells));
}

/// Sets the positions of the foci. Their pressure has one harmonic, the modulation.
void FeltFoci::set_foci(const TargetField& target, const FocalPoints& foci) {
  foci_ = foci.size();
  sources_.clear();
  for (const FocalPoint& focus : foci) {
    FeltSource<float> source;
    source.x = static_cast<float>(kMm * (focus.position - target.origin).x());
    source.y = static_cast<float>(kMm * (focus.position - target.origin).y());
    source.spectrum[0] = 1.0F;
    sources_.push_back(source);
    source.spectrum[0] = 0.0F;
    source.spectrum[kFeltParts / 2] = -1.0F;  // a quarter of a period later
    sources_.push_back(source);
  }
  const double focus = settings_.widths.empty() ? settings_.sigma : settings_.widths.on(target);
  loss_.set_sources(tables_.of(focus, 1.0 / settings_.frequency), sources_);
  nearest_.clear();
  reach_.clear();
  for (const FeltCells::Cell& cell : cells_.cells()) {
    std::size_t nearest = 0;
    double least = 1e300;
    for (std::size_t f = 0; f < foci_; ++f) {
      const Vec2 x = kMm * (foci[f].position - target.origin);
      const double square = (x - Vec2(cell.x, cell.y)).squaredNorm();
      if (square >= least) continue;
      least = square;
      nearest = f;
    }
    const double sigma = kMm * settings_.sigma;
    nearest_.push_back(nearest);
    reach_.push_back(static_cast<float>(std::exp(std::max(-0.5 * least / (sigma * sigma), -80.0))));
  }
}

float FeltFoci::pressure(std::span<const float> parts, std::size_t focus) const {
  return std::hypot(parts[2 * focus], parts[2 * focus + 1]) + kTiny;
}

/// Sets unit_ to the parts scaled to an output of 1, and by_moment_ to the derivatives of the
/// output with respect to the total pressure at each moment. The output is the norm of this
/// pressure over a period, which the array has to sustain. @return the output.
float FeltFoci::normalise(std::span<const float> parts) {
  static const auto kMoments = moments<16>();
  float most = 0.0F;
  for (std::size_t t = 0; t < kMoments.size(); ++t) {
    by_moment_[t] = 0.0F;
    for (std::size_t f = 0; f < foci_; ++f) {
      by_moment_[t] += 0.5F * (pressure(parts, f) - parts[2 * f] * kMoments[t].cosine -
                               parts[2 * f + 1] * kMoments[t].sine);
    }
    most = std::max(most, by_moment_[t]);
  }
  float sum = 0.0F;
  for (const float d : by_moment_) sum += std::pow(std::max(d / most, 0.0F), kNorm);
  const float output = most * std::pow(sum, 1.0F / kNorm);
  for (float& d : by_moment_) d = std::pow(std::max(d / output, 0.0F), kNorm - 1.0F);
  for (std::size_t i = 0; i < 2 * foci_; ++i) unit_[i] = parts[i] / output;
  return output;
}

/// Returns 1 − S_8.5 of (B2) at unit_, and adds its gradient with respect to the foci's pressures.
float FeltFoci::add_field(std::span<float> by_pressure) {
  const auto n = static_cast<Eigen::Index>(nearest_.size());
  auto field = field_.head(n), pull = pull_.head(n);
  for (Eigen::Index c = 0; c < n; ++c) {
    const auto cell = static_cast<std::size_t>(c);
    field[c] = kTiny + reach_[cell] * pressure(unit_, nearest_[cell]);
  }
  const float value = loss_.rendering().of(field, 0.0F, pull);
  for (Eigen::Index c = 0; c < n; ++c) {
    const auto cell = static_cast<std::size_t>(c);
    by_pressure[nearest_[cell]] += pull[c] * reach_[cell];
  }
  return value;
}

/// Returns (B8) as a function of the parts, and computes its gradient.
float FeltFoci::cost(std::span<const float> parts, std::span<float> gradient) {
  static const auto kMoments = moments<16>();
  const float output = normalise(parts);
  const auto weight = static_cast<float>(settings_.felt_weight);
  const std::size_t all = 2 * foci_;
  float value = weight * loss_.evaluate(std::span(unit_).first(all));
  loss_.gradient(std::span(by_part_).first(all));
  std::array<float, kMost> by_pressure{};
  if (weight < 1.0F) value += (1.0F - weight) * add_field(by_pressure);
  for (std::size_t i = 0; i < all; ++i) {
    const float share = unit_[i] / pressure(unit_, i / 2);
    by_part_[i] = weight * by_part_[i] + (1.0F - weight) * by_pressure[i / 2] * share;
  }
  // the cost does not depend on the output, so the gradient along the parts is removed
  float along = 0.0F;
  for (std::size_t i = 0; i < all; ++i) along += by_part_[i] * unit_[i];
  for (std::size_t i = 0; i < all; ++i) {
    float by_output = 0.0F;
    for (std::size_t t = 0; t < kMoments.size(); ++t) {
      const float turn = i % 2 == 0 ? kMoments[t].cosine : kMoments[t].sine;
      by_output += by_moment_[t] * 0.5F * (parts[i] / pressure(parts, i / 2) - turn);
    }
    gradient[i] = (by_part_[i] - along * by_output) / output;
  }
  return value;
}

int FeltFoci::choose(const TargetField& target, double maximum, FocalPoints& foci) {
  cells_.set(target, maximum);
  loss_.set_target(cells_);
  set_foci(target, foci);
  Parts fitted{};
  for (std::size_t f = 0; f < foci_; ++f)
    fitted[2 * f] = static_cast<float>(foci[f].pressure / maximum) + kTiny;
  const std::span<const float> fit = std::span(fitted).first(2 * foci_);
  const float fitted_output = normalise(fit);
  loss_.keep_loudness(std::span(unit_).first(fit.size()), 1.0F);
  const float wanted = loss_.loudness();

  Random random(1);
  Parts best{};
  float lowest = 0.0F;
  int evaluations = 2;
  const float largest = *std::max_element(fit.begin(), fit.end());
  for (int start = 0; start < kStarts; ++start) {
    for (std::size_t f = 0; f < foci_; ++f) {
      const double angle = start == 0 ? 0.0 : random.uniform(0.0, 2.0 * kPi);
      at_[2 * f] = fitted[2 * f] * static_cast<float>(std::cos(angle));
      at_[2 * f + 1] = fitted[2 * f] * static_cast<float>(std::sin(angle));
    }
    const auto cost_of = [this](std::span<const float> parts, std::span<float> gradient) {
      return cost(parts, gradient);
    };
    const std::span<float> at = std::span(at_).first(2 * foci_);
    descent_.begin(cost_of, at);
    evaluations += descent_.run(cost_of, kFirstStep * largest, kEvaluations, at);
    if (start > 0 && descent_.lowest() >= lowest) continue;
    lowest = descent_.lowest();
    best = at_;
  }
  // as loud as the fit, as far as the fit's output allows
  const std::span<const float> found = std::span(best).first(2 * foci_);
  const float output = normalise(found);
  loss_.evaluate(std::span(unit_).first(found.size()));
  const float scale = std::min(wanted / loss_.loudness(), 1.0F) * fitted_output / output;
  // a common delay has no effect, so the strongest focus gets phase 0
  std::size_t strongest = 0;
  for (std::size_t f = 1; f < foci_; ++f)
    strongest = pressure(best, f) > pressure(best, strongest) ? f : strongest;
  const auto turns = [&](std::size_t f) {
    return static_cast<double>(std::atan2(best[2 * f + 1], best[2 * f])) / (2.0 * kPi);
  };
  const double delay = turns(strongest);
  for (std::size_t f = 0; f < foci_; ++f) {
    const double after = turns(f) - delay;
    foci[f].pressure =
        maximum * static_cast<double>(scale * std::hypot(best[2 * f], best[2 * f + 1]));
    foci[f].phase = f == strongest ? 0.0 : after - std::floor(after);
  }
  return evaluations;
}

}  // namespace prostm
