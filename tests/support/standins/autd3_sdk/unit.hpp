#pragma once
/// An AUTD3 unit as the AUTD3 SDK's firmware 0.10 behaves on its UDP port. Written from the
/// protocol's facts alone; shares nothing with the driver.

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "playback.hpp"

namespace standin {

using Bytes = std::vector<std::uint8_t>;

/// Counts of all units together.
struct Findings {
  std::int64_t protocol_errors = 0;
  std::string last_error;
  std::int64_t frames = 0, heartbeats = 0, mismatches = 0, duplicates = 0, resets = 0, clears = 0;
  std::int64_t releases = 0;

  void error(const std::string& what);
};

/// Options shared by all units.
struct Behaviour {
  std::size_t activate_bytes = 10;  ///< length of the command that changes banks: 10 or 14
  std::int64_t lock_time = 50'000'000, ready_time = 100'000'000;  ///< after SetTime [ns]
  bool never_ready = false, unlocked = false;
  bool forgets_to_release = false;              ///< refuses to be released from the failsafe
  std::map<int, std::pair<int, int>> refusals;  ///< command → error, how often (−1: always)
  std::map<int, int> statuses;                  ///< kind → status
};

class Unit {
 public:
  Unit(Findings& findings, Behaviour& behaviour) : findings_(findings), behaviour_(behaviour) {}

  bool open = false;  ///< passes the group's datagrams on to the units behind it
  bool hot = false;
  Playback playback;
  std::int64_t trips = 0;  ///< of the failsafe

  bool is_numbered() const { return id_ >= 0; }
  bool is_grandmaster() const { return grandmaster_; }
  bool failsafe() const { return playback.muted; }
  /// Time of the unit at a time of the host [ns].
  std::int64_t time(std::int64_t now) const { return now + offset_; }
  void set_clock(std::int64_t now, std::int64_t time, bool locks);
  std::int64_t last_sounding() const;  ///< host's time [ns]; −1: never

  /// Advances to a time.
  void advance(std::int64_t now);
  /// Loses power for a moment.
  void power_cycle();
  void trip();
  /// Answers a datagram; empty for no answer.
  /// @param unicast whether it came to its own address. @param last whether it is the chain's last.
  std::optional<Bytes> answer(std::int64_t now, const Bytes& in, bool unicast, bool last);
  bool sets_time = false;  ///< whether the last datagram was an accepted SetTime
  std::int64_t set_to = 0;

 private:
  Bytes status(const Bytes& in, int code, const Bytes& body = {}) const;
  Bytes frame_reply(std::int64_t now, const Bytes& in, bool last) const;
  std::uint8_t flags(std::int64_t now, bool last) const;
  Bytes assign(const Bytes& in);
  Bytes set_time(const Bytes& in);
  Bytes info(std::int64_t now, const Bytes& in, bool last) const;
  void frame(std::int64_t now, const Bytes& in);
  int execute(int command, const Bytes& p);
  int dispatch(int command, const Bytes& p);
  int write_foci(const Bytes& p);
  int config_pattern(const Bytes& p);
  int activate(const Bytes& p);
  int silencer(const Bytes& p);
  int cpu_config(const Bytes& p);
  int release();
  void forget();
  void clear();

  Findings& findings_;
  Behaviour& behaviour_;
  int id_ = -1;
  bool grandmaster_ = false;
  std::int64_t sounded_ = -1;  // last output by an earlier clock, in the host's time
  std::int64_t offset_ = 0, locked_at_ = -1, ready_at_ = -1, forgets_at_ = -1;
  std::int64_t host_at_ = -1;  // when the last datagram of the host arrived
  std::int64_t failsafe_ = 500;
  bool silent_ = false, strict_ = false, synchronised_ = false;
  std::uint32_t steps_intensity_ = 10, steps_phase_ = 40;
  int expected_ = 0, ack_ = 0xFF, error_ = 0, last_sequence_ = 0xFF, last_command_ = 0xFF;
  Bytes data_;
  std::int64_t now_ = 0;
};

}  // namespace standin
