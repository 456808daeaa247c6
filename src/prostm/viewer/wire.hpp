#pragma once
/// The binary frames sent to a page (docs/reference/wire.md). web/src/wire.ts is the counterpart;
/// web/fixtures keeps the two consistent.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "prostm/track/live/page_hand.hpp"

namespace prostm {

inline constexpr int kWireVersion = 2;

/// The numbers of a frame, in the order of the wire, to which numbers are only appended. Metrics
/// without an entry here follow, in the order of quantities<Metrics>().
enum ViewNumber : int {
  kTrackMs,
  kHandMs,
  kWorldMs,
  kContactMs,
  kPlanMs,
  kLiftMs,
  kStepMs,
  kWorldHz,
  kPlanHz,
  kLatencyMs,
  kLatencyP50Ms,
  kLatencyP99Ms,
  kLatencyMaxMs,
  kBlocks,
  kLateBlocks,
  kMissedBlocks,
  kQueueBlocks,
  kRmse,
  kCorrelation,
  kCoverage,
  kSkill0,
  kSkill8,
  kOverlap,
  kSpill,
  kMaxTargetPa,
  kFullScalePa,
  kLapsCompleted,
  kTrackerAgeMs,
  kIntensity,
  kSaturated,
  kSigmaMm,
  kSettingSigmaMm,
  kSettingRmse,
  kSettingCorrelation,
  kFeltSkill,
  kForceMn,
  kSmokeMn,
  kMovementMn,
  kPlacedNumbers
};

/// Names of the numbers in the hello and in /numbers.json, in the same order.
std::span<const std::string_view> view_number_names();
/// Indices of quantities<Metrics>() among the numbers.
std::span<const std::size_t> view_metric_places();

/// Flags of ViewRun.
enum ViewFlag : std::uint32_t {
  kViewPaused = 1,
  kViewPageHand = 2,  ///< the page's hand is in control
  kViewHandInSight = 4,
  kViewFading = 8,        ///< output fades for lack of plans
  kViewMuted = 16,        ///< the output was muted, on a page or in the terminal
  kViewCalibrating = 32,  ///< a calibration mutes the output
  kViewHot = 64,          ///< the device is too hot, which mutes the output
  kViewDeviceLost = 128,  ///< the link to the device is lost
};

struct ViewRun {
  double time = 0.0;            ///< run time [s]
  double recording_time = 0.0;  ///< in the hand's recording [s], NaN without one
  std::uint32_t world_steps = 0, plan_updates = 0;
  std::uint32_t flags = 0;        ///< combination of ViewFlag
  PageHandReport page_hand = {};  ///< for /numbers.json; not sent in frames
};

/// Position in D [m], orientation as x, y, z, w, radius [m].
using ViewJoint = std::array<float, 8>;

struct ViewHand {
  std::uint32_t id = 0;
  std::uint32_t side = 0;   ///< 0 left, 1 right
  float confidence = 1.0F;  ///< 0..1
  std::array<ViewJoint, 26> joints{};
};

/// n³ values, x fastest, then y, then z: from 0 (clear) to 255.
struct ViewSmoke {
  std::uint32_t n = 0;
  std::array<float, 3> corner{};  ///< of the box in D [m]
  float edge = 0.0F;              ///< of the box [m]
  std::vector<std::uint8_t> density;
};

/// One patch of skin, rows·cols of each array, row-major. Pressures are in parts of `scale`/65535.
struct ViewField {
  std::uint32_t rows = 0, cols = 0;
  float cell = 0.0F;              ///< [m]
  std::array<float, 2> origin{};  ///< centre of cell (0, 0) in P [m]
  std::array<float, 12> X_DP{};   ///< rows of the upper 3 × 4 matrix
  float scale = 1.0F;             ///< pressure that is sent as 65535 [Pa]
  float height_scale = 1.0F;      ///< height that is sent as 1 [m]
  std::vector<std::uint16_t> target, rendered;
  std::vector<std::int16_t> height;
  std::vector<std::uint8_t> skin;
};

/// x, y in P [m], rendered pressure [Pa], position on the skin in D [m].
using ViewPoint = std::array<float, 6>;

/// A closed path, or a focus of one point.
struct ViewPath {
  std::uint32_t kind = 0;   ///< 0 closed path, 1 focus
  std::uint32_t patch = 0;  ///< index of the field that it lies on
  float length = 0.0F;      ///< in the plane [m]
  float speed = 0.0F;       ///< [m/s]
  float period = 0.0F;      ///< [s]
  float loop = 0.0F;        ///< common period of all paths [s]; 0: none
  float phase = 0.0F;       ///< delay of a focus' modulation, as a share of its period
  std::vector<ViewPoint> points;
};

/// A GateResult of the shown target.
struct ViewGate {
  bool passed = false;
  float share = 0.0F;    ///< share of the last second's frames without a problem
  std::string problem;   ///< problem of this frame, a name of GateProblem
  std::string sentence;  ///< in UTF-8
  std::uint32_t maxima = 0;
  float balance = 0.0F, saddle = 0.0F;
  float area = 0.0F;   ///< [m²]
  float force = 0.0F;  ///< [N]
};

/// The state shown by a page at one moment. Vectors keep their capacity between frames: only the
/// first *_count elements are valid.
struct ViewFrame {
  std::uint32_t sequence = 0;
  ViewRun run;
  /// Indexed by ViewNumber; NaN for a number without a value.
  std::vector<float> numbers = std::vector<float>(view_number_names().size());
  std::uint32_t hand_count = 0;
  std::array<ViewHand, 2> hands;
  ViewSmoke smoke;
  std::uint32_t field_count = 0;
  std::vector<ViewField> fields;
  std::uint32_t path_count = 0;
  std::vector<ViewPath> paths;
  std::optional<ViewGate> gate;  ///< nothing if the target has no stimulus to match
};

/// Writes the frame as one message into `out`, replacing its contents. Allocates only if `out` must
/// grow. @param with_smoke, with_fields whether to include the large sections. @pre the counts are
/// within the vectors, and every array of a field or of the smoke has the size given by its shape.
void encode(const ViewFrame& frame, bool with_smoke, bool with_fields,
            std::vector<std::uint8_t>& out);

}  // namespace prostm
