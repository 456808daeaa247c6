#pragma once
/// Hands from an OpenXR runtime (XR_EXT_hand_tracking), without a display (XR_MND_headless).

#include <memory>

#include "prostm/track/live/live_tracker.hpp"

namespace prostm {

/// Locates the joints of both hands 100 times a second on its own thread, in the runtime's STAGE
/// space if it has one, else in LOCAL; OpenXR's axes are those of T. A hand is present if the
/// runtime reports all of its joints and every bone is plausible; its confidence is the share of
/// joints reported as tracked, not inferred; radii are clamped to 3 to 40 mm. If no session can
/// start (no runtime, one that cannot track hands without a display, or no headset), or a session
/// ends or is lost, it retries every second; the status gives the reason.
std::unique_ptr<LiveTracker> make_openxr_tracker();

/// Returns the reason why this machine's OpenXR cannot track hands, as far as it is known without a
/// session; empty if no reason is known.
std::string openxr_problem();

}  // namespace prostm
