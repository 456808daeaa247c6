#pragma once
/// A page and a source of frames for tests of the server.

#include <atomic>
#include <deque>
#include <limits>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "prostm/viewer/server.hpp"
#include "support/eventually.hpp"

namespace prostm::test {

using Json = nlohmann::json;

/// A source without a run: frames are numbered, and the pages' requests are stored.
class StandIn final : public ViewSource {
 public:
  explicit StandIn(std::uint32_t smoke_cells = 32) { smoke_cells_ = smoke_cells; }
  void watch(bool somebody) override { watched = somebody; }
  void refresh(ViewFrame& frame, ViewNews& news) override {
    if (fails) throw std::runtime_error("the stand-in fell down");
    frame.run.world_steps = static_cast<std::uint32_t>(++refreshed);
    frame.numbers.assign(view_number_names().size(), std::numeric_limits<float>::quiet_NaN());
    frame.numbers[kWorldMs] = 7.25F;
    frame.hand_count = 2;
    frame.smoke.n = smoke_cells_;
    frame.smoke.density.assign(std::size_t{smoke_cells_} * smoke_cells_ * smoke_cells_, 7);
    if (new_smoke) ++news.smoke;
    if (news.fields == 0) ++news.fields;
  }
  bool shows_frames(Room room) const override { return room == Room::Main; }
  std::string hello(std::uint32_t, Room) override { return R"({"type":"hello","version":1})"; }
  bool refresh_state(Room room, std::string& state) override {
    if (room == Room::Guest) {
      state = R"({"type":"guests"})";
      return !std::exchange(guests_told_, true);
    }
    const int version = state_version;
    if (version == told_) return false;
    told_ = version;
    state = R"({"type":"state","version":)" + std::to_string(version) + "}";
    return true;
  }
  std::string take(std::uint32_t page, const PageMessage& message) override {
    const std::lock_guard lock(mutex_);
    taken_.emplace_back(page, message);
    const auto* set = std::get_if<SetMessage>(&message);
    return set != nullptr && set->id == "refused" ? "it cannot be done" : "";
  }
  bool next_refusal(std::uint32_t& page, std::string& sentence) override {
    const std::lock_guard lock(mutex_);
    if (refusals_.empty()) return false;
    std::tie(page, sentence) = refusals_.front();
    refusals_.pop_front();
    return true;
  }
  void forget(std::uint32_t) override { ++forgotten; }

  void refuse_later(std::uint32_t page, std::string sentence) {
    const std::lock_guard lock(mutex_);
    refusals_.emplace_back(page, std::move(sentence));
  }
  std::vector<std::pair<std::uint32_t, PageMessage>> taken() {
    const std::lock_guard lock(mutex_);
    return taken_;
  }

  std::atomic<bool> watched{false}, new_smoke{true}, fails{false};
  std::atomic<int> state_version{1}, forgotten{0};
  std::atomic<std::int64_t> refreshed{0};

 private:
  std::uint32_t smoke_cells_ = 0;
  int told_ = 0;
  bool guests_told_ = false;
  std::mutex mutex_;
  std::vector<std::pair<std::uint32_t, PageMessage>> taken_;
  std::deque<std::pair<std::uint32_t, std::string>> refusals_;
};

/// Returns the response of a connection to raw bytes, until it closes or, with `enough`, until that
/// many bytes have arrived.
std::string raw_exchange(int port, const std::string& bytes,
                         std::size_t enough = std::string::npos);

/// Returns the status of the response to one request; 0 without a response.
int status_of(const std::string& answer);

/// Sends a GET of a target with "Connection: close".
std::string get(int port, const std::string& target, const std::string& headers = "",
                const std::string& method = "GET");

/// A page without a browser. Reads block; a test that waits in vain fails by its time limit.
class Page {
 public:
  /// @throws std::runtime_error if it is refused.
  explicit Page(int port, const std::string& origin = "", const std::string& host = "",
                const std::string& target = "/live");
  ~Page();

  void say(const std::string& text);
  /// Sends bytes as they are, without message framing.
  void send_raw(const std::string& bytes);
  /// Returns the next message of a kind, skipping others. @throws if the connection closes.
  std::string next(bool text);
  std::string next_frame() { return next(false); }
  Json next_text() { return Json::parse(next(true)); }
  /// Returns the next text of a type.
  Json next_text(const std::string& type);
  /// Whether anything unread has arrived.
  bool hears() const;
  /// Reads all messages that have arrived.
  void catch_up();
  /// Reads until the server closes the connection.
  void read_to_the_end();

 private:
  struct Connection;
  std::unique_ptr<Connection> connection_;
};

/// A little-endian number in a frame.
std::uint32_t u32_at(const std::string& bytes, std::size_t at);

/// Returns the number of items in a section of a frame; −1 without such a section.
int section_count(const std::string& bytes, unsigned id);
/// Returns whether a frame contains a section.
bool has_section(const std::string& bytes, unsigned id);

}  // namespace prostm::test
