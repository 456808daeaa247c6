#include "prostm/track/hand_frame.hpp"

namespace prostm {
namespace {

constexpr std::array<std::string_view, kJointCount> kJointNames = {"palm",
                                                                   "wrist",
                                                                   "thumb-metacarpal",
                                                                   "thumb-proximal",
                                                                   "thumb-distal",
                                                                   "thumb-tip",
                                                                   "index-metacarpal",
                                                                   "index-proximal",
                                                                   "index-intermediate",
                                                                   "index-distal",
                                                                   "index-tip",
                                                                   "middle-metacarpal",
                                                                   "middle-proximal",
                                                                   "middle-intermediate",
                                                                   "middle-distal",
                                                                   "middle-tip",
                                                                   "ring-metacarpal",
                                                                   "ring-proximal",
                                                                   "ring-intermediate",
                                                                   "ring-distal",
                                                                   "ring-tip",
                                                                   "little-metacarpal",
                                                                   "little-proximal",
                                                                   "little-intermediate",
                                                                   "little-distal",
                                                                   "little-tip"};

}  // namespace

std::string_view joint_name(int joint) {
  return joint >= 0 && joint < kJointCount ? kJointNames[static_cast<std::size_t>(joint)] : "none";
}

void to_device(const Pose& X_DT, HandFrame& frame) {
  const Eigen::Matrix3d R_DT = X_DT.linear();
  const Quat q_DT(R_DT);
  for (Hand& hand : frame.hands) {
    for (std::size_t j = 0; j < kJointCount; ++j) {
      hand.position[j] = X_DT * hand.position[j];
      hand.orientation[j] = (q_DT * hand.orientation[j]).normalized();
      hand.velocity[j] = R_DT * hand.velocity[j];
    }
  }
}

Pose default_tracker_pose() {
  Pose X_DT = Pose::Identity();
  X_DT.linear() << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  return X_DT;
}

Pose ultraleap_kit_pose() {
  return tracker_kit_pose(kTrackerKits[0]);
}

Pose tracker_kit_pose(const TrackerKit& kit) {
  Pose X_DT = default_tracker_pose();
  X_DT.translation() = Vec3(0.0, kit.y, 0.0);
  return X_DT;
}

}  // namespace prostm
