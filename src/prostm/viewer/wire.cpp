#include "prostm/viewer/wire.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

#include "prostm/score/score.hpp"

namespace prostm {
namespace {

static_assert(std::endian::native == std::endian::little, "the wire is little-endian");

constexpr std::array<std::string_view, kPlacedNumbers> kPlaced = {
    "track_ms",       "hand_ms",
    "world_ms",       "contact_ms",
    "plan_ms",        "lift_ms",
    "step_ms",        "world_hz",
    "plan_hz",        "latency_ms",
    "latency_p50_ms", "latency_p99_ms",
    "latency_max_ms", "blocks",
    "late_blocks",    "missed_blocks",
    "queue_blocks",   "rmse",
    "correlation",    "coverage",
    "skill_0",        "skill_8",
    "overlap",        "spill",
    "max_target_pa",  "full_scale_pa",
    "laps_completed", "tracker_age_ms",
    "intensity",      "saturated",
    "sigma_mm",       "setting_sigma_mm",
    "setting_rmse",   "setting_correlation",
    "felt_skill",     "force_mn",
    "smoke_mn",       "movement_mn"};

struct Numbers {
  std::vector<std::string_view> names{kPlaced.begin(), kPlaced.end()};
  std::vector<std::size_t> metrics;
};

const Numbers& numbers() {
  static const Numbers kNumbers = [] {
    Numbers all;
    for (const Quantity<Metrics>& metric : quantities<Metrics>()) {
      const auto placed = std::find(kPlaced.begin(), kPlaced.end(), metric.name);
      const bool is_placed = placed != kPlaced.end();
      all.metrics.push_back(is_placed ? static_cast<std::size_t>(placed - kPlaced.begin())
                                      : all.names.size());
      if (!is_placed) all.names.emplace_back(metric.name);
    }
    return all;
  }();
  return kNumbers;
}

/// Sections in the order of their ids.
enum Section : std::uint16_t { kRun = 1, kNumberList, kHands, kSmoke, kFields, kPlan, kGate };

constexpr std::size_t kHeaderBytes = 16, kLengthAt = 12, kHandPadding = 16;

/// Appends values to a message, and fills in lengths once they are known.
class Writer {
 public:
  explicit Writer(std::vector<std::uint8_t>& out) : out_(out) { out_.clear(); }

  template <class T>
  void put(const T& value) {
    bytes(&value, sizeof value);
  }
  template <class Range>
  void put_all(const Range& values) {
    bytes(values.data(), values.size() * sizeof(*values.data()));
  }
  void zeros(std::size_t n) { out_.resize(out_.size() + n); }
  void align() { zeros((8 - out_.size() % 8) % 8); }

  void begin(Section id, std::size_t count) {
    align();
    put(static_cast<std::uint16_t>(id));
    put(static_cast<std::uint16_t>(count));
    put(std::uint32_t{0});
    start_ = out_.size();
  }
  void end() { set_u32(start_ - sizeof(std::uint32_t), out_.size() - start_); }
  void set_u32(std::size_t at, std::size_t value) {
    const auto narrow = static_cast<std::uint32_t>(value);
    std::memcpy(out_.data() + at, &narrow, sizeof narrow);
  }

 private:
  void bytes(const void* data, std::size_t n) {
    const std::size_t at = out_.size();
    out_.resize(at + n);
    if (n > 0) std::memcpy(out_.data() + at, data, n);
  }
  std::vector<std::uint8_t>& out_;
  std::size_t start_ = 0;  // start of the section's contents
};

void write_hands(const ViewFrame& frame, Writer& w) {
  w.begin(kHands, frame.hand_count);
  for (std::size_t i = 0; i < frame.hand_count; ++i) {
    const ViewHand& hand = frame.hands[i];
    w.put(hand.id);
    w.put(hand.side);
    w.put(hand.confidence);
    w.put(std::uint32_t{0});
    w.put(hand.joints);
    w.zeros(kHandPadding);
  }
  w.end();
}

void write_smoke(const ViewSmoke& smoke, Writer& w) {
  w.begin(kSmoke, 1);
  w.put(smoke.n);
  w.put(smoke.corner);
  w.put(smoke.edge);
  w.put(std::uint32_t{0});
  w.put_all(smoke.density);
  w.end();
}

void write_fields(const ViewFrame& frame, Writer& w) {
  w.begin(kFields, frame.field_count);
  for (std::size_t i = 0; i < frame.field_count; ++i) {
    const ViewField& field = frame.fields[i];
    w.put(field.rows);
    w.put(field.cols);
    w.put(field.cell);
    w.put(field.origin);
    w.put(field.X_DP);
    w.put(field.scale);
    w.put(field.height_scale);
    w.put(std::uint32_t{0});
    w.put_all(field.target);
    w.put_all(field.rendered);
    w.put_all(field.height);
    w.put_all(field.skin);
    w.align();
  }
  w.end();
}

void write_plan(const ViewFrame& frame, Writer& w) {
  w.begin(kPlan, frame.path_count);
  for (std::size_t i = 0; i < frame.path_count; ++i) {
    const ViewPath& path = frame.paths[i];
    w.put(path.kind);
    w.put(path.patch);
    w.put(static_cast<std::uint32_t>(path.points.size()));
    w.put(path.length);
    w.put(path.speed);
    w.put(path.period);
    w.put(path.loop);
    w.put(path.phase);
    w.put_all(path.points);
  }
  w.end();
}

void write_text(const std::string& text, Writer& w) {
  w.put(static_cast<std::uint32_t>(text.size()));
  w.put_all(text);
}

void write_gate(const ViewGate& gate, Writer& w) {
  w.begin(kGate, 1);
  w.put(std::uint32_t{gate.passed ? 1U : 0U});
  w.put(gate.share);
  w.put(gate.maxima);
  for (const float x : {gate.balance, gate.saddle, gate.area, gate.force}) w.put(x);
  write_text(gate.problem, w);
  write_text(gate.sentence, w);
  w.end();
}

}  // namespace

std::span<const std::string_view> view_number_names() {
  return numbers().names;
}

std::span<const std::size_t> view_metric_places() {
  return numbers().metrics;
}

void encode(const ViewFrame& frame, bool with_smoke, bool with_fields,
            std::vector<std::uint8_t>& out) {
  Writer w(out);
  for (const char c : {'P', 'S', 'T', 'M'}) w.put(c);
  w.put(static_cast<std::uint16_t>(kWireVersion));
  w.put(static_cast<std::uint16_t>(4 + (with_smoke ? 1 : 0) + (with_fields ? 1 : 0) +
                                   (frame.gate ? 1 : 0)));
  w.put(frame.sequence);
  w.put(std::uint32_t{0});
  static_assert(kLengthAt + sizeof(std::uint32_t) == kHeaderBytes);

  w.begin(kRun, 1);
  w.put(frame.run.time);
  w.put(frame.run.recording_time);
  w.put(frame.run.world_steps);
  w.put(frame.run.plan_updates);
  w.put(frame.run.flags);
  w.put(std::uint32_t{0});
  w.end();
  w.begin(kNumberList, frame.numbers.size());
  w.put_all(frame.numbers);
  w.end();
  write_hands(frame, w);
  if (with_smoke) write_smoke(frame.smoke, w);
  if (with_fields) write_fields(frame, w);
  write_plan(frame, w);
  if (frame.gate) write_gate(*frame.gate, w);
  w.align();
  w.set_u32(kLengthAt, out.size());
}

}  // namespace prostm
