#pragma once
/// Datagrams of the AUTD3 SDK's UDP transport, wire version 2. All numbers are little-endian.

#include <array>
#include <cstdint>
#include <span>

#include "prostm/device/autd3_sdk/autd3_sdk_reply.hpp"
#include "prostm/device/detail/slot_encoder.hpp"

namespace prostm::sdk {

inline constexpr std::uint16_t kPort = 44336;
inline constexpr std::size_t kMostDatagram = 1452;  ///< [byte], with header, sequence and command
inline constexpr int kFociPerFrame = 179;

enum class Command : std::uint8_t {
  Reset = 0x00,
  Synchronize = 0x01,
  Clear = 0x03,
  Nop = 0x04,
  SetCpuConfig = 0x05,
  ReleaseFailsafe = 0x06,
  WriteFoci = 0x10,
  ConfigPattern = 0x11,
  ActivatePatternBank = 0x12,
  SetSilencer = 0x30,
  ReadFpgaState = 0xE7,
  ReadFirmwareInfo = 0xEB
};

/// A datagram under construction. Bytes that do not fit are dropped.
class Datagram {
 public:
  void u8(unsigned value) {
    if (size_ < bytes_.size()) bytes_[size_++] = static_cast<std::uint8_t>(value & 0xFF);
  }
  void u16(unsigned value) { u8(value), u8(value >> 8); }
  void u32(std::uint32_t value) { u16(value & 0xFFFF), u16(value >> 16); }
  void u64(std::uint64_t value) {
    u32(static_cast<std::uint32_t>(value)), u32(static_cast<std::uint32_t>(value >> 32));
  }
  std::span<const std::uint8_t> bytes() const { return {bytes_.data(), size_}; }
  Command command() const { return static_cast<Command>(bytes_[5]); }  ///< @pre a frame
  /// Sets id and sequence. @pre a frame
  void renumber(std::uint16_t id, std::uint8_t sequence);

 private:
  friend void begin(Datagram&, Kind, std::uint16_t);
  std::array<std::uint8_t, kMostDatagram> bytes_{};
  std::size_t size_ = 0;
};

/// Writes the header. @param id is returned with the answer.
void begin(Datagram& d, Kind kind, std::uint16_t id);
void assign_id(Datagram& d, std::uint16_t id, std::uint8_t unit, bool grandmaster);
void set_time(Datagram& d, std::uint16_t id, std::uint64_t nanoseconds);

/// Writes a frame without a payload. Datagram::renumber sets its id and sequence.
void frame(Datagram& d, Command command);
/// @param first position of the first word in the bank. @pre at most kFociPerFrame words
void write_foci(Datagram& d, int bank, int first, std::span<const SlotWord> words);

struct Pattern {
  int bank = 0;
  int divider = 4;  ///< periods of 40 kHz per sample
  int samples = 100;
  int slots = 8;               ///< foci of a sample
  double sound_speed = 346.0;  ///< [m/s]
};
/// Configures a pattern that plays once and holds its last sample.
void config_pattern(Datagram& d, const Pattern& pattern);
/// Switches to a bank when the common clock makes the bank's index 0.
/// @param margin_field whether the payload ends with a margin, as older firmware requires
void activate(Datagram& d, int bank, bool margin_field);
/// Sets the silencer, in strict mode: changes of intensity and phase take `steps` periods of 40
/// kHz.
void silencer(Datagram& d, int steps);
/// Sets all options of a unit's processor: the failsafe as given, all others to their defaults.
void cpu_config(Datagram& d, int failsafe_ms);

}  // namespace prostm::sdk
