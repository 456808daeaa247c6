#pragma once
/// A box that follows the hand, so that it can be small, with fine cells.

#include "prostm/core/geometry.hpp"
#include "prostm/core/settings.hpp"
#include "prostm/core/text/names.hpp"
#include "prostm/fluid/fluid.hpp"
#include "prostm/track/hand_frame.hpp"

namespace prostm {

/// The point that the box follows, on the hand nearest to it. Nothing: the box stays over the
/// array's centre.
enum class BoxFollows : std::uint8_t { Nothing, Palm, Index };
template <>
inline constexpr std::array<std::string_view, 3> kNames<BoxFollows> = {"nothing", "palm", "index"};

struct BoxSettings {
  BoxFollows follow = BoxFollows::Nothing;

  void visit(SettingsReader& v) const;
  void visit(SettingsWriter& v);
  bool operator==(const BoxSettings&) const = default;
};

/// Keeps the point at the centre of the box in x and y, and at two thirds of its height, since jets
/// come from below. The box moves by whole cells, and only when the point is off by more than
/// kSlack of an edge. Its floor stays between the array and kHighestFloor; up to there, guided jets
/// are unchanged since they left the array, and wide ones nearly so.
class BoxFollower {
 public:
  /// @param home the box over the array.
  BoxFollower(const BoxSettings& settings, const GridShape& home)
      : settings_(settings), home_(home) {}

  /// Returns the shift of a box at `now`, in cells. Hands without a finite position are ignored.
  CellShift shift(const HandFrame& hands, const GridShape& now) const noexcept;

  static constexpr double kSlack = 1.0 / 16.0;   ///< as a share of the box's edge
  static constexpr double kHighestFloor = 0.10;  ///< above the array [m]

 private:
  BoxSettings settings_;
  GridShape home_;
};

}  // namespace prostm
