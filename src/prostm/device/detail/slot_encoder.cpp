#include "prostm/device/detail/slot_encoder.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "prostm/acoustics/array/transducer.hpp"

namespace prostm {
namespace {

constexpr double kPitch = 10.16e-3;  // [m]
constexpr int kColumns = 18, kRows = 14;
constexpr float kTurn = 2.0F * std::numbers::pi_v<float>;
constexpr int kPhases = 256;    // steps of a turn
constexpr int kIterations = 3;  // more than at 40 kHz: focal points move further per sample

/// Returns the pressure of intensity 1: that of the whole array 200 mm above the origin of D.
double full_scale_of(const TransducerArray& array, const Medium& medium) {
  const Wave sound = wave(array, medium);
  double sum = 0.0;
  for (std::size_t i = 0; i < array.position.size(); ++i)
    sum += std::abs(propagate(array, sound, i, Vec3(0.0, 0.0, 0.2)));
  return sum;
}

LiveFocusSettings solver_settings(std::span<const Pose> units, const Medium& medium,
                                  const SlotSettings& slots) {
  LiveFocusSettings settings;
  settings.iterations = kIterations;
  settings.full_scale = full_scale_of(autd3_units(units), medium);
  settings.adds_phasors = true;
  settings.phase_levels = kPhases;
  // a single slot per focal point cannot play the solver's magnitudes
  if (slots.own_intensities)
    settings.memory = std::exp(-1.0 / (time_constant({}) * slots.sample_rate));
  return settings;
}

SlotWord word_of(const Eigen::Vector3f& p_U, int byte) {
  SlotWord word = static_cast<SlotWord>(byte & 0xFF) << 54;
  for (int axis = 0; axis < 3; ++axis) {
    const float units = std::round(p_U[axis] / static_cast<float>(kSlotUnit));
    const auto most = static_cast<float>(kLargestSlotPlace);
    const auto place = static_cast<std::int64_t>(std::clamp(units, -most, most));
    word |= (static_cast<SlotWord>(place) & 0x3FFFFU) << (18 * axis);
  }
  return word;
}

/// Whether every unit can encode this position, tested without comparing a NaN.
bool is_in_reach(const FocusSample& focus) {
  constexpr float kFarthest = 2.5F;  // [m] from the origin of D, where units may stand too
  for (const float x : focus.p_D)
    if (!std::isfinite(x) || std::abs(x) > kFarthest) return false;
  return std::isfinite(focus.intensity);
}

}  // namespace

int slot_count(const SlotSettings& settings) {
  const int most = settings.own_intensities && settings.foci > 1 ? kMostSlots / 2 : kMostSlots;
  if (settings.foci < 1 || settings.foci > most) {
    throw std::invalid_argument("AUTD3 plays 1 to " + std::to_string(most) + " focal points" +
                                (most < kMostSlots ? " with an intensity each" : "") + ", not " +
                                std::to_string(settings.foci));
  }
  return settings.own_intensities && settings.foci > 1 ? 2 * settings.foci : settings.foci;
}

Pose autd3_middle() {
  return Pose(
      Eigen::Translation3d(-0.5 * kPitch * (kColumns - 1), -0.5 * kPitch * (kRows - 1), 0.0));
}

TransducerArray autd3_units(std::span<const Pose> units) {
  std::vector<TransducerArray> placed;
  for (const Pose& X_DU : units)
    placed.push_back(place(autd3_array(), X_DU * autd3_middle().inverse()));
  return join(placed);
}

SlotEncoder::SlotEncoder(std::span<const Pose> units, const Medium& medium,
                         const SlotSettings& settings)
    : settings_(settings),
      slots_(slot_count(settings)),
      per_focus_(slots_ / settings.foci),
      solver_(autd3_units(units), medium, solver_settings(units, medium, settings)),
      foci_(static_cast<std::size_t>(settings.foci), LiveFocus{{0.0F, 0.0F, 0.2F}, 0.0F}),
      slot_(static_cast<std::size_t>(slots_)),
      middle_(foci_.size(), 0.0F) {
  for (const Pose& X_DU : units) X_UD_.push_back(X_DU.inverse().cast<float>());
}

void SlotEncoder::reset() {
  solver_.reset();
  std::fill(middle_.begin(), middle_.end(), 0.0F);
  reference_ = 0;
}

void SlotEncoder::encode(std::span<const FocusSample> sample, std::span<SlotWord> words) noexcept {
  for (std::size_t f = 0; f < foci_.size(); ++f) {
    const bool sounds = f < sample.size() && is_in_reach(sample[f]);
    if (sounds) foci_[f].p_D = sample[f].p_D;
    foci_[f].amplitude = sounds ? std::clamp(sample[f].intensity, 0.0F, 1.0F) : 0.0F;
  }
  solver_.solve(foci_);
  for (std::size_t f = 0; f < foci_.size(); ++f) place(f);
  if (per_focus_ == 1) join_silent();
  solver_.play(
      std::polar(1.0F, kTurn / kPhases * static_cast<float>(slot_.front().phase - reference_)));
  reference_ = slot_.front().phase;
  auto word = words.begin();
  for (const Eigen::Isometry3f& X_UD : X_UD_) {
    for (const Slot& slot : slot_) {
      const int byte = &slot == slot_.data() ? intensity() : slot.phase - slot_.front().phase;
      *word++ = word_of(X_UD * slot.p_D, byte);
    }
  }
}

/// Sets a focal point's slots. Two slots of phases φ ± δ add up to 2 cos δ e^{iφ}; those of a
/// silent focal point cancel.
void SlotEncoder::place(std::size_t focus) {
  const std::complex<float> c = solver_.coefficient(focus);
  float size = std::min(std::abs(c), 1.0F);
  // AUTD3 uses the negative phase of the sum, so its phases are those of c*. All other phases are
  // relative to that of the first slot, which must not jump: a silent focal point keeps its phase,
  // and one that changes sign passes through silence, with δ through a quarter turn.
  if (size > 0.0F) {
    float turned = -std::arg(c) / kTurn * kPhases - middle_[focus];
    turned -= kPhases * std::round(turned / kPhases);
    if (per_focus_ > 1 && std::abs(turned) > kPhases / 4) {
      size = -size;
      turned -= std::copysign(kPhases / 2.0F, turned);
    }
    middle_[focus] += turned;
  }
  const float middle = middle_[focus];
  const std::size_t first = focus * static_cast<std::size_t>(per_focus_);
  const Eigen::Vector3f& p_D = foci_[focus].p_D;
  if (per_focus_ == 1) {
    slot_[first] = {p_D, static_cast<int>(std::lround(middle))};
    return;
  }
  const int apart = static_cast<int>(std::lround(2.0F * std::acos(size) / kTurn * kPhases));
  const int phase = static_cast<int>(std::lround(middle - 0.5F * static_cast<float>(apart)));
  slot_[first] = {p_D, phase};
  slot_[first + 1] = {p_D, phase + apart};
}

/// Moves the slot of each silent focal point to one that sounds: a single slot cannot cancel
/// itself.
void SlotEncoder::join_silent() {
  const auto sounds = [&](const Slot& slot) {
    return solver_.coefficient(static_cast<std::size_t>(&slot - slot_.data())) != 0.0F;
  };
  const auto first = std::find_if(slot_.begin(), slot_.end(), sounds);
  if (first == slot_.end()) return;
  for (Slot& slot : slot_)
    if (!sounds(slot)) slot = *first;
}

int SlotEncoder::intensity() const {
  return static_cast<int>(std::lround(255.0F * std::clamp(solver_.magnitude(), 0.0F, 1.0F)));
}

}  // namespace prostm
