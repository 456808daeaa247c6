#include "ear.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace standin {
namespace {

constexpr double kUnit = 0.025e-3, kPitch = 10.16e-3;  // [m]
constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr std::size_t kMostLogged = 2'000'000;
constexpr std::int64_t kChecked = 101;  // the phases of one in this many samples are checked

std::array<int, 3> units_of(std::uint64_t word) {
  std::array<int, 3> p{};
  for (int axis = 0; axis < 3; ++axis) {
    auto value = static_cast<int>(word >> (18 * axis) & 0x3FFFF);
    p[static_cast<std::size_t>(axis)] = value >= 1 << 17 ? value - (1 << 18) : value;
  }
  return p;
}

int byte_of(std::uint64_t word) {
  return static_cast<int>(word >> 54 & 0xFF);
}

/// Phases as in the firmware: tables with 256 steps per turn, and sums of bytes.
int sine(int phase) {
  return static_cast<int>(std::lround(127.5 * (1.0 + std::sin(kTurn * (phase & 255) / 256.0))));
}

}  // namespace

void Ear::hear(const Playing& playing, std::int64_t tick, double time) {
  const int key = playing.intensity * playing.modulation / 255;
  if (key > 0) {
    if (!sounds && last_sound > 0.0) longest_silence = std::max(longest_silence, time - last_sound);
    last_sound = time;
    largest_key = std::max(largest_key, key);
  } else if (sounds) {
    ++silences;
  }
  sounds = key > 0;
  const std::int64_t sample = tick / std::max<std::int64_t>(playing.divider, 1);
  if (sample != sample_ || playing.segment != segment_ || playing.foci != words_of_) {
    end_sample();
    sample_ = sample;
    segment_ = playing.segment;
    words_of_ = playing.foci;
    begin_sample(playing, tick, time);
  }
  now_.loudest = std::max(now_.loudest, playing.modulation);
}

void Ear::begin_sample(const Playing& playing, std::int64_t tick, double time) {
  static_cast<void>(tick);
  now_.foci.clear();
  now_.period = static_cast<double>(playing.divider) / 40e3;
  now_.loudest = 0;
  played_ = {};
  played_.time = time;
  played_.index = static_cast<std::int32_t>(playing.index);
  played_.segment = static_cast<std::uint8_t>(playing.segment);
  played_.slots = static_cast<std::uint8_t>(playing.foci);
  played_.intensity = static_cast<std::uint8_t>(playing.intensity);
  played_.divider = playing.divider;
  played_.words = playing.words;
  // slots at the same place are one focal point, whose phasors add up
  for (int i = 0; i < playing.foci;) {
    const std::array<int, 3> place = units_of(playing.words[static_cast<std::size_t>(i)]);
    std::complex<double> sum = 0.0;
    int count = 0;
    for (; count < 2 && i < playing.foci; ++i, ++count) {
      const std::uint64_t word = playing.words[static_cast<std::size_t>(i)];
      if (units_of(word) != place) break;
      sum += std::polar(1.0, i == 0 ? 0.0 : kTurn * byte_of(word) / 256.0);
    }
    Focus focus;
    for (std::size_t axis = 0; axis < 3; ++axis) focus.place[axis] = kUnit * place[axis];
    focus.level = std::abs(sum) / count * playing.intensity / 255.0;
    now_.foci.push_back(focus);
  }
  if (playing.foci > 0 && playing.intensity > 0 && heard_++ % kChecked == 0) check_phases(playing);
}

void Ear::end_sample() {
  const double loud = now_.loudest / 255.0, loud_before = before_.loudest / 255.0;
  if (played_.intensity > 0 && now_.loudest > 0) ++samples;
  if (logs_ && played_.slots > 0 && log_.size() < kMostLogged) {
    played_.loudest = static_cast<std::uint8_t>(now_.loudest);
    log_.push_back(played_);
  }
  constexpr double kHeard = 0.01;
  if (now_.foci.size() == before_.foci.size()) {
    for (std::size_t f = 0; f < now_.foci.size(); ++f) {
      const Focus &to = now_.foci[f], &from = before_.foci[f];
      if (to.level * loud <= kHeard || from.level * loud_before <= kHeard) continue;
      double square = 0.0;
      for (std::size_t axis = 0; axis < 3; ++axis)
        square += (to.place[axis] - from.place[axis]) * (to.place[axis] - from.place[axis]);
      const double step = std::sqrt(square);
      largest_step = std::max(largest_step, step);
      largest_speed = std::max(largest_speed, step / now_.period);
    }
  }
  std::swap(before_, now_);
}

void Ear::check_phases(const Playing& playing) {
  const int slots = playing.foci;
  const double wavelength = playing.sound_speed / 64.0 / 40e3;
  for (int row = 0; row < 14; ++row) {
    for (int column = 0; column < 18; ++column) {
      if (row == 1 && (column == 1 || column == 2 || column == 16)) continue;
      // as in the firmware, in integers
      const int x = static_cast<int>(std::lround(column * kPitch / kUnit)),
                y = static_cast<int>(std::lround(row * kPitch / kUnit));
      int sine_sum = 0, cosine_sum = 0;
      std::complex<double> sum = 0.0;
      for (int s = 0; s < slots; ++s) {
        const std::uint64_t word = playing.words[static_cast<std::size_t>(s)];
        const auto [fx, fy, fz] = units_of(word);
        const double dx = fx - x, dy = fy - y, dz = fz;
        const auto distance = static_cast<int>(std::sqrt(dx * dx + dy * dy + dz * dz));
        const int offset = s == 0 ? 0 : byte_of(word);
        const int phase = (distance << 14) / playing.sound_speed + offset;
        sine_sum += sine(phase);
        cosine_sum += sine(phase + 64);
        // by the exact physics
        const double ex = kUnit * fx - column * kPitch, ey = kUnit * fy - row * kPitch,
                     ez = kUnit * fz;
        sum += std::polar(
            1.0, kTurn * (std::sqrt(ex * ex + ey * ey + ez * ez) / wavelength + offset / 256.0));
      }
      if (std::abs(sum) < 0.5 * slots) continue;
      const int sine_mean = (sine_sum / slots) >> 1, cosine_mean = (cosine_sum / slots) >> 1;
      const double told = std::atan2(sine_mean - 63.5, cosine_mean - 63.5);
      const double away = std::remainder(told - std::arg(sum), kTurn);
      phase_error = std::max(phase_error, std::abs(away) / kTurn * 256.0);
    }
  }
}

}  // namespace standin
