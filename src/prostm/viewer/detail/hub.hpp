#pragma once
/// The state that the connections of one server share. Used by the server's thread alone, the
/// counters excepted.

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "prostm/viewer/server.hpp"

namespace prostm::viewer {

using Clock = std::chrono::steady_clock;
using Bytes = std::vector<std::uint8_t>;
class Session;

/// One frame as messages: each of the four ways in which the large sections may be left out is
/// encoded once at most, for all pages.
class EncodedFrame {
 public:
  void begin() { made_ = {}; }
  std::shared_ptr<const Bytes> message(const ViewFrame& frame, bool smoke, bool fields);

 private:
  std::shared_ptr<Bytes> unused_buffer();
  std::array<std::shared_ptr<Bytes>, 4> made_;
  std::vector<std::shared_ptr<Bytes>> pool_;  // those that nobody sends any more are used again
};

struct Hub {
  Hub(const ViewSettings& s, ViewSource& view, std::span<const PageFile> page)
      : settings(s), source(view), files(page) {
    states.fill(std::make_shared<std::string>());
  }

  /// Numbers as JSON, at most 0.1 s old, however seldom pages want frames. Empty where the main
  /// room gets no frames.
  std::string numbers();
  /// Asks the source for the next frame.
  void next_frame();

  const ViewSettings settings;
  ViewSource& source;
  const std::span<const PageFile> files;
  bool any_address = false;  // listens on more than loopback

  ViewFrame frame;
  Clock::time_point frame_at;  // when it was asked for
  ViewNews news;
  std::array<std::shared_ptr<const std::string>, std::size(kRooms)> states;  ///< by Room
  std::vector<Session*> pages;  // those whose WebSocket is open
  int connections = 0;
  std::uint32_t last_page = 0;

  struct {
    std::atomic<std::int64_t> frames{0}, skipped{0}, bytes{0}, dropped{0};
    std::atomic<int> pages{0};
  } count;
};

}  // namespace prostm::viewer
