#include "prostm/track/detail/hand_convention.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace prostm {
namespace {

// A tracker's joint frames follow the bones within a few degrees; these bounds are 45° on average
// and 90° for a single bone. A hand seen edge-on has no clear side.
constexpr double kLeastMean = 0.7, kLeastDot = 0.0, kClearSide = 0.3;

/// First joints of the bones from knuckle to tip of the four fingers, whose frames all trackers
/// define alike.
constexpr std::array<int, 12> kBones = {kIndexProximal,  kIndexIntermediate,  kIndexDistal,
                                        kMiddleProximal, kMiddleIntermediate, kMiddleDistal,
                                        kRingProximal,   kRingIntermediate,   kRingDistal,
                                        kLittleProximal, kLittleIntermediate, kLittleDistal};

/// Whether −z of each bone's frame points along the bone.
bool follows_bones(const Hand& hand) {
  double sum = 0.0, least = 1.0;
  for (const int bone : kBones) {
    const auto j = static_cast<std::size_t>(bone);
    const Vec3 along = (hand.position[j + 1] - hand.position[j]).normalized();
    const double dot = -along.dot(hand.orientation[j] * Vec3::UnitZ());
    sum += dot;
    least = std::min(least, dot);
  }
  return sum >= kLeastMean * static_cast<double>(kBones.size()) && least >= kLeastDot;
}

/// Returns the handedness, −1 to 1: above 0 for a right hand, below 0 for a left one. It follows
/// from the side of the little finger on which the index finger lies, seen from the hand's back.
double sidedness(const Hand& hand) {
  const Vec3 across = hand.position[kIndexProximal] - hand.position[kLittleProximal],
             along = hand.position[kMiddleProximal] - hand.position[kWrist];
  const double size = across.norm() * along.norm();
  if (!(size > 0.0)) return 0.0;
  return -across.cross(along).dot(hand.orientation[kPalm] * Vec3::UnitY()) / size;
}

bool is_on_its_side(const Hand& hand) {
  return sidedness(hand) * (hand.side == Side::Right ? 1.0 : -1.0) > -kClearSide;
}

bool fits(const Hand& hand) {
  return follows_bones(hand) && is_on_its_side(hand);
}

/// A convention in which a hand may have been recorded: coordinates transformed by M, orientations
/// either transformed in the same way (M R Mᵀ) or left unchanged.
struct Convention {
  const char* words;
  Eigen::Matrix3d M;
};

Eigen::Matrix3d rows(const Vec3& x, const Vec3& y, const Vec3& z) {
  Eigen::Matrix3d M;
  M.row(0) = x.transpose();
  M.row(1) = y.transpose();
  M.row(2) = z.transpose();
  return M;
}

std::array<Convention, 5> conventions() {
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  return {{{"mirrored in z, as in Unity's left-handed axes", rows(x, y, -z)},
           {"mirrored in y", rows(x, -y, z)},
           {"mirrored in x", rows(-x, y, z)},
           {"given with y and z exchanged", rows(x, z, y)},
           {"given with z up", rows(x, z, -y)}}};
}

/// Returns the hand, read in a convention: M maps the file's coordinates to T's.
Hand read_as(const Hand& hand, const Eigen::Matrix3d& M, bool turn) {
  Hand out = hand;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    out.position[j] = M * hand.position[j];
    if (turn) {
      out.orientation[j] =
          Quat(Eigen::Matrix3d(M * hand.orientation[j].toRotationMatrix() * M.transpose()));
    }
  }
  return out;
}

/// Returns the hand with its quaternions read as w, x, y, z.
Hand with_w_first(const Hand& hand) {
  Hand out = hand;
  for (Quat& q : out.orientation) q = Quat(q.x(), q.y(), q.z(), q.w());
  return out;
}

/// Returns the convention with mirrored or exchanged axes that the hand fits, or nothing.
std::optional<std::string> axes_of(const Hand& hand) {
  for (const bool turn : {true, false}) {
    for (const Convention& convention : conventions()) {
      if (fits(read_as(hand, convention.M, turn))) return convention.words;
    }
  }
  return {};
}

HandProblem problem_of_axes(const Hand& hand) {
  constexpr const char* kAxes =
      "T has x right, y up and z to the user, and -z of a joint along its bone";
  const auto words = [&](const std::string& guess) {
    return HandProblem{HandFault::Axes, fmt::format("{}; {}", guess, kAxes)};
  };
  if (fits(with_w_first(hand)))
    return words("has quaternions in the order w, x, y, z; they must be x, y, z, w");
  if (const auto axes = axes_of(hand)) return words("seems " + *axes);
  if (const auto axes = axes_of(with_w_first(hand)))
    return words("seems " + *axes + ", with quaternions in the order w, x, y, z");
  return words("has joint frames that do not follow its bones");
}

HandProblem problem_of_side(const Hand& hand) {
  const bool right = hand.side == Side::Right;
  // fingers that point to the user suggest a mirrored z; a hand from behind the tracker is as
  // likely
  const bool towards_user = hand.position[kMiddleProximal].z() - hand.position[kWrist].z() > 0.0;
  return {HandFault::Side,
          fmt::format("is called {}, but its joints are those of a {} hand; {}", name_of(hand.side),
                      right ? "left" : "right",
                      towards_user
                          ? "z seems mirrored, as in Unity's left-handed axes (T has z to the user)"
                          : "left and right seem exchanged, or an axis is mirrored")};
}

}  // namespace

std::optional<HandProblem> convention_problem(const Hand& hand) {
  if (!follows_bones(hand)) return problem_of_axes(hand);
  if (!is_on_its_side(hand)) return problem_of_side(hand);
  return {};
}

bool looks_z_up(const Hand& hand) {
  constexpr double kAbove = 0.08;  // [m]
  const Vec3 palm = hand.position[kPalm], normal = -(hand.orientation[kPalm] * Vec3::UnitY());
  return palm.z() > kAbove && palm.y() < 0.5 * palm.z() && normal.z() < -0.7;
}

}  // namespace prostm
