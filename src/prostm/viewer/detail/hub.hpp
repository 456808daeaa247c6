#pragma once
/// The state shared by the connections of one server. Used only by the server's thread, except for
/// the counters.

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

/// One frame as messages: each of the four variants, with or without the large sections, is encoded
/// at most once for all pages.
class EncodedFrame {
 public:
  void begin() { made_ = {}; }
  std::shared_ptr<const Bytes> message(const ViewFrame& frame, bool smoke, bool fields);

 private:
  std::shared_ptr<Bytes> unused_buffer();
  std::array<std::shared_ptr<Bytes>, 4> made_;
  std::vector<std::shared_ptr<Bytes>> pool_;  // buffers that are no longer being sent are reused
};

struct Hub {
  Hub(const ViewSettings& s, ViewSource& view, std::span<const PageFile> page)
      : settings(s), source(view), files(page) {
    states.fill(std::make_shared<std::string>());
  }

  /// Numbers as JSON, at most 0.1 s old, even if pages request frames more slowly. Empty if the
  /// main room gets no frames.
  std::string numbers();
  /// Gets the next frame from the source.
  void next_frame();

  const ViewSettings settings;
  ViewSource& source;
  const std::span<const PageFile> files;
  bool any_address = false;  // the server listens on more than loopback

  ViewFrame frame;
  Clock::time_point frame_at;  // time of its request
  ViewNews news;
  std::array<std::shared_ptr<const std::string>, std::size(kRooms)> states;  ///< indexed by Room
  std::vector<Session*> pages;  // sessions with an open WebSocket
  int connections = 0;
  std::uint32_t last_page = 0;

  struct {
    std::atomic<std::int64_t> frames{0}, skipped{0}, bytes{0}, dropped{0};
    std::atomic<int> pages{0};
  } count;
};

}  // namespace prostm::viewer
