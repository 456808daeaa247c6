#pragma once
/// Hands from an OpenXR runtime (XR_EXT_hand_tracking), without a display (XR_MND_headless).

#include <memory>

#include "prostm/track/live/live_tracker.hpp"

namespace prostm {

/// Locates the joints of both hands 100 times a second on its own thread, in the runtime's STAGE
/// space where it has one, else in LOCAL; OpenXR's axes are those of T. A hand is there when the
/// runtime says that all of its joints are and no bone is absurd; its confidence is the share of
/// them that the runtime calls tracked, not inferred; radii are clamped to 3 to 40 mm. Where no
/// session can begin (no runtime, or one that cannot track hands without a display, or no headset),
/// and when a session ends or is lost, it asks for another one every second; the status says why.
std::unique_ptr<LiveTracker> make_openxr_tracker();

/// Says why this machine's OpenXR cannot track hands, as far as is known without a session; empty
/// if no reason is known.
std::string openxr_problem();

}  // namespace prostm
