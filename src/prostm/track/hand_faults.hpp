#pragma once
/// Faults in a tracker's data, counted by cause.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "prostm/core/input_error.hpp"
#include "prostm/core/text/names.hpp"

namespace prostm {

/// Cause for dropping data: the first three drop a whole frame, the others a single hand.
enum class HandFault : std::uint8_t {
  Unreadable,  ///< not JSON, or without a list of hands
  Time,        ///< the time is missing or not a number
  Order,       ///< the time does not fit between adjacent frames: repeated, earlier, or an outlier
  Member,      ///< a member is missing, of another type, or out of bounds
  Fingers,     ///< a finger is missing or duplicated
  Bones,       ///< a radius or a distance between joints is implausible
  Axes,        ///< axes or orientations are not unit, or do not follow the bones
  Side,        ///< the joints are those of the other side's hand
  Twice,       ///< another hand of the frame has the same id
  Third        ///< the frame has two other hands
};
inline constexpr std::size_t kHandFaults = 10;
template <>
inline constexpr std::array<std::string_view, kHandFaults> kNames<HandFault> = {
    "unreadable", "time", "order", "member", "fingers", "bones", "axes", "side", "twice", "third"};

constexpr bool costs_frame(HandFault fault) {
  return fault <= HandFault::Order;
}

/// An error in a tracker's data with its cause.
class HandError : public InputError {
 public:
  HandError(HandFault fault, const std::string& sentence) : InputError(sentence), fault_(fault) {}
  HandFault fault() const { return fault_; }

 private:
  HandFault fault_;
};

/// Frames and hands that were dropped, by cause.
struct HandFaults {
  std::array<std::int64_t, kHandFaults> count{};  ///< one per HandFault
  std::string first, last;                        ///< the first and the last fault, as sentences

  std::int64_t frames() const;  ///< frames dropped
  std::int64_t hands() const;   ///< hands dropped from frames that were kept
  bool any() const { return frames() + hands() > 0; }
  void add(HandFault fault, const std::string& sentence);
  /// Adds faults that occurred after these.
  void add(const HandFaults& later);
};

/// Returns the causes with their counts, e.g. "3 bones, 1 order"; empty without faults.
std::string causes_of(const HandFaults& faults);

}  // namespace prostm
