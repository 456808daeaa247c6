#pragma once
/// Hands that are held still, but for a tremor: from a recording, or posed.

#include <memory>
#include <string>

#include "prostm/track/hand_source.hpp"

namespace prostm::bench {

/// Where and how a hand is held over the array.
struct Hold {
  double x = 0.0, y = 0.0;  ///< of the palm joint, in D [m]
  double height = 0.215;    ///< of the palm joint above the array [m]
  double tilt = 0.0;        ///< of the palm about D's y [rad]
  /// the hand trembles as the palm of its recording does above this frequency [Hz]; 0: it is still
  double tremor_above = 0.0;
};

/// The flattest pose of a recording (that whose fingertips are nearest to the palm's plane), turned
/// so that its palm is level and its fingers point away from the user, and put where `hold` says.
/// It trembles for a minute as the palm of the recording does in its stillest two seconds, again
/// and again.
/// @throws InputError for a file that is no recording.
std::unique_ptr<HandSource> make_held_hand(const std::string& recording, const Hold& hold);

/// A hand of any source as it is at time 0, moved, tilted and held there.
std::unique_ptr<HandSource> make_still_hand(HandSource& source, const Hold& hold);

/// A hand of which only the index finger is stretched out, level, with its pad over (x, y) and its
/// axis at `height`. The other fingers end at their knuckles and the thumb at its root, so that the
/// finger alone is in the flow.
std::unique_ptr<HandSource> make_finger(double x, double y, double height);

}  // namespace prostm::bench
