#pragma once
/// The part of an AUTD3 unit that plays its two banks, as its logic does, tick by tick at 40 kHz.
/// Written from the protocol's facts alone; shares nothing with the driver.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace standin {

struct Bank {
  bool raw = true;  ///< silent, as after Clear
  std::uint32_t divider = 0xFFFF, samples = 2, slots = 1;
  std::uint32_t repetitions = 0xFFFF;  ///< 0xFFFF: endless, else loops − 1
  std::vector<std::uint64_t> words = std::vector<std::uint64_t>(65536);
};

struct Focus {
  double x = 0.0, y = 0.0, z = 0.0;  ///< in the unit's frame [mm]
  double amplitude = 0.0;            ///< 0..1
};
/// Foci of a sample; pairs of slots at the same position are one focus each.
std::vector<Focus> foci_of(const std::uint64_t* words, std::uint32_t slots);

/// A played sample, for later inspection.
struct Played {
  std::int64_t tick;  ///< of 40 kHz
  std::uint32_t slots;
  std::uint32_t muted;
  std::array<std::uint64_t, 8> words;
};

class Playback {
 public:
  std::array<Bank, 2> banks;
  bool muted = false;

  void clear();
  /// Switches to a bank. Mode 0: at its next start, 0xFF: at once, 0xF0: alternating with the
  /// other. @pre the mode fits the bank's loops.
  void activate(int bank, int mode);
  /// Plays up to a time of the unit [ns].
  void advance(std::int64_t time);
  /// Sets the clock to another time.
  void jump(std::int64_t time) { tick_ = time / 25'000; }

  int bank() const { return bank_; }
  bool stopped() const { return stopped_; }
  bool pending() const { return pending_ >= 0; }
  int pending_bank() const { return pending_; }
  /// Unit's time of the last sample with a focus above 1 % [ns]; −1 if there was none.
  std::int64_t last_sounding = -1;
  double largest_step = 0.0;   ///< of a focus above 1 %, between samples [mm]
  double largest_speed = 0.0;  ///< that step divided by the sampling period [m/s]
  std::int64_t turns = 0, stops = 0;
  std::vector<Played> played;
  bool records = false;

 private:
  std::int64_t index(int bank, std::int64_t tick) const;
  std::int64_t next_begin() const;
  void change_over(std::int64_t tick);
  void play(std::int64_t tick);

  std::int64_t tick_ = 0;
  int bank_ = 0, pending_ = -1;
  bool sounds_ = false;  // whether the current sample would emit unmuted
  bool stopped_ = false, finite_ = false, alternates_ = false;
  std::uint32_t loops_ = 0;
  std::int64_t last_index_ = -1;
  int last_bank_ = -1;
  std::vector<Focus> last_;
};

}  // namespace standin
