#include "prostm/viewer/detail/hub.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

namespace prostm::viewer {
namespace {

// Pages set the rate of frames, and a hidden page requests only one per second; numbers do not wait
// for them.
constexpr auto kNumbersAge = std::chrono::milliseconds(100);

/// The value as JSON; null if it is not finite.
nlohmann::ordered_json number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}
nlohmann::ordered_json number(float value) {
  return number(static_cast<double>(value));
}

}  // namespace

std::shared_ptr<const Bytes> EncodedFrame::message(const ViewFrame& frame, bool smoke,
                                                   bool fields) {
  std::shared_ptr<Bytes>& made = made_[(smoke ? 1U : 0U) + (fields ? 2U : 0U)];
  if (!made) {
    made = unused_buffer();
    encode(frame, smoke, fields, *made);
  }
  return made;
}

std::shared_ptr<Bytes> EncodedFrame::unused_buffer() {
  for (const auto& buffer : pool_)
    if (buffer.use_count() == 1) return buffer;
  pool_.push_back(std::make_shared<Bytes>());
  return pool_.back();
}

void Hub::next_frame() {
  source.refresh(frame, news);
  frame_at = Clock::now();
  ++frame.sequence;
}

std::string Hub::numbers() {
  if (!source.shows_frames(Room::Main)) return {};
  if (pages.empty() || Clock::now() - frame_at > kNumbersAge) next_frame();
  nlohmann::ordered_json json = {{"sequence", frame.sequence},
                                 {"run",
                                  {{"time", number(frame.run.time)},
                                   {"recording_time", number(frame.run.recording_time)},
                                   {"world_steps", frame.run.world_steps},
                                   {"plan_updates", frame.run.plan_updates},
                                   {"flags", frame.run.flags},
                                   {"page_hand",
                                    {{"state", name_of(frame.run.page_hand.state)},
                                     {"late", frame.run.page_hand.late},
                                     {"hidden", frame.run.page_hand.hidden}}}}}};
  const auto names = view_number_names();
  for (std::size_t i = 0; i < names.size(); ++i)
    json["numbers"][std::string(names[i])] = number(frame.numbers[i]);
  json["gate"] = nullptr;
  if (frame.gate) {
    const ViewGate& gate = *frame.gate;
    json["gate"] = {{"passed", gate.passed},         {"share", number(gate.share)},
                    {"problem", gate.problem},       {"sentence", gate.sentence},
                    {"maxima", gate.maxima},         {"balance", number(gate.balance)},
                    {"saddle", number(gate.saddle)}, {"area_m2", number(gate.area)},
                    {"force_n", number(gate.force)}};
  }
  return json.dump() + "\n";
}

}  // namespace prostm::viewer
