#pragma once
/// Messages of AUTD3's remote protocol, v38: requests of a client, and a server's replies.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace prostm::autd3 {

/// First byte of a request.
enum class Request : std::uint8_t {
  Geometry =
      1,     ///< u32 number of units, and for each 3 places [mm] and a quaternion w, x, y, z (f32)
  Send = 3,  ///< a frame for each unit
  Read = 4,  ///< requests the units' answers
  Close = 5,
  Hello = 0x10  ///< u16 version of the protocol, "AUTD3REMOTE"
};

inline constexpr std::size_t kFrameBytes = 626;   ///< of a unit's frame
inline constexpr std::size_t kAnswerBytes = 2;    ///< of a unit's answer
inline constexpr std::size_t kPlaceBytes = 28;    ///< of a unit's place
inline constexpr std::size_t kMostUnits = 64;     ///< that prostm drives at a time
inline constexpr std::size_t kMostWords = 2'000;  ///< longest error message of a server [bytes]
/// Bytes of the longest reply.
inline constexpr std::size_t kMostReply = 5 + kMostWords;

/// Returns the size of the request that begins with these bytes; 0 if it is not known yet, or the
/// request is invalid.
/// @param units number of units in the geometry.
std::size_t request_bytes(std::span<const std::uint8_t> begin, std::size_t units) noexcept;

/// A server's answer.
struct Reply {
  enum class Kind : std::uint8_t {
    Incomplete,
    Accepted,
    Refused,  ///< with an error message
    Strange   ///< not a reply of this protocol
  };
  Kind kind = Kind::Incomplete;
  std::size_t bytes =
      0;  ///< size of the whole reply, as far as it is known; if incomplete, more than given
  std::string_view words = {};  ///< error message, within the bytes given
};

/// Parses the bytes received so far in reply to a request. Does not allocate or throw.
/// @param units number of units in the geometry.
Reply read_reply(std::span<const std::uint8_t> bytes, Request request, std::size_t units) noexcept;

}  // namespace prostm::autd3
