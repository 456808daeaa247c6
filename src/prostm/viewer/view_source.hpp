#pragma once
/// The source that the server shows and steers, as an interface: a run, or a stand-in in tests.

#include <cstdint>
#include <string>

#include "prostm/viewer/page_message.hpp"
#include "prostm/viewer/wire.hpp"

namespace prostm {

/// Counts the large sections of frames as they change.
struct ViewNews {
  std::uint64_t smoke = 0, fields = 0;
};

/// The two kinds of pages of one server: those at /live see and steer all that there is, guests at
/// /guest/live what the source lets them.
enum class Room : std::uint8_t { Main, Guest };
inline constexpr Room kRooms[] = {Room::Main, Room::Guest};

/// All functions are called by the server's thread. None may wait.
class ViewSource {
 public:
  virtual ~ViewSource() = default;

  /// Whether anybody looks; nobody does at first. Frames are asked for only while somebody does.
  virtual void watch(bool somebody) = 0;
  /// Fills in the newest frame but for its sequence number, and counts what is new in it.
  virtual void refresh(ViewFrame& frame, ViewNews& news) = 0;

  /// Whether the pages of a room get frames now, and anybody the numbers.
  virtual bool shows_frames(Room room) const = 0;

  /// The message that a page gets first.
  virtual std::string hello(std::uint32_t page, Room room) = 0;
  /// Puts the newest state message of a room into `state` where it has changed since the last call;
  /// true if so. The first call finds one. Guests are asked for after the main room.
  virtual bool refresh_state(Room room, std::string& state) = 0;

  /// Does what a page asks, RateMessage excepted. @return an empty text, or the sentence that says
  /// why not.
  virtual std::string take(std::uint32_t page, const PageMessage& message) = 0;
  /// Reads the oldest refusal that came after take() had returned; false without one.
  virtual bool next_refusal(std::uint32_t& page, std::string& sentence) = 0;
  /// A page has gone: whatever it held is let go.
  virtual void forget(std::uint32_t page) = 0;
};

}  // namespace prostm
