#include "prostm/track/live/leap_frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "prostm/core/input_error.hpp"
#include "prostm/core/text/json.hpp"
#include "prostm/track/hand_json.hpp"

namespace prostm {
namespace {

using nlohmann::json;

constexpr double kMaxLeapDistance = 1.0;  // no Leap sees that far [m]
constexpr int kFingers = 5;               // thumb, index, middle, ring, little
constexpr int kFirstJoint[kFingers] = {kThumbMetacarpal, kIndexMetacarpal, kMiddleMetacarpal,
                                       kRingMetacarpal, kLittleMetacarpal};

// The Leap skeleton is a single template, scaled as a whole, with a rigid palm. In the palm's frame
// of a right hand (origin the palm position, x = y × z, y against the palm's normal, z against its
// direction), in units of the distance between the index and the little finger's knuckles, measured
// on recordings that have all of it:
constexpr double kCarps[4][3] = {{-0.1976046, 0.2015095, 0.7201562},
                                 {-0.0146782, 0.2261114, 0.6759428},
                                 {0.1733065, 0.2098137, 0.6599816},
                                 {0.3564779, 0.0946070, 0.6960421}};
constexpr double kWristPoint[3] = {0.1174955, 0.0665872, 0.8323454};
constexpr double kMetacarpalAxes[kFingers][2][3] = {  // rows: y (dorsal) and z (against the bone)
    {{-0.8047939, 0.4472140, 0.3902646}, {0.4363291, 0.0000001, 0.8997872}},
    {{-0.0249066, 0.9889363, -0.1462346}, {0.1660444, 0.1483405, 0.9748971}},
    {{0.1457653, 0.9777160, -0.1510760}, {0.0295208, 0.1483405, 0.9884957}},
    {{0.2169105, 0.9688349, -0.1196191}, {-0.1213179, 0.1483404, 0.9814669}},
    {{0.3533502, 0.9354594, -0.0076935}, {-0.2593289, 0.1058513, 0.9599709}}};
constexpr double kFingerRadius[kFingers] = {0.15384, 0.14130, 0.13504, 0.13029, 0.11774};
constexpr double kPalmRadius = 0.2512;  // in the same unit
constexpr double kMostPalm = 2.0;       // from palm to knuckles, which is 0.4 in the template
constexpr double kWristOfPalm = 1.25;   // wrist radius over palm radius
constexpr double kRadiusOfArmWidth = 0.31;
constexpr double kTipOfFinger = 0.8;  // radius at the tip over radius of the finger
// widths of a finger [m]; recorded values outside are not in millimetres
constexpr double kMinWidth = 0.008, kMaxWidth = 0.040;

/// Joints of one finger as recorded [m].
struct Finger {
  Vec3 mcp, pip, dip, tip;
  std::optional<Vec3> carp;
  std::optional<std::array<Eigen::Matrix3d, 4>> bases;  // columns x, y, z
  double width = 0.0;                                   // 0: not recorded [m]
};

/// The palm's frame in T.
struct Palm {
  Eigen::Matrix3d R_TP;  // right-handed for both hands
  Vec3 p_TP;             // [m]
  double mirror;         // x of the template: 1 for right, −1 for left hands
  double span;           // index to little finger's knuckle [m]
  Vec3 point(const double (&t)[3]) const {
    return p_TP + span * (R_TP * Vec3(mirror * t[0], t[1], t[2]));
  }
};

Vec3 metres(const JsonNode& node, const char* key) {
  constexpr double kLimit = kMaxLeapDistance * 1e3;
  return 1e-3 * node.at(key, "3 numbers in millimetres").vec3(-kLimit, kLimit);
}

Vec3 unit_vector(const JsonNode& node, const char* key) {
  const JsonNode v = node.at(key, "a unit vector");
  const Vec3 x = v.vec3(-2.0, 2.0);
  if (!(std::abs(x.norm() - 1.0) <= 0.01))
    fail_as(HandFault::Axes, v, fmt::format("has length {}; it must be 1 within 0.01", x.norm()));
  return x.normalized();
}

/// Returns the rotation with the given z and a y as near as possible to the given unit vector.
Eigen::Matrix3d frame_from(const JsonNode& node, const Vec3& y, const Vec3& z) {
  Eigen::Matrix3d R;
  const double length = z.norm();
  const Vec3 x = y.cross(z);
  if (!(x.norm() > 0.1 * length))
    fail_as(HandFault::Axes, node, "has parallel axes; they must be perpendicular");
  R.col(2) = z / length;
  R.col(0) = (x - x.dot(R.col(2)) * R.col(2)).normalized();
  R.col(1) = R.col(2).cross(R.col(0));
  return R;
}

/// A recorded basis: rows x, y, z. In left hands x may point to either side; y and z decide.
Eigen::Matrix3d recorded_basis(const JsonNode& basis) {
  if (basis.array_size() != 3)
    basis.fail(fmt::format("has {} axes; it must have 3", basis.array_size()));
  for (std::size_t i = 0; i < 3; ++i) {
    const double length = basis.at(i).vec3(-2.0, 2.0).norm();
    if (!(std::abs(length - 1.0) <= 0.05)) {
      fail_as(HandFault::Axes, basis.at(i),
              fmt::format("has length {}; it must be 1 within 0.05", length));
    }
  }
  return frame_from(basis, basis.at(1).vec3(-2.0, 2.0), basis.at(2).vec3(-2.0, 2.0));
}

Finger read_finger(const JsonNode& node) {
  if (!node.has("mcpPosition")) {
    node.fail("has no \"mcpPosition\"; services before version 2 send no joints");
  }
  Finger finger{metres(node, "mcpPosition"),
                metres(node, "pipPosition"),
                metres(node, "dipPosition"),
                metres(node, node.has("btipPosition") ? "btipPosition" : "tipPosition"),
                {},
                {},
                0.0};
  if (node.has("carpPosition")) finger.carp = metres(node, "carpPosition");
  if (node.has("bases")) {
    const JsonNode bases = node.at("bases", "");
    if (bases.array_size() != 4)
      bases.fail(fmt::format("has {} bones; it must have 4", bases.array_size()));
    finger.bases.emplace();
    for (std::size_t b = 0; b < 4; ++b) (*finger.bases)[b] = recorded_basis(bases.at(b));
  }
  if (node.has("width")) finger.width = 1e-3 * node.at("width", "").number(0.0, 1e3);
  return finger;
}

/// The whole number in a member, or nothing.
std::optional<std::int64_t> whole(const JsonNode& node, const char* key) {
  if (!node.has(key) || !node.at(key, "").value().is_number()) return {};
  const double x = node.at(key, "").value().get<double>();
  if (x != std::floor(x) || std::abs(x) > 1e15) return {};
  return static_cast<std::int64_t>(x);
}

/// Whether a pointable is a finger of that hand. Faulty ones belong to no hand.
bool is_finger_of(const JsonNode& node, std::int64_t hand) {
  const bool tool = node.has("tool") && node.at("tool", "").value() == true;
  return !tool && whole(node, "handId") == hand;
}

/// The type of a finger, 0 (thumb) to 4 (little finger). LeapJS packs some recordings without it;
/// services number a hand's fingers hand · 10 + type.
int type_of(const JsonNode& node, std::int64_t hand) {
  if (node.has("type")) return node.at("type", "").integer(0, 4);
  const std::int64_t type = whole(node, "id").value_or(-1) - 10 * hand;
  if (type < 0 || type > 4)
    node.fail("has no \"type\" from 0 to 4; services before version 2 send no types and no joints");
  return static_cast<int>(type);
}

/// Finds the five fingers of a hand among the frame's pointables. Of two with the same type the one
/// whose id fits is used, so that a finger that states the wrong hand does not get the hand
/// dropped.
std::array<Finger, kFingers> read_fingers(const JsonNode& hand, std::int64_t id,
                                          const JsonNode& pointables) {
  std::array<std::optional<JsonNode>, kFingers> found;
  const auto id_fits = [&](const JsonNode& node, std::size_t type) {
    return whole(node, "id") == 10 * id + static_cast<std::int64_t>(type);
  };
  for (std::size_t i = 0; i < pointables.array_size(); ++i) {
    const JsonNode node = pointables.at(i);
    if (!is_finger_of(node, id)) continue;
    const auto type = static_cast<std::size_t>(type_of(node, id));
    std::optional<JsonNode>& taken = found[type];
    if (taken && id_fits(*taken, type) == id_fits(node, type)) {
      fail_as(HandFault::Fingers, node,
              fmt::format("is a second finger of type {}; a hand must have each once", type));
    }
    if (!taken || id_fits(node, type)) taken = node;
  }
  std::array<Finger, kFingers> fingers;
  for (std::size_t f = 0; f < kFingers; ++f) {
    if (!found[f])
      fail_as(HandFault::Fingers, hand,
              fmt::format("has no finger of type {}; it must have 5, the types 0 to 4", f));
    fingers[f] = read_finger(*found[f]);
  }
  return fingers;
}

Vec3 middle_of_knuckles(const std::array<Finger, kFingers>& fingers) {
  return 0.25 * (fingers[1].mcp + fingers[2].mcp + fingers[3].mcp + fingers[4].mcp);
}

/// Refuses a hand if another hand has the same id and is nearer to the fingers of that id.
void check_owner(const JsonNode& hands, const JsonNode& hand, std::int64_t id,
                 const std::array<Finger, kFingers>& fingers) {
  const Vec3 knuckles = middle_of_knuckles(fingers);
  const double distance = (metres(hand, "palmPosition") - knuckles).norm();
  for (std::size_t h = 0; h < hands.array_size(); ++h) {
    const JsonNode other = hands.at(h);
    if (&other.value() == &hand.value() || whole(other, "id") != id) continue;
    const bool nearer = (metres(other, "palmPosition") - knuckles).norm() < distance;
    if (nearer) fail_as(HandFault::Twice, hand, fmt::format("has the id {} of another hand", id));
  }
}

Palm read_palm(const JsonNode& hand, Side side, const std::array<Finger, kFingers>& fingers) {
  Palm palm;
  palm.R_TP = frame_from(hand, -unit_vector(hand, "palmNormal"), -unit_vector(hand, "direction"));
  palm.p_TP = metres(hand, "palmPosition");
  palm.mirror = side == Side::Right ? 1.0 : -1.0;
  palm.span = (fingers[4].mcp - fingers[1].mcp).norm();
  const double away = (palm.p_TP - middle_of_knuckles(fingers)).norm();
  if (!(away <= kMostPalm * palm.span)) {
    fail_as(HandFault::Bones, hand,
            fmt::format("has its palm {:.4g} mm from its knuckles, which are {:.4g} mm across",
                        1e3 * away, 1e3 * palm.span));
  }
  return palm;
}

/// Reads "type" if it is recorded; else decides by the side on which the index finger is, seen from
/// the back of the hand.
Side read_side(const JsonNode& hand, const std::array<Finger, kFingers>& fingers) {
  if (hand.has("type")) {
    const JsonNode type = hand.at("type", "");
    const std::string side = type.text();
    if (side != "left" && side != "right")
      type.fail("is not a side; it must be \"left\" or \"right\"");
    return side == "left" ? Side::Left : Side::Right;
  }
  const Vec3 thumb_side = unit_vector(hand, "direction").cross(unit_vector(hand, "palmNormal"));
  return (fingers[1].mcp - fingers[4].mcp).dot(thumb_side) > 0.0 ? Side::Right : Side::Left;
}

/// Returns R turned by the smallest rotation that brings its −z axis to `bone`.
Eigen::Matrix3d transported(const Eigen::Matrix3d& R, const Vec3& bone) {
  return Quat::FromTwoVectors(-R.col(2), bone).toRotationMatrix() * R;
}

/// The frame of a proximal bone (H15). A finger bent by 90° at its knuckle lies along the
/// metacarpal's y, about which it could swing to any side; near that pose the metacarpal's x is
/// used instead, as if it did not swing.
Eigen::Matrix3d beyond_knuckle(const JsonNode& node, const Eigen::Matrix3d& R_TM,
                               const Vec3& bone) {
  constexpr double kNoSwing = 0.25;  // cos of 75.5°
  const Vec3 z = -bone.normalized(), swung = R_TM.col(1).cross(z);
  const double cosine = z.dot(R_TM.col(2)), u = std::min(std::abs(cosine) / kNoSwing, 1.0);
  if (cosine >= kNoSwing) return frame_from(node, R_TM.col(1), -bone);
  const double share = u * u * (3.0 - 2.0 * u);
  Vec3 x = (1.0 - share) * R_TM.col(0);
  if (share > 0.0) x += std::copysign(share, cosine) * swung.normalized();
  x -= x.dot(z) * z;
  if (!(x.norm() > 0.1)) return transported(R_TM, bone.normalized());
  Eigen::Matrix3d R;
  R.col(2) = z;
  R.col(0) = x.normalized();
  R.col(1) = z.cross(R.col(0));
  return R;
}

/// The frame of a metacarpal in the template, in T.
Eigen::Matrix3d template_frame(const JsonNode& node, const Palm& palm, std::size_t finger) {
  const auto& axes = kMetacarpalAxes[finger];
  const Vec3 y(palm.mirror * axes[0][0], axes[0][1], axes[0][2]),
      z(palm.mirror * axes[1][0], axes[1][1], axes[1][2]);
  return palm.R_TP * frame_from(node, y, z);
}

/// Sets positions and orientations of a finger's joints. Orientations are taken from the recording,
/// or transported from bone to bone.
void set_finger(const JsonNode& node, const Palm& palm, const std::array<Finger, kFingers>& fingers,
                std::size_t f, Hand& hand) {
  const Finger& finger = fingers[f];
  auto joint = static_cast<std::size_t>(kFirstJoint[f]);
  const std::size_t first = joint;
  // the thumb's metacarpal has no length in the Leap's skeleton, so its joints shift by one
  if (f > 0) {
    if (!finger.carp) hand.inferred |= 1U;
    hand.position[joint++] = finger.carp ? *finger.carp : palm.point(kCarps[f - 1]);
  }
  for (const Vec3& p : {finger.mcp, finger.pip, finger.dip, finger.tip}) hand.position[joint++] = p;

  const std::size_t bones = joint - first - 1;
  Eigen::Matrix3d R_TB = template_frame(node, palm, f);
  for (std::size_t b = 0; b < bones; ++b) {
    const Vec3 bone = hand.position[first + b + 1] - hand.position[first + b];
    if (finger.bases) {
      R_TB = (*finger.bases)[4 - bones + b];
    } else if (bone.norm() > 1e-6) {
      const bool knuckle = b + 3 == bones;
      R_TB = knuckle ? beyond_knuckle(node, R_TB, bone) : transported(R_TB, bone.normalized());
    }
    hand.orientation[first + b] = Quat(R_TB);
  }
  hand.orientation[first + bones] = Quat(R_TB);

  // leapd gives widths in millimetres; other services give implausible numbers
  const bool has_width = finger.width >= kMinWidth && finger.width <= kMaxWidth;
  const double radius = has_width ? 0.5 * finger.width : kFingerRadius[f] * palm.span;
  for (std::size_t b = 0; b <= bones; ++b)
    hand.radius[first + b] = b == bones ? kTipOfFinger * radius : radius;
}

void set_palm_and_wrist(const JsonNode& node, const Palm& palm, Hand& hand) {
  hand.position[kPalm] = 0.5 * (hand.position[kMiddleMetacarpal] + hand.position[kMiddleProximal]);
  hand.orientation[kPalm] = Quat(frame_from(
      node, palm.R_TP.col(1), hand.position[kMiddleMetacarpal] - hand.position[kMiddleProximal]));
  hand.radius[kPalm] = kPalmRadius * palm.span;
  if (!node.has("wrist")) hand.inferred |= 2U;
  hand.position[kWrist] = node.has("wrist") ? metres(node, "wrist") : palm.point(kWristPoint);
  hand.orientation[kWrist] = Quat(palm.R_TP);
  const double arm_width =
      node.has("armWidth") ? 1e-3 * node.at("armWidth", "").number(0.0, 1e3) : 0.0;
  hand.radius[kWrist] =
      arm_width > 0.0 ? kRadiusOfArmWidth * arm_width : kWristOfPalm * hand.radius[kPalm];
}

/// Reads a hand whose fingers are among `pointables`.
Hand leap_hand(const JsonNode& hands, const JsonNode& node, const JsonNode& pointables) {
  Hand hand;
  hand.id = node.at("id", "a whole number").integer(0, std::numeric_limits<int>::max());
  hand.confidence = node.has("confidence") ? node.at("confidence", "").number(0.0, 1.0) : 1.0;
  const std::array<Finger, kFingers> fingers = read_fingers(node, hand.id, pointables);
  check_owner(hands, node, hand.id, fingers);
  hand.side = read_side(node, fingers);
  const Palm palm = read_palm(node, hand.side, fingers);
  hand.velocity.fill(Vec3::Zero());
  for (std::size_t f = 0; f < kFingers; ++f) set_finger(node, palm, fingers, f, hand);
  set_palm_and_wrist(node, palm, hand);
  return hand;
}

/// The member "pointables" of a frame. @throws HandError unless it is an array.
JsonNode pointables_of(const JsonNode& frame) {
  try {
    const JsonNode pointables = frame.at("pointables", "an array of fingers");
    pointables.array_size();
    return pointables;
  } catch (const InputError& error) {
    throw HandError(HandFault::Unreadable, error.what());
  }
}

double time_of(const JsonNode& frame) {
  constexpr double kMost =
      1e19;  // allows nanoseconds since 1970, which are refused later, with a clearer message
  try {
    return 1e-6 * frame.at("timestamp", "the time in microseconds").number(0.0, kMost);
  } catch (const InputError& error) {
    throw HandError(HandFault::Time, error.what());
  }
}

}  // namespace

HandFrame leap_frame(const JsonNode& node, const HandFrame* before, HandFaults& faults) {
  HandFrame frame;
  const JsonNode hands = hands_of(node);
  frame.time = time_of(node);
  if (hands.array_size() == 0) return frame;
  const JsonNode pointables = pointables_of(node);
  read_hands(
      hands, [&](const JsonNode& hand) { return leap_hand(hands, hand, pointables); }, before,
      faults, frame);
  return frame;
}

bool is_leap_news(const JsonNode& node) {
  return !node.has("hands") &&
         (node.has("version") || node.has("serviceVersion") || node.has("event"));
}

LeapMessage leap_message(std::string_view text, HandFrame& frame, HandFaults& faults) {
  static const std::string kName = "a message of the tracker";
  try {
    const json document = parse_json(text, kName);
    const JsonNode node(document, kName);
    if (is_leap_news(node)) return LeapMessage::Other;
    const HandFrame before = frame;
    frame = leap_frame(node, &before, faults);
    return LeapMessage::Frame;
  } catch (const HandError& error) {
    faults.add(error.fault(), error.what());
  } catch (const InputError& error) {
    faults.add(HandFault::Unreadable, error.what());
  }
  return LeapMessage::Refused;
}

}  // namespace prostm
