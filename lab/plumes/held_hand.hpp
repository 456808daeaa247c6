#pragma once
/// Hands that are held still, except for a tremor: from a recording, or posed.

#include <memory>
#include <string>

#include "prostm/track/hand_source.hpp"

namespace prostm::bench {

/// Place and pose of a hand that is held over the array.
struct Hold {
  double x = 0.0, y = 0.0;  ///< of the palm joint, in D [m]
  double height = 0.215;    ///< of the palm joint above the array [m]
  double tilt = 0.0;        ///< of the palm about D's y [rad]
  /// the hand trembles as the palm of its recording does above this frequency [Hz]; 0: it is still
  double tremor_above = 0.0;
};

/// Returns the flattest pose of a recording (that whose fingertips are nearest to the palm's
/// plane), turned so that its palm is level and its fingers point away from the user, and placed as
/// `hold` states. For a minute it repeats the tremor of the recording's stillest two seconds.
/// @throws InputError for a file that is not a recording.
std::unique_ptr<HandSource> make_held_hand(const std::string& recording, const Hold& hold);

/// Returns the hand of a source at time 0, moved, tilted and held there.
std::unique_ptr<HandSource> make_still_hand(HandSource& source, const Hold& hold);

/// Returns a hand with only the index finger extended, level, with its pad over (x, y) and its axis
/// at `height`. The other fingers end at their knuckles and the thumb at its root, so that only
/// the finger is in the flow.
std::unique_ptr<HandSource> make_finger(double x, double y, double height);

}  // namespace prostm::bench
