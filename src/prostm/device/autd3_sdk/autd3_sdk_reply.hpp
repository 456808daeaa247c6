#pragma once
/// Answers of AUTD3 units over the AUTD3 SDK's UDP transport, wire version 2. All numbers are
/// little-endian.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace prostm::sdk {

inline constexpr std::uint8_t kVersion = 2;
inline constexpr std::uint8_t kUnassigned = 0xFF;
inline constexpr std::uint8_t kResetAck = 0xFF;  ///< acknowledges a reset of the sequence

enum class Kind : std::uint8_t {
  Frame,
  ReadUnitInfo,
  ResetId,
  Discover,
  AssignId,
  UnblockDownstream,
  SetTime,
  Heartbeat
};

/// Flags of a unit in its answers.
enum UnitFlag : std::uint8_t {
  kAssigned = 1,
  kDownstreamOpen = 2,
  kDownstreamLink = 4,
  kSyncReady = 8,
  kClockLocked = 16,
  kGrandmaster = 32
};
/// Flags in the answer to ReadFpgaState.
enum FpgaFlag : std::uint8_t {
  kHot = 1,
  kPatternBank = 4,
  kPatternStopped = 16,
  kTransitionPending = 64,
  kFailsafe = 128
};
enum Status : std::uint8_t { kOk = 0, kNotAssigned = 2 };
enum Error : std::uint8_t { kNoError = 0, kInvalidPayload = 2, kFailsafeConditionActive = 0x15 };

/// An answer of a unit; `body` refers to the bytes given.
struct Reply {
  Kind kind = Kind::Frame;
  std::uint16_t id = 0;
  std::uint8_t status = kOk;  ///< kOk for frames and heartbeats, which have none
  std::span<const std::uint8_t> body;
};
/// Parses an answer; empty if it is too short or not of wire version 2.
std::optional<Reply> read_reply(std::span<const std::uint8_t> bytes);
/// The wire version of a datagram; 0 if it is too short.
int version_of(std::span<const std::uint8_t> bytes);

struct UnitInfo {
  std::uint8_t unit = kUnassigned, flags = 0;
  std::array<std::uint8_t, 3> firmware{};
};
std::optional<UnitInfo> read_unit_info(const Reply& reply);

/// Body of an answer to a frame or a heartbeat.
struct FrameReply {
  std::uint8_t ack = kResetAck, error = kNoError, flags = 0, unit = kUnassigned;
  std::uint64_t time = 0;  ///< of the unit [ns]
  std::span<const std::uint8_t> data;
};
std::optional<FrameReply> read_frame_reply(const Reply& reply);

/// Returns a clause with the reason why a unit refused a request, and the remedy.
std::string status_words(std::uint8_t status);
std::string error_words(std::uint8_t error);

}  // namespace prostm::sdk
