#pragma once
/// One receiver of a stream, over TCP or UDP.

#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "prostm/device/stream/detail/stream_sockets.hpp"
#include "prostm/device/stream/detail/stream_wire.hpp"

namespace prostm::stream {

using Clock = std::chrono::steady_clock;

inline std::int64_t to_ns(Clock::time_point time) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(time.time_since_epoch()).count();
}

/// A closed loop that the device repeats.
struct PlayedLoop {
  std::uint32_t id = 0;
  int foci = 1;
  double sample_rate = 0.0;  ///< [Hz]
  std::vector<FocusSample> samples;

  BlockView view() const { return {0, 0, sample_rate, foci, samples}; }
};

/// Used by the server's thread only. Buffers are allocated once; sending never allocates or blocks.
class Peer {
 public:
  enum class State : std::uint8_t {
    Free,
    Greeting,  ///< connected, but not subscribed yet
    Subscribed,
    Closing  ///< closed once its queued messages are sent
  };

  Peer();

  void open_tcp(Descriptor&& connection, Clock::time_point now);
  void open_udp(const Descriptor& socket, const Address& address, Clock::time_point now);
  void subscribe(const Wishes& wishes, Clock::time_point now);
  /// Sends END or ERROR, then closes: UDP at once, TCP once it is sent or after a timeout.
  void end(std::uint32_t session, Kind kind, Reason reason, Clock::time_point now);
  void close();

  State state() const { return state_; }
  bool is_free() const { return state_ == State::Free; }
  bool is_subscribed() const { return state_ == State::Subscribed; }
  bool is_tcp() const { return static_cast<bool>(connection_); }
  int fd() const { return connection_.get(); }
  bool has_waiting() const { return head_ < tail_; }
  const Address& address() const { return address_; }
  const Wishes& wishes() const { return wishes_; }
  Clock::time_point heard() const { return heard_; }
  Clock::time_point sent() const { return sent_; }
  void hear(Clock::time_point now) { heard_ = now; }

  /// Reads arrived bytes into a buffer; false when the connection is closed.
  bool read();
  /// Bytes from the receiver that are not processed yet.
  std::span<const std::uint8_t> unread() const { return std::span(in_).first(unread_); }
  void drop_read(std::size_t bytes);
  /// Sends queued bytes, as far as the socket accepts them; false when the connection is broken.
  bool flush();

  /// Sends a block; over UDP, in datagrams with a part of it each. If the buffer is full, the block
  /// is skipped and counted. @return whether it was sent.
  bool send_block(std::uint32_t session, const BlockView& block, Clock::time_point now);
  /// Counts samples that are skipped before the next block.
  void skip(std::int64_t samples) {
    skipped_ += samples;
    gap_ = true;
  }
  /// Sends the next parts of a loop, as far as the buffer has room.
  void send_loop(std::uint32_t session, const std::shared_ptr<const PlayedLoop>& loop,
                 Clock::time_point now);
  bool has_whole(const PlayedLoop& loop) const {
    return loop_id_ == loop.id && loop_sent_ == loop.view().count();
  }
  std::uint32_t started_loop = 0;  ///< id of the loop whose LOOP_START was sent

  /// Sends a short message. @param put writes the message, given a span and an envelope, and
  /// returns its size. @return false if the buffer is full.
  template <class Put>
  bool send(std::uint32_t session, Clock::time_point now, Put&& put) {
    const std::span<std::uint8_t> out = room(kDatagramBytes, kWaitingMost);
    if (out.empty()) return false;
    return commit(put(out, Envelope{session, sequence_}), now);
  }

 private:
  static constexpr std::size_t kBlocksMost = 256 << 10;   // bytes of blocks in the queue: 100 ms
  static constexpr std::size_t kWaitingMost = 272 << 10;  // bytes of all messages in it
  static constexpr std::size_t kLoopPart = 1024;          // focal points of a LOOP

  std::span<std::uint8_t> room(std::size_t bytes, std::size_t most);
  bool commit(std::size_t bytes, Clock::time_point now);

  State state_ = State::Free;
  Descriptor connection_;  // of TCP
  const Descriptor* udp_ = nullptr;
  Address address_;  // of UDP
  Wishes wishes_;
  std::uint32_t sequence_ = 0;
  Clock::time_point heard_{}, sent_{};

  std::array<std::uint8_t, 4 * kLongestRequest> in_{};
  std::size_t unread_ = 0;
  std::vector<std::uint8_t> out_;
  std::size_t head_ = 0, tail_ = 0;  // queued bytes of out_

  std::int64_t skipped_ = 0;  // samples
  bool gap_ = false;
  std::uint32_t loop_id_ = 0;
  std::size_t loop_sent_ = 0;  // samples
};

}  // namespace prostm::stream
