#pragma once
/// Sends the blocks of a device to its subscribers.

#include <poll.h>

#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <thread>

#include "prostm/core/spsc_ring.hpp"
#include "prostm/device/stream/detail/stream_peer.hpp"
#include "prostm/device/stream/stream_settings.hpp"
#include "prostm/device/stream/stream_stats.hpp"

namespace prostm::stream {

inline constexpr int kMostSubscribers = 8;

/// A block passed from the thread that fills it to the thread that sends it.
struct BlockRecord {
  std::int64_t first = 0, play_ns = 0;
  std::int64_t missed = 0;        ///< missed blocks since the start
  std::uint32_t loop = 0;         ///< id of the loop playing at the block's end; 0: a stream
  std::int64_t loop_first = 0;    ///< sample at which it began
  std::int64_t loop_play_ns = 0;  ///< play time of that sample
  std::int64_t unsent = 0;  ///< samples of earlier blocks dropped from a full ring, since the start
  int samples = 0, foci = 1;
  std::vector<FocusSample> focus;  ///< has room for the largest block

  std::span<FocusSample> span() {
    return std::span(focus).first(static_cast<std::size_t>(samples * foci));
  }
};

/// Has a thread of its own, which owns the sockets and never waits for a subscriber: blocks that do
/// not fit into a subscriber's buffer are dropped and counted. After construction neither thread
/// allocates.
class StreamServer {
 public:
  /// @throws std::invalid_argument if it cannot listen there.
  StreamServer(const HostPort& address, const StreamSettings& settings);
  ~StreamServer();

  std::uint16_t port() const { return sockets_.port; }
  StreamStats stats() const;

  /// Room for the next block; null if the ring is full, because the server's thread did not run for
  /// long. Called by the device's thread.
  BlockRecord* draft() { return ring_->back(); }
  /// Sends the draft. Called by the device's thread.
  void send();
  /// Call it when the device's thread starts or has ended.
  void set_running(bool running);
  /// Sets the loop that the device repeats once the record of a block names it. Any thread.
  void set_loop(std::shared_ptr<const PlayedLoop> loop);

 private:
  static constexpr std::size_t kPeers = 2 * kMostSubscribers;
  static constexpr std::size_t kRing = 256;  // blocks

  void run(const std::stop_token& stop);
  void wait();
  void accept(Clock::time_point now);
  void take_datagrams(Clock::time_point now);
  void take_datagram(std::span<const std::uint8_t> bytes, const Address& from,
                     Clock::time_point now);
  void take_bytes(Peer& peer, Clock::time_point now);
  bool take_request(Peer& peer, const Request& request, Clock::time_point now);
  void subscribe(Peer& peer, const Request& request, Clock::time_point now);
  void refuse_datagram(const Address& to, Reason reason, Clock::time_point now);
  void take_blocks(Clock::time_point now);
  void take_block(BlockRecord& record, Clock::time_point now);
  void set_state(PlayState state, Reason reason, std::int64_t sample, Clock::time_point now);
  void send_state(Peer& peer, Clock::time_point now);
  void send_loops(Clock::time_point now);
  void maintain_peers(Clock::time_point now);
  void finish();

  Hello hello(bool subscribed, std::uint32_t token, const Wishes& wishes) const;
  Peer* free_peer();
  Peer* peer_of(const Address& address);
  int subscribers() const;

  const StreamSettings settings_;
  Sockets sockets_;
  Descriptor wake_;  // an eventfd
  const std::uint32_t session_;
  const std::uint64_t secret_;  // of the tokens

  // written by the device's thread
  std::unique_ptr<SpscRing<BlockRecord>> ring_;
  std::atomic<bool> running_{false};
  std::mutex loop_mutex_;  // guards loop_
  std::shared_ptr<const PlayedLoop> loop_;

  // used by the server's thread
  std::array<Peer, kPeers> peers_;
  std::array<pollfd, kPeers + 3> polled_{};
  std::array<std::uint8_t, kDatagramBytes> scratch_{};
  std::shared_ptr<const PlayedLoop> sent_loop_;
  PlayState state_ = PlayState::Stopped;
  Reason reason_ = Reason::NotStarted;
  std::int64_t state_sample_ = 0, next_sample_ = 0, next_play_ns_ = 0, missed_ = 0, unsent_ = 0;
  int silent_samples_ = 0;
  std::uint32_t playing_loop_ = 0;
  std::int64_t loop_first_ = 0, loop_play_ns_ = 0;
  Clock::time_point errors_since_{};
  int errors_ = 0;  // over UDP, in the second since then

  struct {
    std::atomic<std::int64_t> skipped{0}, refused{0}, ignored{0};
    std::atomic<int> subscribers{0};
  } count_;
  std::jthread thread_;  // the last member, so that it ends first
};

}  // namespace prostm::stream
