#include "prostm/device/autd3_sdk/detail/autd3_sdk_wire.hpp"

#include <cmath>

namespace prostm::sdk {
namespace {

constexpr int kWordsPerFocus = 4, kBytesPerFocus = 8;  // words of 16 bit
constexpr unsigned kOnce = 0;                          // repetitions of a pattern
constexpr unsigned kSyncIdx = 0;                       // transition
constexpr unsigned kStrict = 2;
constexpr unsigned kRate = 256;  // default of the silencer's other mode

}  // namespace

void Datagram::renumber(std::uint16_t id, std::uint8_t sequence) {
  bytes_[2] = static_cast<std::uint8_t>(id & 0xFF);
  bytes_[3] = static_cast<std::uint8_t>(id >> 8);
  bytes_[4] = sequence;
}

void begin(Datagram& d, Kind kind, std::uint16_t id) {
  d.size_ = 0;
  d.u8(kVersion);
  d.u8(static_cast<unsigned>(kind));
  d.u16(id);
}

void assign_id(Datagram& d, std::uint16_t id, std::uint8_t unit, bool grandmaster) {
  begin(d, Kind::AssignId, id);
  d.u8(unit);
  d.u8(grandmaster ? 1 : 0);
}

void set_time(Datagram& d, std::uint16_t id, std::uint64_t nanoseconds) {
  begin(d, Kind::SetTime, id);
  d.u64(nanoseconds);
}

void frame(Datagram& d, Command command) {
  begin(d, Kind::Frame, 0);
  d.u8(0);
  d.u8(static_cast<unsigned>(command));
}

void write_foci(Datagram& d, int bank, int first, std::span<const SlotWord> words) {
  frame(d, Command::WriteFoci);
  d.u8(static_cast<unsigned>(bank));
  d.u8(0);
  d.u32(static_cast<std::uint32_t>(first * kWordsPerFocus));
  d.u16(static_cast<unsigned>(words.size()) * kBytesPerFocus);
  for (const SlotWord word : words) d.u64(word);
}

void config_pattern(Datagram& d, const Pattern& pattern) {
  frame(d, Command::ConfigPattern);
  d.u8(static_cast<unsigned>(pattern.bank));
  d.u8(0);  // foci
  d.u16(static_cast<unsigned>(pattern.divider));
  d.u32(static_cast<std::uint32_t>(pattern.samples));
  d.u8(static_cast<unsigned>(pattern.slots));
  d.u8(0);
  d.u16(static_cast<unsigned>(std::lround(pattern.sound_speed * 64.0)));
  d.u16(kOnce);
}

void activate(Datagram& d, int bank, bool margin_field) {
  frame(d, Command::ActivatePatternBank);
  d.u8(static_cast<unsigned>(bank));
  d.u8(kSyncIdx);
  d.u64(0);
  if (margin_field) d.u32(0);
}

void silencer(Datagram& d, int steps) {
  frame(d, Command::SetSilencer);
  d.u8(kStrict);
  d.u8(0);
  for (int i = 0; i < 2; ++i) d.u16(kRate);
  for (int i = 0; i < 2; ++i) d.u16(static_cast<unsigned>(steps));
}

void cpu_config(Datagram& d, int failsafe_ms) {
  frame(d, Command::SetCpuConfig);
  d.u32(10'000'000);     // margin of a transition at a given time [ns]
  d.u32(1'000'000);      // polls for an update
  d.u32(2'000'000'000);  // polls for the flash
  d.u32(250'000);        // guard of the synchronisation [ns]
  d.u16(100);            // delay of an update [ms]
  d.u16(8);              // from here on, clock synchronisation: interval [ms]
  d.u16(3);              // timeout of a time stamp [ms]
  d.u16(6);              // timeout of a delay response [ms]
  d.u16(1000);           // holdover [ms]
  d.u16(64);             // samples until locked
  d.u32(10'000);         // offset above which the clock is stepped [ns]
  d.u32(100);            // offset that counts as locked [ns]
  d.u32(50);             // controller, proportional [1/1000]
  d.u32(1);              // controller, integral [1/1000]
  d.u32(500'000);        // largest correction [ppb]
  d.u16(static_cast<unsigned>(failsafe_ms));
  d.u16(32);  // synchronisations per delay request
  d.u16(5);   // filter of the delay
  d.u16(48);  // pause [quanta]
  d.u16(64);  // pause [synchronisations]
  d.u16(8);   // time until a pause is retried [ms]
  d.u16(0);   // failsafe for a clock that is not locked: off
  d.u16(3);   // wait of the bus [cycles]
}

}  // namespace prostm::sdk
