#include "prostm/device/autd3_sdk/autd3_sdk_reply.hpp"

namespace prostm::sdk {
namespace {

constexpr std::size_t kHeader = 4, kUnitInfo = 20, kFrameReply = 12;

std::uint64_t number(std::span<const std::uint8_t> bytes, std::size_t first, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t i = size; i-- > 0;) value = value << 8 | bytes[first + i];
  return value;
}

bool has_status(Kind kind) {
  return kind != Kind::Frame && kind != Kind::Heartbeat;
}

}  // namespace

int version_of(std::span<const std::uint8_t> bytes) {
  return bytes.size() < kHeader ? 0 : bytes[0];
}

std::optional<Reply> read_reply(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kHeader || bytes[0] != kVersion) return std::nullopt;
  if (bytes[1] > static_cast<std::uint8_t>(Kind::Heartbeat)) return std::nullopt;
  Reply reply;
  reply.kind = static_cast<Kind>(bytes[1]);
  reply.id = static_cast<std::uint16_t>(number(bytes, 2, 2));
  reply.body = bytes.subspan(kHeader);
  if (!has_status(reply.kind)) return reply;
  if (reply.body.empty()) return std::nullopt;
  reply.status = reply.body.front();
  reply.body = reply.body.subspan(1);
  return reply;
}

std::optional<UnitInfo> read_unit_info(const Reply& reply) {
  if (reply.kind != Kind::ReadUnitInfo || reply.status != kOk || reply.body.size() < kUnitInfo)
    return std::nullopt;
  UnitInfo info;
  info.unit = reply.body[0];
  info.flags = reply.body[1];
  for (std::size_t i = 0; i < info.firmware.size(); ++i) info.firmware[i] = reply.body[4 + i];
  return info;
}

std::optional<FrameReply> read_frame_reply(const Reply& reply) {
  if (has_status(reply.kind) || reply.body.size() < kFrameReply) return std::nullopt;
  FrameReply frame;
  frame.ack = reply.body[0];
  frame.error = reply.body[1];
  frame.flags = reply.body[2];
  frame.unit = reply.body[3];
  frame.time = number(reply.body, 4, 8);
  frame.data = reply.body.subspan(kFrameReply);
  return frame;
}

std::string status_words(std::uint8_t status) {
  switch (status) {
    case 0:
      return "did it";
    case 1:
      return "has firmware of another wire version; prostm speaks version 2, so update the unit "
             "with "
             "the AUTD3 SDK 0.10 or newer";
    case 2:
      return "has forgotten its number; another program has taken the units over, or the unit was "
             "switched off and on";
    case 3:
      return "cannot use the number or the time that it was given; switch the units off and on";
    case 4:
      return "does not keep the common time, because another unit does; switch the units off and "
             "on";
    default:
      return "answered with status " + std::to_string(status) +
             ", which prostm does not know; its firmware is newer";
  }
}

std::string error_words(std::uint8_t error) {
  switch (error) {
    case 0x00:
      return "did it";
    case 0x01:
      return "does not know a command; its firmware is older than that of the AUTD3 SDK 0.10, so "
             "update it";
    case 0x02:
      return "cannot use the values of a command; prostm does not support the version of its "
             "firmware";
    case 0x04:
      return "refused the silencer's setting, because samples change faster than the silencer can "
             "follow; use a lower sampling rate";
    case 0x05:
      return "refused to switch to the next block in this way; prostm does not support the "
             "version of its firmware";
    case 0x06:
      return "received the switch to the next block too late; check the network's delay";
    case 0x07:
      return "has a logic chip that does not answer; switch the unit off and on";
    case 0x08:
      return "has no common clock yet; wait, or switch the units off and on";
    case 0x09:
      return "has a clock with an unusable period; switch the units off and on";
    case 0x0A:
    case 0x0D:
    case 0x0E:
      return "got a command of a firmware update that had not begun; switch it off and on";
    case 0x0B:
      return "has a damaged image of its firmware; update it again with the AUTD3 SDK";
    case 0x0C:
      return "cannot write its memory for firmware; update it again, and if that fails it is "
             "broken";
    case 0x0F:
      return "cannot update its firmware over the network; update it once with a cable, as the "
             "AUTD3 "
             "SDK says";
    case 0x10:
      return "is updating its firmware and makes no output; wait until it has restarted";
    case 0x11:
      return "did not start its new firmware; switch it off and on";
    case 0x12:
      return "is about to restart with new firmware; wait a second";
    case 0x13:
      return "was given firmware for another network; update it with the image for UDP";
    case 0x14:
      return "was too busy to join the common time; try again";
    case 0x15:
      return "stays muted, because the cause persists: it receives nothing from the host, or its "
             "clock is not synchronised; check the network";
    default:
      return "answered with error " + std::to_string(error) +
             ", which prostm does not know; its firmware is newer";
  }
}

}  // namespace prostm::sdk
