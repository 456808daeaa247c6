#pragma once
/// Interface of the source that the server shows and controls: a run, or a substitute in tests.

#include <cstdint>
#include <string>

#include "prostm/viewer/page_message.hpp"
#include "prostm/viewer/wire.hpp"

namespace prostm {

/// Counts changes of the large sections of frames.
struct ViewNews {
  std::uint64_t smoke = 0, fields = 0;
};

/// The two kinds of pages of one server: pages at /live have full access; guests at /guest/live
/// have what the source allows.
enum class Room : std::uint8_t { Main, Guest };
inline constexpr Room kRooms[] = {Room::Main, Room::Guest};

/// All functions are called on the server's thread and must not block.
class ViewSource {
 public:
  virtual ~ViewSource() = default;

  /// Sets whether there are viewers; initially there is no viewer. Frames are requested only while
  /// there are viewers.
  virtual void watch(bool somebody) = 0;
  /// Fills in the newest frame, except for its sequence number, and counts its new sections.
  virtual void refresh(ViewFrame& frame, ViewNews& news) = 0;

  /// Whether the pages of a room currently get frames; for the main room, also whether
  /// /numbers.json is available.
  virtual bool shows_frames(Room room) const = 0;

  /// Returns the first message to a page.
  virtual std::string hello(std::uint32_t page, Room room) = 0;
  /// Stores the state message of a room in `state` if it has changed since the last call; true if
  /// so. The first call returns true. The main room is queried before guests.
  virtual bool refresh_state(Room room, std::string& state) = 0;

  /// Handles a message of a page, except RateMessage. @return an empty text, or a sentence that
  /// says why it was refused.
  virtual std::string take(std::uint32_t page, const PageMessage& message) = 0;
  /// Takes the oldest refusal that occurred after take() had returned; false if no refusal is
  /// pending.
  virtual bool next_refusal(std::uint32_t& page, std::string& sentence) = 0;
  /// Releases everything held by a page that has disconnected.
  virtual void forget(std::uint32_t page) = 0;
};

}  // namespace prostm
