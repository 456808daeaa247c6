#pragma once
/// Hands from an OpenXR runtime (XR_EXT_hand_tracking), without a display (XR_MND_headless).

#include <memory>

#include "prostm/track/live/live_tracker.hpp"

namespace prostm {

/// Locates the joints of both hands 100 times a second on its own thread, in the runtime's STAGE
/// space if it has one, else in LOCAL; OpenXR's axes are those of T. A hand is present if the
/// runtime calls all of its joints valid and no bone length is impossible. Its confidence is the
/// share of joints that the runtime calls tracked, not inferred; radii are clamped to 3 to 40 mm.
/// If the session ends or is lost, the tracker requests another one every second.
/// @throws InputError with a sentence when there is no runtime, or it cannot track hands without a
/// display.
std::unique_ptr<LiveTracker> make_openxr_tracker();

/// Says why this machine's OpenXR cannot track hands, as far as is known without a session; empty
/// if no reason is known.
std::string openxr_problem();

}  // namespace prostm
