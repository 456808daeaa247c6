#include "prostm/device/test_pattern.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "prostm/acoustics/array/array_units.hpp"
#include "prostm/core/units.hpp"
#include "prostm/emit/emitter.hpp"

namespace prostm {
namespace {

constexpr double kGentle = 0.2;    // share of the intensity at the beginning of a figure
constexpr double kRampTime = 2.0;  // time until full intensity, at most [s]
constexpr double kTouch = 200.0;   // modulation to which skin is most sensitive [Hz]
constexpr std::int64_t kOrders = 256;

/// Returns the index of an order's figure; −1: silence.
std::int64_t figure_of(std::int64_t order) {
  return order % kOrders - 1;
}

void check(const TestFigure& f, double rate) {
  const bool is_finite = f.centre.allFinite() && std::isfinite(f.radius) &&
                         std::isfinite(f.frequency) && std::isfinite(f.modulation) &&
                         std::isfinite(f.seconds);
  if (!is_finite) throw std::invalid_argument(f.name + " has a number that is not finite");
  if (f.speed() > kMaxFocusSpeed) {
    throw std::invalid_argument(f.name + " moves at " + std::to_string(f.speed()) +
                                " m/s, and must move at 8 m/s at most");
  }
  if (f.modulation < 0.0 || f.modulation > rate / 200.0) {
    throw std::invalid_argument(f.name + " is modulated at " + std::to_string(f.modulation) +
                                " Hz, and must be at 0 to a 200th of the samples a second");
  }
  if (f.seconds < 0.1 || f.seconds > 600.0) {
    throw std::invalid_argument(f.name + " lasts " + std::to_string(f.seconds) +
                                " s, and must last 0.1 to 600 s");
  }
}

}  // namespace

double TestFigure::speed() const {
  return shape == TestShape::Point ? 0.0 : 2.0 * kPi * std::abs(frequency * radius);
}

Vec3 TestFigure::position(double t) const {
  const double angle = 2.0 * kPi * frequency * t;
  switch (shape) {
    case TestShape::Line:
      return centre + radius * std::sin(angle) * Vec3::UnitX();
    case TestShape::Circle:
      return centre + radius * Vec3(std::cos(angle), std::sin(angle), 0.0);
    case TestShape::Point:
      break;
  }
  return centre;
}

double TestFigure::intensity(double t) const {
  const double ramp = std::min(kRampTime, 0.5 * seconds);
  const double gentle = std::min(1.0, kGentle + (1.0 - kGentle) * t / ramp);
  const double modulated =
      modulation > 0.0 ? 0.5 - 0.5 * std::cos(2.0 * kPi * modulation * t) : 1.0;
  return gentle * modulated;
}

std::vector<TestFigure> test_figures(const TransducerArray& array, double emission_rate,
                                     double height, double seconds) {
  const double modulation = std::min(kTouch, emission_rate / 200.0);
  const std::vector<ArrayUnit> units = units_of(array);
  Vec3 centre = Vec3::Zero(), normal = Vec3::Zero();
  for (const ArrayUnit& unit : units) {
    centre += unit.centre / static_cast<double>(units.size());
    normal += unit.normal;
  }
  const Vec3 middle =
      centre + height * (normal.norm() > 1e-6 ? normal.normalized() : Vec3(Vec3::UnitZ()));
  std::vector<TestFigure> figures = {{"a point that moves slowly to and fro along x, 60 mm",
                                      TestShape::Line, middle, 0.03, 0.5, modulation, seconds},
                                     {"a circle of 40 mm, drawn 60 times a second",
                                      TestShape::Circle, middle, 0.02, 60.0, 0.0, seconds}};
  for (std::size_t i = 0; units.size() > 1 && i < units.size(); ++i) {
    figures.push_back(
        {"a point over unit " + std::to_string(i + 1) + " of " + std::to_string(units.size()),
         TestShape::Point, units[i].centre + height * units[i].normal, 0.0, 0.0, modulation,
         seconds});
  }
  return figures;
}

TestPattern::TestPattern(std::vector<TestFigure> figures, double emission_rate, double level)
    : figures_(std::move(figures)),
      rate_(emission_rate),
      level_(level),
      fade_samples_(static_cast<int>(std::ceil(std::max(80.0, kFade * emission_rate)))) {
  if (figures_.empty() || static_cast<std::int64_t>(figures_.size()) >= kOrders)
    throw std::invalid_argument("there must be 1 to 254 figures to play");
  if (!(level >= 0.0 && level <= 1.0))
    throw std::invalid_argument("level = " + std::to_string(level) + " must be from 0 to 1");
  for (const TestFigure& figure : figures_) check(figure, emission_rate);
}

void TestPattern::order(std::int64_t figure) noexcept {
  order_.store((order_.load() / kOrders + 1) * kOrders + figure + 1);
}

void TestPattern::play(std::size_t figure) noexcept {
  if (figure < figures_.size()) order(static_cast<std::int64_t>(figure));
}

void TestPattern::silence() noexcept {
  order(-1);
}

void TestPattern::fill(std::int64_t first, std::span<FocusSample> out) noexcept {
  static_cast<void>(first);
  const std::int64_t order = order_.load();
  for (FocusSample& sample : out) sample = next(order);
  if (playing_ == order && over_) finished_.store(order);
}

/// Returns the next sample. @param order the newest request.
FocusSample TestPattern::next(std::int64_t order) noexcept {
  if (faded_in_ == 0 && playing_ != order) {
    playing_ = order;
    sample_ = 0;
  }
  const std::int64_t figure = figure_of(playing_);
  over_ = figure < 0;
  if (over_) return {last_.cast<float>(), 0.0F};
  const TestFigure& f = figures_[static_cast<std::size_t>(figure)];
  const double t = static_cast<double>(sample_) / rate_,
               fade = static_cast<double>(fade_samples_) / rate_;
  const bool goes_on = playing_ == order && t < f.seconds - fade;
  faded_in_ = std::clamp(faded_in_ + (goes_on ? 1 : -1), 0, fade_samples_);
  over_ = faded_in_ == 0;
  ++sample_;
  last_ = f.position(t);
  const double faded = static_cast<double>(faded_in_) / fade_samples_;
  return {last_.cast<float>(), static_cast<float>(level_ * faded * f.intensity(t))};
}

}  // namespace prostm
