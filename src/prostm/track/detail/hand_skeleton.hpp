#pragma once
/// A hand of average size from a pose and joint angles. Private to track.

#include "prostm/track/hand_frame.hpp"

namespace prostm {

/// Poses the joints of a hand, (H2) and (H3) of docs/design/hands.md; the left hand is the right
/// one mirrored at x = 0 of H.
/// @param X_TH pose of the palm: origin at the palm joint, x towards the right (of a right hand:
/// towards the little finger), y dorsal, z towards the wrist.
/// @param closure of the fingers: 0 open, 1 a loose fist. Beyond these it extrapolates.
/// Sets side, position, orientation and radius of `hand`; other members keep their values.
void pose_skeleton(const Pose& X_TH, double closure, Side side, Hand& hand) noexcept;

/// Poses a flat hand: straight fingers that touch, the thumb beside the index finger, every joint
/// of the fingers in the palm's plane. @param X_TH as above.  @param size factor on all lengths.
void pose_flat_hand(const Pose& X_TH, double size, Side side, Hand& hand) noexcept;

}  // namespace prostm
