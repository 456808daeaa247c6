#pragma once
/// Hands from an OpenXR runtime (XR_EXT_hand_tracking), without a display (XR_MND_headless).

#include <memory>

#include "prostm/track/live/live_tracker.hpp"

namespace prostm {

/// Locates the joints of both hands 100 times a second on its own thread, in the runtime's STAGE
/// space where it has one, else in LOCAL; OpenXR's axes are those of T. A hand is there when the
/// runtime says that all of its joints are and no bone is absurd; its confidence is the share of
/// them that the runtime calls tracked, not inferred; radii are clamped to 3 to 40 mm. When the
/// session ends or is lost, it asks for another one every second.
/// @throws InputError with a sentence when there is no runtime, or it cannot track hands without a
/// display.
std::unique_ptr<LiveTracker> make_openxr_tracker();

/// Why this machine's OpenXR cannot do it, as far as can be told without a session; empty when
/// nothing speaks against it.
std::string openxr_problem();

}  // namespace prostm
