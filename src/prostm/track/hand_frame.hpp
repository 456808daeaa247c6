#pragma once
/// Data from a hand tracker: up to two hands of 26 joints each.

#include <array>
#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <string_view>

#include "prostm/core/geometry.hpp"
#include "prostm/core/text/names.hpp"

namespace prostm {

/// The joints and their order are OpenXR's XrHandJointEXT.
enum Joint : int {
  kPalm,
  kWrist,
  kThumbMetacarpal,
  kThumbProximal,
  kThumbDistal,
  kThumbTip,
  kIndexMetacarpal,
  kIndexProximal,
  kIndexIntermediate,
  kIndexDistal,
  kIndexTip,
  kMiddleMetacarpal,
  kMiddleProximal,
  kMiddleIntermediate,
  kMiddleDistal,
  kMiddleTip,
  kRingMetacarpal,
  kRingProximal,
  kRingIntermediate,
  kRingDistal,
  kRingTip,
  kLittleMetacarpal,
  kLittleProximal,
  kLittleIntermediate,
  kLittleDistal,
  kLittleTip,
  kJointCount
};

std::string_view joint_name(int joint);  ///< "palm", "wrist", "thumb-metacarpal", …

enum class Side : std::uint8_t { Left, Right };
template <>
inline constexpr std::array<std::string_view, 2> kNames<Side> = {"left", "right"};

/// One hand. Positions are in the frame of its source: T from trackers and recordings, D after
/// to_device(). Joint frames follow OpenXR: −z along the bone to the tip, +y dorsal.
struct Hand {
  std::int64_t id = 0;  ///< stays with a hand while it is tracked
  Side side = Side::Right;
  double confidence = 1.0;     ///< 0..1
  std::uint32_t inferred = 0;  ///< bit 0: metacarpals are reconstructed, bit 1: the wrist is
  std::array<Vec3, kJointCount> position;     ///< [m]
  std::array<Quat, kJointCount> orientation;  ///< unit quaternions
  std::array<double, kJointCount> radius{};   ///< radius of the flesh around the joint [m]
  std::array<Vec3, kJointCount> velocity;     ///< [m/s]
};

struct HandFrame {
  double time = 0.0;  ///< [s]
  /// `time` minus the arrival time of the tracker's frame that this one is computed from; 0 for
  /// hands computed for exactly `time` [s]
  double age = 0.0;
  boost::container::static_vector<Hand, 2> hands;
};

/// Transforms positions, velocities and orientations of a frame from T to D.
void to_device(const Pose& X_DT, HandFrame& frame);

/// Pose at the array's centre, axes (x, y, z)_T → (x, −z, y)_D.
Pose default_tracker_pose();
/// Pose in the Ultraleap kit: the tracker sits 121 mm along +y of D from the array's centre.
Pose ultraleap_kit_pose();

/// A kit that holds a tracker beside its array, at (0, y, 0) of D; axes as at the array's centre.
struct TrackerKit {
  const char* name;
  double y;  ///< [m]
};
inline constexpr TrackerKit kTrackerKits[] = {{"ultraleap-kit", 0.121},
                                              {"ultraleap-usi-kit", -0.089},
                                              {"ultraleap-uhdk5-square-kit", 0.1105},
                                              {"ultraleap-uhdk5-rectangular-kit", 0.163}};
Pose tracker_kit_pose(const TrackerKit& kit);

}  // namespace prostm
