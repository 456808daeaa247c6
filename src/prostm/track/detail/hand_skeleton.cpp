#include "prostm/track/detail/hand_skeleton.hpp"

#include <cmath>

#include "prostm/core/units.hpp"

namespace prostm {
namespace {

using namespace literals;

constexpr double degrees(double x) {
  return x * kPi / 180.0;
}

/// Bone lengths are the means of Buryanov and Kotiuk (2010); radii of the flesh are those that
/// headsets report.
struct FingerShape {
  Joint base;        // the metacarpal joint
  double x, y, z;    // position of the metacarpal's base in H [m]
  double splay;      // splay of the metacarpal towards the thumb, about y [rad]
  double spread;     // further splay of the finger at its knuckle [rad]
  double length[4];  // metacarpal, proximal, intermediate, distal [m]
  double radius[5];  // at the metacarpal's base, the knuckle, …, the tip [m]
};

constexpr FingerShape kFingers[4] = {{kIndexMetacarpal,
                                      -11.0_mm,
                                      -1.0_mm,
                                      33.0_mm,
                                      degrees(10.0),
                                      degrees(2.0),
                                      {68.12_mm, 39.78_mm, 22.38_mm, 15.82_mm},
                                      {18.2_mm, 10.3_mm, 8.5_mm, 7.6_mm, 6.6_mm}},
                                     {kMiddleMetacarpal,
                                      0.0_mm,
                                      0.0_mm,
                                      32.3_mm,
                                      degrees(0.0),
                                      degrees(0.0),
                                      {64.60_mm, 44.63_mm, 26.33_mm, 17.40_mm},
                                      {18.2_mm, 11.2_mm, 8.0_mm, 7.6_mm, 6.6_mm}},
                                     {kRingMetacarpal,
                                      9.5_mm,
                                      -0.5_mm,
                                      31.0_mm,
                                      degrees(-8.5),
                                      degrees(-1.0),
                                      {57.95_mm, 41.37_mm, 25.65_mm, 17.30_mm},
                                      {16.6_mm, 9.9_mm, 7.6_mm, 7.2_mm, 6.2_mm}},
                                     {kLittleMetacarpal,
                                      18.0_mm,
                                      -3.5_mm,
                                      29.0_mm,
                                      degrees(-17.0),
                                      degrees(-4.0),
                                      {53.69_mm, 32.74_mm, 18.11_mm, 15.96_mm},
                                      {15.6_mm, 8.5_mm, 6.8_mm, 6.4_mm, 5.4_mm}}};

constexpr double kThumbLength[3] = {46.22_mm, 31.57_mm, 21.67_mm};
constexpr double kThumbRadius[4] = {17.0_mm, 12.3_mm, 9.8_mm, 8.8_mm};
constexpr double kPalmRadius = 15.0_mm, kWristRadius = 20.0_mm;

// flexion of knuckle, middle and last joint, open and at closure 1
constexpr double kOpen[3] = {degrees(6.0), degrees(10.0), degrees(6.0)};
constexpr double kClosed[3] = {degrees(70.0), degrees(95.0), degrees(55.0)};
constexpr double kThumbOpen[3] = {degrees(0.0), degrees(8.0), degrees(6.0)};
constexpr double kThumbClosed[3] = {degrees(12.0), degrees(40.0), degrees(45.0)};

/// Frame of the open hand's thumb in H: −z along its metacarpal, +y away from the palm's inside.
Eigen::Matrix3d thumb_frame() {
  const Vec3 z = Vec3(0.62, 0.30, 0.72).normalized();
  const Vec3 outward(-0.70, 0.35, 0.60);
  Eigen::Matrix3d R_HB;
  R_HB.col(2) = z;
  R_HB.col(0) = outward.cross(z).normalized();
  R_HB.col(1) = z.cross(R_HB.col(0));
  return R_HB;
}

/// Flexion bends a bone's −z axis towards the palm side, −y.
Eigen::Matrix3d flexed(double angle) {
  return Eigen::AngleAxisd(-angle, Vec3::UnitX()).toRotationMatrix();
}
Eigen::Matrix3d splayed(double angle) {
  return Eigen::AngleAxisd(angle, Vec3::UnitY()).toRotationMatrix();
}

/// Walks along `bones` bones from hand.position[first]; R_TB is the frame of the first of them, and
/// each joint after it bends by its flexion. The last joint keeps the frame of the bone before it.
void walk(Eigen::Matrix3d R_TB, int first, int bones, const double* lengths, const double* flexion,
          Hand& hand) {
  for (int b = 0; b < bones; ++b) {
    const auto joint = static_cast<std::size_t>(first + b);
    if (b > 0) R_TB = R_TB * flexed(flexion[b - 1]);
    hand.orientation[joint] = Quat(R_TB);
    hand.position[joint + 1] = hand.position[joint] - lengths[b] * R_TB.col(2);
  }
  hand.orientation[static_cast<std::size_t>(first + bones)] = Quat(R_TB);
}

void bend(const double* open, const double* closed, double closure, double* flexion) {
  for (int i = 0; i < 3; ++i) flexion[i] = open[i] + closure * (closed[i] - open[i]);
}

void pose_right(const Pose& X_TH, double closure, Hand& hand) {
  const Eigen::Matrix3d R_TH = X_TH.linear();

  // palm and wrist move as one
  hand.position[kPalm] = X_TH.translation();
  hand.position[kWrist] = X_TH * Vec3(2.0_mm, -2.0_mm, 58.0_mm);
  hand.orientation[kPalm] = hand.orientation[kWrist] = Quat(R_TH);
  hand.radius[kPalm] = kPalmRadius;
  hand.radius[kWrist] = kWristRadius;

  // four fingers: the metacarpal is rigid to the palm, the knuckle spreads and bends
  double flexion[3];
  bend(kOpen, kClosed, closure, flexion);
  for (const FingerShape& finger : kFingers) {
    const auto base = static_cast<std::size_t>(finger.base);
    const Eigen::Matrix3d R_TM = R_TH * splayed(finger.splay);
    hand.position[base] = X_TH * Vec3(finger.x, finger.y, finger.z);
    hand.position[base + 1] = hand.position[base] - finger.length[0] * R_TM.col(2);
    hand.orientation[base] = Quat(R_TM);
    walk(R_TM * splayed(finger.spread) * flexed(flexion[0]), finger.base + 1, 3, finger.length + 1,
         flexion + 1, hand);
    for (std::size_t j = 0; j < 5; ++j) hand.radius[base + j] = finger.radius[j];
  }

  // the thumb bends at its root too
  bend(kThumbOpen, kThumbClosed, closure, flexion);
  hand.position[kThumbMetacarpal] = X_TH * Vec3(-20.0_mm, -10.0_mm, 42.0_mm);
  walk(R_TH * thumb_frame() * flexed(flexion[0]), kThumbMetacarpal, 3, kThumbLength, flexion + 1,
       hand);
  for (std::size_t j = 0; j < 4; ++j) hand.radius[kThumbMetacarpal + j] = kThumbRadius[j];
}

// the flat hand: x of the tips, which touch, and the thumb's bones, which lie alongside the palm
constexpr double kFlatTips[4] = {-14.0_mm, 0.0_mm, 12.9_mm, 24.0_mm};  // x in H [m]
constexpr double kFlatThumb[3] = {degrees(21.5), degrees(2.0),
                                  degrees(-5.5)};  // splay of each bone

void pose_flat_right(Hand& hand) {
  pose_right(Pose::Identity(), 0.0, hand);
  for (std::size_t f = 0; f < 4; ++f) {
    const FingerShape& finger = kFingers[f];
    const auto base = static_cast<std::size_t>(finger.base);
    hand.position[base].y() = 0.0;
    hand.position[base + 1] = hand.position[base] - finger.length[0] * splayed(finger.splay).col(2);
    const double length = finger.length[1] + finger.length[2] + finger.length[3];
    const double turn = std::asin((hand.position[base + 1].x() - kFlatTips[f]) / length);
    constexpr double kStraight[2] = {0.0, 0.0};
    walk(splayed(turn), finger.base + 1, 3, finger.length + 1, kStraight, hand);
  }
  hand.position[kThumbMetacarpal] = Vec3(-20.0_mm, -3.0_mm, 42.0_mm);
  for (std::size_t b = 0; b < 3; ++b) {
    const Eigen::Matrix3d R_HB = splayed(kFlatThumb[b]);
    hand.position[kThumbMetacarpal + b + 1] =
        hand.position[kThumbMetacarpal + b] - kThumbLength[b] * R_HB.col(2);
    hand.orientation[kThumbMetacarpal + b] = hand.orientation[kThumbTip] = Quat(R_HB);
  }
}

/// Mirrors a hand at x = 0 of H, by M: points become M p, rotations M R M (again a rotation).
void mirror(Hand& hand) {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    hand.position[j].x() *= -1.0;
    const Quat& q = hand.orientation[j];
    hand.orientation[j] = Quat(q.w(), q.x(), -q.y(), -q.z());
  }
}

/// Moves a hand that was posed in H, `size` times as large.
void move_to(const Pose& X_TH, double size, Hand& hand) {
  const Quat q_TH(X_TH.linear());
  for (std::size_t j = 0; j < kJointCount; ++j) {
    hand.position[j] = X_TH * Vec3(size * hand.position[j]);
    hand.orientation[j] = (q_TH * hand.orientation[j]).normalized();
    hand.radius[j] *= size;
  }
}

}  // namespace

void pose_skeleton(const Pose& X_TH, double closure, Side side, Hand& hand) noexcept {
  hand.side = side;
  if (side == Side::Right) {
    pose_right(X_TH, closure, hand);
    return;
  }
  pose_right(Pose::Identity(), closure, hand);
  mirror(hand);
  move_to(X_TH, 1.0, hand);
}

void pose_flat_hand(const Pose& X_TH, double size, Side side, Hand& hand) noexcept {
  hand.side = side;
  pose_flat_right(hand);
  if (side == Side::Left) mirror(hand);
  move_to(X_TH, size, hand);
}

}  // namespace prostm
