#pragma once
/// Encodes samples of focal points as the slots of AUTD3's FociSTM, from which the firmware
/// computes the drives.

#include <cstdint>
#include <span>
#include <vector>

#include "prostm/acoustics/focus/live_focus_solver.hpp"
#include "prostm/emit/focus_sample.hpp"

namespace prostm {

/// A focus of FociSTM as the firmware stores it: x | y << 18 | z << 36 | byte << 54.
using SlotWord = std::uint64_t;

inline constexpr int kMostSlots = 8;           ///< foci of FociSTM in a sample
inline constexpr double kSlotUnit = 0.025e-3;  ///< unit of positions [m]
inline constexpr int kLargestSlotPlace = (1 << 17) - 1;

struct SlotSettings {
  int foci = 4;  ///< focal points of a sample, 1..8
  /// Each focal point has its own intensity and takes two slots, so there are at most kMostSlots /
  /// 2 of them. A single focal point needs one slot.
  bool own_intensities = true;
  double sample_rate = 10e3;  ///< of the samples [Hz]; sets how much a transducer still rings
};

/// Slots of a sample. @throws std::invalid_argument for more focal points than fit.
int slot_count(const SlotSettings& settings);

/// Encodes one sample after another for an array of one or several units. All units get the same
/// phases and the same intensity, and positions in their own frames, (A23). The focal points have
/// their shares of the pressure at the end of each sample, with the ringing of the transducers
/// taken into account. Allocates nothing after construction. A focal point with a number that is
/// not finite, or out of reach, or behind the array, is silent.
class SlotEncoder {
 public:
  /// @param units poses X_DU of the units' own frames (transducer 0 is the origin).
  /// @throws std::invalid_argument for no unit, or more focal points than slots.
  SlotEncoder(std::span<const Pose> units, const Medium& medium, const SlotSettings& settings);

  int slots() const { return slots_; }  ///< per sample
  int units() const { return static_cast<int>(X_UD_.size()); }

  /// Encodes one sample.
  /// @param words slots() of unit 0, then those of unit 1, and so on. The byte of slot 0 is the
  /// intensity, that of slot i > 0 the phase of slot i less that of slot 0 [1/256 turn].
  void encode(std::span<const FocusSample> sample, std::span<SlotWord> words) noexcept;
  /// Starts afresh, after silence.
  void reset();

 private:
  struct Slot {
    Eigen::Vector3f p_D = Eigen::Vector3f::Zero();
    int phase = 0;  // [1/256 turn]
  };
  void place(std::size_t focus);
  void join_silent();
  int intensity() const;

  const SlotSettings settings_;
  const int slots_, per_focus_;
  std::vector<Eigen::Isometry3f> X_UD_;
  LiveFocusSolver solver_;
  std::vector<LiveFocus> foci_;
  std::vector<Slot> slot_;
  std::vector<float> middle_;  // phase half-way between a focal point's slots [1/256 turn]
  int reference_ = 0;          // phase of the first slot, which the units take as 0 [1/256 turn]
};

/// Returns the transducers in D of AUTD3 units with the poses X_DU.
TransducerArray autd3_units(std::span<const Pose> units);
/// Returns the pose X_DU of a single unit whose middle is the origin of D.
Pose autd3_middle();

}  // namespace prostm
