#pragma once
/// Test figures of one focal point, to check by hand whether an array works.

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "prostm/acoustics/array/array.hpp"
#include "prostm/emit/focus_sample.hpp"

namespace prostm {

enum class TestShape : std::uint8_t { Point, Line, Circle };

struct TestFigure {
  std::string name;  ///< for people
  TestShape shape = TestShape::Point;
  Vec3 centre = Vec3::Zero();  ///< in D [m]
  double radius = 0.0;  ///< of a circle, half of a line along x; both parallel to D's x and y [m]
  double frequency = 0.0;   ///< rounds of a circle, or cycles along a line, per second [Hz]
  double modulation = 0.0;  ///< frequency of the modulation from 0 to full intensity [Hz]; 0: none
  double seconds = 4.0;     ///< fades included

  double speed() const;              ///< largest speed of the focal point [m/s]
  Vec3 position(double t) const;     ///< [m], t since its beginning [s]
  double intensity(double t) const;  ///< 0..1, with the ramp at its beginning, without the fades
};

/// Returns the figures for an array: a point that moves, a circle, and, where the array has several
/// units, a point over each of them.
/// @param height over the array, or the unit, along its normal [m].
std::vector<TestFigure> test_figures(const TransducerArray& array, double emission_rate,
                                     double height, double seconds);

/// Plays one figure on request, and silence otherwise. The intensity takes at least 40 samples to
/// change over its full range, and the focal point moves at no more than kMaxFocusSpeed while its
/// intensity is above 0.
class TestPattern final : public SampleSource {
 public:
  /// @param emission_rate samples a second [Hz].  @param level largest intensity, 0..1.
  /// @throws std::invalid_argument with a sentence for figures that are too fast, too short, or
  /// have a number that is not finite.
  TestPattern(std::vector<TestFigure> figures, double emission_rate, double level);

  int foci() const override { return 1; }
  void fill(std::int64_t first, std::span<FocusSample> out) noexcept override;

  // ---- one other thread ----
  /// Plays the figure of this index, once the current one has faded out.
  void play(std::size_t figure) noexcept;
  /// Fades out.
  void silence() noexcept;
  /// Whether the last request is complete: all its samples are made, the fade included.
  bool done() const noexcept { return finished_.load() == order_.load(); }

  static constexpr double kFade = 2e-3;  ///< time of a fade over the full range [s]

 private:
  void order(std::int64_t figure) noexcept;
  FocusSample next(std::int64_t order) noexcept;

  const std::vector<TestFigure> figures_;
  const double rate_, level_;
  const int fade_samples_;
  std::atomic<std::int64_t> order_{0}, finished_{0};  // 256 · count + index of the figure + 1

  // used by the thread that calls fill()
  std::int64_t playing_ = 0;  // order
  std::int64_t sample_ = 0;   // of the figure
  int faded_in_ = 0;          // 0..fade_samples_
  bool over_ = true;          // only silence is left of the current order
  Vec3 last_ = Vec3::Zero();
};

}  // namespace prostm
