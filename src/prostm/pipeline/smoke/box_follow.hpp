#pragma once
/// A box that goes with the hand, so that it can be small and its cells fine.

#include "prostm/core/geometry.hpp"
#include "prostm/core/settings.hpp"
#include "prostm/core/text/names.hpp"
#include "prostm/fluid/fluid.hpp"
#include "prostm/track/hand_frame.hpp"

namespace prostm {

/// The point that the box of the smoke follows, of the hand that is nearest to it; nothing: it
/// stays over the array's centre.
enum class BoxFollows : std::uint8_t { Nothing, Palm, Index };
template <>
inline constexpr std::array<std::string_view, 3> kNames<BoxFollows> = {"nothing", "palm", "index"};

struct BoxSettings {
  BoxFollows follow = BoxFollows::Nothing;

  void visit(SettingsReader& v) const;
  void visit(SettingsWriter& v);
  bool operator==(const BoxSettings&) const = default;
};

/// Keeps the point in the middle of the box, and at two thirds of its height, since what presses on
/// a hand comes from below. The box moves by whole cells, and only when the point is more than
/// kSlack of an edge away. Its floor stays between the array and kHighestFloor, up to which guided
/// jets are as they left the array, and wide ones nearly.
class BoxFollower {
 public:
  /// @param home the box over the array.
  BoxFollower(const BoxSettings& settings, const GridShape& home)
      : settings_(settings), home_(home) {}

  /// Returns by how many cells a box that is at `now` has to move. Hands without a finite place
  /// move nothing.
  CellShift shift(const HandFrame& hands, const GridShape& now) const noexcept;

  static constexpr double kSlack = 1.0 / 16.0;   ///< over the box's edge
  static constexpr double kHighestFloor = 0.10;  ///< above the array [m]

 private:
  BoxSettings settings_;
  GridShape home_;
};

}  // namespace prostm
