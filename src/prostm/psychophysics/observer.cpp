#include "prostm/psychophysics/observer.hpp"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <limits>
#include <numeric>

#include "prostm/core/random.hpp"
#include "prostm/core/units.hpp"
#include "prostm/psychophysics/places.hpp"
#include "prostm/psychophysics/template_observer.hpp"

namespace prostm {
namespace {

constexpr int kAnswers = 2000;  // simulated for each alternative
constexpr std::uint64_t kSeed = 20200101;
/// Difference in standard deviations of one interval at 75 % right answers in two intervals.
constexpr double kTwoIntervals = 0.9538725524;

using Values = std::vector<double>;

double probability(double z) {
  return boost::math::cdf(boost::math::normal(), std::clamp(z, -30.0, 30.0));
}

double dot(const Values& a, const Values& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

/// Log-likelihood of values under an alternative, up to a constant: noise of `variance` in each
/// place, and of kStrengthNoise of the whole. Sherman and Morrison's formula.
double log_likelihood(const Values& values, const Values& alternative, double variance) {
  const double power = dot(alternative, alternative);
  const double common = kStrengthNoise * kStrengthNoise * power / variance;
  double square = 0.0, along = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double difference = values[i] - alternative[i];
    square += difference * difference;
    along += difference * alternative[i];
  }
  const double explained = power > 0.0 ? common / (1.0 + common) * along * along / power : 0.0;
  return -0.5 * ((square - explained) / variance + std::log1p(common));
}

}  // namespace

double decibels(double strength, double reference) {
  constexpr double kMost = 300.0;
  if (strength <= 0.0 && reference <= 0.0) return 0.0;
  if (strength <= 0.0) return -kMost;
  if (reference <= 0.0) return kMost;
  return std::clamp(20.0 * std::log10(strength / reference), -kMost, kMost);
}

double dip_between(const FeltStimulus& felt, const Vec2& a, const Vec2& b) {
  constexpr int kSteps = 64;
  const double ends =
      std::min(value_at(felt.patch, felt.map, a), value_at(felt.patch, felt.map, b));
  if (ends <= 0.0) return 0.0;
  double lowest = ends;
  for (int i = 1; i < kSteps; ++i) {
    const double share = static_cast<double>(i) / kSteps;
    lowest = std::min(lowest, value_at(felt.patch, felt.map, a + share * (b - a)));
  }
  return 1.0 - lowest / ends;
}

double deepest_dip(const FeltStimulus& felt) {
  const SkinPatch& patch = felt.patch;
  const Vec2 middle = centroid(patch, felt.map);
  std::array<double, 4> largest{};
  std::array<Vec2, 4> place;
  place.fill(middle);
  for (int j = 0; j < patch.rows; ++j) {
    for (int i = 0; i < patch.cols; ++i) {
      const Vec2 x = patch.cell * Vec2(i - 0.5 * (patch.cols - 1), j - 0.5 * (patch.rows - 1));
      const bool right = x.x() >= middle.x(), up = x.y() >= middle.y();
      const std::size_t quadrant = up ? (right ? 0 : 1) : (right ? 3 : 2);
      const double value = felt.map[static_cast<std::size_t>(j * patch.cols + i)];
      if (value <= largest[quadrant]) continue;
      largest[quadrant] = value;
      place[quadrant] = x;
    }
  }
  double deepest = 0.0;
  for (std::size_t q = 0; q < place.size(); ++q)
    deepest = std::max(deepest, dip_between(felt, place[q], place[(q + 1) % place.size()]));
  return deepest;
}

/// Standard deviation of the noise in each place: over the largest value, and not below that of a
/// stimulus at threshold.
double Observer::local_noise(const FeltStimulus& felt) const {
  const double largest = std::ranges::max(felt.places());
  const double weak = felt.strength > 0.0 ? parameters_.threshold / felt.strength : 0.0;
  return parameters_.noise * largest * std::hypot(1.0, weak);
}

double Observer::detects(const FeltStimulus& felt) const {
  return probability(decibels(felt.strength, parameters_.threshold) / kThresholdSpread);
}

double Observer::prefers(const FeltStimulus& a, const FeltStimulus& b) const {
  return probability(decibels(a.strength, b.strength) / parameters_.strength_noise);
}

double Observer::says_two(const FeltStimulus& felt, const std::array<Vec2, 2>& ends,
                          const FeltStimulus& one, const FeltStimulus& two) const {
  if (readout_ == Readout::Category)
    return probability((dip_between(felt, ends[0], ends[1]) - parameters_.criterion) /
                       parameters_.noise);
  const Values first = one.places(), second = two.places();
  double largest = 0.0;  // of the middle between them
  for (std::size_t i = 0; i < first.size(); ++i)
    largest = std::max(largest, 0.5 * (first[i] + second[i]));
  if (largest <= 0.0) return 0.5;
  const double noise = 0.5 * (local_noise(one) + local_noise(two));
  const TemplateObserver decision(first, second, {noise / largest, kStrengthNoise});
  return probability(decision.evidence(felt.places()) - parameters_.criterion);
}

double Observer::place_noise(const FeltStimulus& felt) const {
  if (readout_ == Readout::Category) return parameters_.place;
  // the Cramér-Rao bound for a known map at an unknown place
  constexpr double kStep = 1e-3;
  const double noise = local_noise(felt);
  double information = 0.0;
  for (const Vec2& axis : {Vec2(kStep, 0.0), Vec2(0.0, kStep)}) {
    const Values ahead = felt.places(axis), behind = felt.places(-axis);
    for (std::size_t i = 0; i < ahead.size(); ++i)
      information += 0.5 * std::pow((ahead[i] - behind[i]) / (2.0 * kStep), 2);
  }
  return information > 0.0 ? noise / std::sqrt(information) : std::numeric_limits<double>::max();
}

std::vector<std::vector<double>> Observer::confusions(
    std::span<const FeltStimulus* const> alternatives) const {
  std::vector<Values> known;
  double noise = 0.0;
  for (const FeltStimulus* one : alternatives) {
    known.push_back(one->places());
    noise = std::max(noise, local_noise(*one));
  }
  const double variance = noise * noise;
  std::vector<std::vector<double>> out(known.size(), Values(known.size()));
  Random random(kSeed);
  for (std::size_t presented = 0; presented < known.size(); ++presented) {
    for (int answer = 0; answer < kAnswers; ++answer) {
      Values values = known[presented];
      const double common = 1.0 + kStrengthNoise * random.normal();
      for (double& v : values) v = common * v + noise * random.normal();
      std::size_t best = 0;
      double highest = -std::numeric_limits<double>::infinity();
      for (std::size_t k = 0; k < known.size(); ++k) {
        const double likelihood = variance > 0.0 ? log_likelihood(values, known[k], variance) : 0.0;
        if (likelihood > highest) {
          highest = likelihood;
          best = k;
        }
      }
      out[presented][best] += 1.0 / kAnswers;
    }
  }
  return out;
}

double Observer::counts(const FeltStimulus& felt, const std::vector<Vec2>& points) const {
  if (points.empty()) return 1.0;
  double right = detects(felt);
  for (std::size_t i = 1; i < points.size(); ++i) {
    // the shallowest dip to a point before it
    double shallowest = 1.0;
    for (std::size_t j = 0; j < i; ++j)
      shallowest = std::min(shallowest, dip_between(felt, points[i], points[j]));
    right *= probability((shallowest - parameters_.criterion) / parameters_.noise);
  }
  return right;
}

double Observer::tells_direction(const FeltStimulus& felt) const {
  // the standard deviation of a time within the window of (X9)
  const double noise = kPerceptTime / std::sqrt(12.0);
  return probability(felt.delay / (std::sqrt(2.0) * noise));
}

double Observer::curvature_weber(const FeltStimulus& point, const FeltStimulus& reference,
                                 const FeltStimulus& other,
                                 const std::array<double, 2>& curvatures) const {
  Vec2 mean = Vec2::Zero();
  double all = 0.0;
  for (std::size_t i = 0; i < reference.course.size(); ++i) {
    const double time = reference.course[i].duration;
    mean += time * (other.course[i].place - reference.course[i].place);
    all += time;
  }
  mean /= all;
  double square = 0.0;
  for (std::size_t i = 0; i < reference.course.size(); ++i) {
    const Vec2 moved = other.course[i].place - reference.course[i].place - mean;
    square += reference.course[i].duration / kPerceptTime * moved.squaredNorm();
  }
  const double d_prime = std::sqrt(square) / place_noise(point);
  const double difference = std::abs(curvatures[1] - curvatures[0]);
  return d_prime > 0.0 ? kTwoIntervals * difference / d_prime / curvatures[0]
                       : std::numeric_limits<double>::max();
}

}  // namespace prostm
