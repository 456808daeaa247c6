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
  Read = 4,  ///< asks for the units' answers
  Close = 5,
  Hello = 0x10  ///< u16 version of the protocol, "AUTD3REMOTE"
};

inline constexpr std::size_t kFrameBytes = 626;   ///< of a unit's frame
inline constexpr std::size_t kAnswerBytes = 2;    ///< of a unit's answer
inline constexpr std::size_t kPlaceBytes = 28;    ///< of a unit's place
inline constexpr std::size_t kMostUnits = 64;     ///< that prostm drives at a time
inline constexpr std::size_t kMostWords = 2'000;  ///< bytes of a server's complaint
/// Bytes of the longest reply.
inline constexpr std::size_t kMostReply = 5 + kMostWords;

/// Number of bytes of the request that begins so; 0 if that is not known yet, or never.
/// @param units told in the geometry.
std::size_t request_bytes(std::span<const std::uint8_t> begin, std::size_t units) noexcept;

/// A server's answer.
struct Reply {
  enum class Kind : std::uint8_t {
    Incomplete,
    Accepted,
    Refused,  ///< with words
    Strange   ///< no reply of this protocol
  };
  Kind kind = Kind::Incomplete;
  std::size_t bytes =
      0;  ///< of the whole reply, as far as is known; if incomplete, more than given
  std::string_view words = {};  ///< into the bytes that were read
};

/// Reads the bytes that came so far in reply to a request. Allocates and throws nothing.
/// @param units told in the geometry.
Reply read_reply(std::span<const std::uint8_t> bytes, Request request, std::size_t units) noexcept;

}  // namespace prostm::autd3
