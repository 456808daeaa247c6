#include "prostm/device/stream/detail/stream_server.hpp"

#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <random>

namespace prostm::stream {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kExpiry{1000};  // after the last message of a receiver
constexpr milliseconds kHeartbeat{5};  // longest time without a message to a subscriber
constexpr milliseconds kClosing{500};  // for a receiver to read its last message
constexpr milliseconds kFinish{100};   // for all receivers to read their last messages
constexpr int kSilentAfter = 4000;     // samples with intensity 0: 100 ms
constexpr int kDatagramsAtOnce = 64;
constexpr int kErrorsASecond = 20;  // over UDP, where senders' addresses may be forged
constexpr int kWait_ms = 5;

/// Makes a ring with room for the largest block in each slot.
std::unique_ptr<SpscRing<BlockRecord>> make_ring(std::size_t blocks, const StreamSettings& s) {
  auto ring = std::make_unique<SpscRing<BlockRecord>>(blocks);
  for (std::size_t i = 0; i <= blocks; ++i) {  // it has one more slot
    ring->back()->focus.resize(static_cast<std::size_t>(s.block_samples * s.max_foci));
    ring->commit();
    ring->pop();
  }
  return ring;
}

std::uint64_t random_bits() {
  std::random_device device;
  return (std::uint64_t{device()} << 32U) | device();
}

}  // namespace

StreamServer::StreamServer(const HostPort& address, const StreamSettings& settings)
    : settings_(settings),
      sockets_(open_sockets(address)),
      wake_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)),
      session_(static_cast<std::uint32_t>(random_bits()) | 1U),
      secret_(random_bits()),
      ring_(make_ring(kRing, settings)),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

StreamServer::~StreamServer() = default;

StreamStats StreamServer::stats() const {
  return {count_.subscribers.load(), count_.skipped.load(), count_.refused.load(),
          count_.ignored.load()};
}

void StreamServer::send() {
  ring_->commit();
  const std::uint64_t one = 1;
  // a full counter wakes the server as well
  [[maybe_unused]] const auto written = write(wake_.get(), &one, sizeof(one));
}

void StreamServer::set_running(bool running) {
  running_ = running;
}

void StreamServer::set_loop(std::shared_ptr<const PlayedLoop> loop) {
  const std::lock_guard lock(loop_mutex_);
  loop_.swap(loop);
}

void StreamServer::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    wait();
    take_blocks(Clock::now());
    const auto now = Clock::now();
    accept(now);
    take_datagrams(now);
    for (Peer& peer : peers_) {
      if (!peer.is_free() && peer.is_tcp()) take_bytes(peer, now);
    }
    take_blocks(now);
    send_loops(now);
    maintain_peers(Clock::now());
  }
  finish();
}

/// Waits for data, or until a heartbeat may be due.
void StreamServer::wait() {
  std::size_t n = 0;
  const auto watch = [&](int fd, short events) {
    polled_[n++] = {.fd = fd, .events = events, .revents = 0};
  };
  watch(wake_.get(), POLLIN);
  watch(sockets_.tcp.get(), POLLIN);
  watch(sockets_.udp.get(), POLLIN);
  for (const Peer& peer : peers_) {
    if (peer.is_free() || !peer.is_tcp()) continue;
    watch(peer.fd(), static_cast<short>(peer.has_waiting() ? POLLIN | POLLOUT : POLLIN));
  }
  poll(polled_.data(), n, kWait_ms);
  std::uint64_t woken = 0;
  [[maybe_unused]] const auto got = read(wake_.get(), &woken, sizeof(woken));
}

void StreamServer::accept(Clock::time_point now) {
  if ((polled_[1].revents & POLLIN) == 0) return;
  for (int i = 0; i < kMostSubscribers; ++i) {
    Descriptor connection = accept_connection(sockets_.tcp);
    if (!connection) return;
    Peer* peer = free_peer();
    if (peer == nullptr) {  // too many connections without a subscription
      count_.refused.fetch_add(1, std::memory_order_relaxed);
      continue;
    }
    peer->open_tcp(std::move(connection), now);
  }
}

void StreamServer::take_datagrams(Clock::time_point now) {
  for (int i = 0; i < kDatagramsAtOnce; ++i) {
    Address from;
    const auto size = receive(sockets_.udp, scratch_, from);
    if (size < 0) return;
    if (size > static_cast<std::ptrdiff_t>(kLongestRequest)) {
      if (has_magic(scratch_)) {
        refuse_datagram(from, Reason::Length, now);
      } else {
        count_.ignored.fetch_add(1, std::memory_order_relaxed);
      }
      continue;
    }
    std::array<std::uint8_t, kLongestRequest> bytes{};
    std::copy_n(scratch_.begin(), size, bytes.begin());
    take_datagram(std::span(bytes).first(static_cast<std::size_t>(size)), from, now);
  }
}

/// Answers a datagram. Ignores datagrams without the magic word, and messages from a server: two
/// servers must not answer each other forever.
void StreamServer::take_datagram(std::span<const std::uint8_t> bytes, const Address& from,
                                 Clock::time_point now) {
  const Reading reading = read_request(bytes);
  const bool of_server = bytes.size() > 5 && bytes[5] >= static_cast<std::uint8_t>(Kind::Hello);
  if (reading.wrong == Reason::Foreign || bytes.size() < kHeaderBytes || of_server) {
    count_.ignored.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  if (reading.wrong != Reason::None) return refuse_datagram(from, reading.wrong, now);
  if (reading.used != bytes.size()) return refuse_datagram(from, Reason::Length, now);

  const Request& request = reading.request;
  const std::uint32_t token = from.token(secret_);
  Peer* peer = peer_of(from);
  if (request.kind == Kind::Subscribe && request.wishes.loops)
    return refuse_datagram(from, Reason::LoopOverUdp, now);
  if (request.kind == Kind::Subscribe && request.token != token) {
    const std::size_t n = put_hello(scratch_, {session_, 0}, hello(false, token, request.wishes));
    send_to(sockets_.udp, std::span(scratch_).first(n), from);
    return;
  }
  if (peer == nullptr && request.kind != Kind::Subscribe)
    return refuse_datagram(from, Reason::NotSubscribed, now);
  if (request.kind == Kind::Bye && request.token != token) return;
  if (peer == nullptr) {
    if (subscribers() >= kMostSubscribers || (peer = free_peer()) == nullptr)
      return refuse_datagram(from, Reason::Full, now);
    peer->open_udp(sockets_.udp, from, now);
  }
  take_request(*peer, request, now);
}

void StreamServer::refuse_datagram(const Address& to, Reason reason, Clock::time_point now) {
  count_.refused.fetch_add(1, std::memory_order_relaxed);
  if (now - errors_since_ > std::chrono::seconds(1)) {
    errors_since_ = now;
    errors_ = 0;
  }
  if (++errors_ > kErrorsASecond) return;
  const std::size_t n = put_end(scratch_, {session_, 0}, Kind::Error, reason);
  send_to(sockets_.udp, std::span(scratch_).first(n), to);
}

/// Reads a connection and handles its messages.
void StreamServer::take_bytes(Peer& peer, Clock::time_point now) {
  const bool open = peer.read();
  while (peer.state() != Peer::State::Closing && !peer.unread().empty()) {
    const Reading reading = read_request(peer.unread());
    if (reading.wrong != Reason::None) {
      count_.refused.fetch_add(1, std::memory_order_relaxed);
      peer.end(session_, Kind::Error, reading.wrong, now);
    } else if (reading.used == 0) {
      break;
    } else if (take_request(peer, reading.request, now) && !peer.is_free()) {
      peer.drop_read(reading.used);
    }
  }
  if (peer.state() == Peer::State::Closing) peer.drop_read(peer.unread().size());
  if (!open || !peer.flush()) peer.close();
}

/// Handles a request; false if that ended the connection.
bool StreamServer::take_request(Peer& peer, const Request& request, Clock::time_point now) {
  if (request.kind == Kind::Subscribe) {
    if (!peer.is_subscribed() && subscribers() >= kMostSubscribers) {
      count_.refused.fetch_add(1, std::memory_order_relaxed);
      peer.end(session_, Kind::Error, Reason::Full, now);
      return false;
    }
    subscribe(peer, request, now);
    return true;
  }
  if (request.kind == Kind::Bye) {
    peer.end(session_, Kind::End, Reason::Asked, now);
    return false;
  }
  if (!peer.is_subscribed()) {
    count_.refused.fetch_add(1, std::memory_order_relaxed);
    peer.end(session_, Kind::Error, Reason::NotSubscribed, now);
    return false;
  }
  if (peer.is_tcp()) peer.hear(now);  // over UDP only SUBSCRIBE renews, since it carries the token
  const std::int64_t received = to_ns(Clock::now());  // `now` is older: one for all requests
  peer.send(session_, now, [&](auto out, const Envelope& e) {
    return put_time(out, e, request.time_ns, received, to_ns(Clock::now()));
  });
  return true;
}

void StreamServer::subscribe(Peer& peer, const Request& request, Clock::time_point now) {
  const bool is_new = !peer.is_subscribed() || peer.wishes() != request.wishes;
  peer.subscribe(request.wishes, now);
  const std::uint32_t token = peer.is_tcp() ? 0 : request.token;
  peer.send(session_, now, [&](auto out, const Envelope& e) {
    return put_hello(out, e, hello(true, token, request.wishes));
  });
  if (is_new) send_state(peer, now);
}

Hello StreamServer::hello(bool subscribed, std::uint32_t token, const Wishes& wishes) const {
  Hello hello;
  hello.subscribed = subscribed;
  hello.token = token;
  hello.wishes = wishes;
  hello.sample_rate = StreamSettings::kSampleRate;
  hello.block_samples = settings_.block_samples;
  hello.max_foci = settings_.max_foci;
  hello.now_ns = to_ns(Clock::now());
  hello.next_sample = next_sample_;
  hello.next_play_ns = next_play_ns_;
  const double lead =
      settings_.queue_blocks() * settings_.block_samples * 1e9 / StreamSettings::kSampleRate;
  hello.lead_ns = static_cast<std::int64_t>(lead);
  return hello;
}

void StreamServer::take_blocks(Clock::time_point now) {
  const bool running = running_;
  while (BlockRecord* record = ring_->front()) {
    take_block(*record, now);
    ring_->pop();
  }
  if (!running && state_ != PlayState::Stopped && !running_) {
    missed_ = unsent_ = 0;
    playing_loop_ = 0;
    set_state(PlayState::Stopped, Reason::NotStarted, next_sample_, now);
  }
}

void StreamServer::take_block(BlockRecord& record, Clock::time_point now) {
  const BlockView block{record.first, record.play_ns, StreamSettings::kSampleRate, record.foci,
                        record.span()};
  playing_loop_ = record.loop;
  loop_first_ = record.loop_first;
  loop_play_ns_ = record.loop_play_ns;

  // report changes before the block to which they apply
  const bool zero = std::all_of(block.samples.begin(), block.samples.end(),
                                [](const FocusSample& s) { return s.intensity == 0.0F; });
  silent_samples_ = zero ? std::min(silent_samples_ + record.samples, kSilentAfter) : 0;
  const bool silent = silent_samples_ >= kSilentAfter;
  const PlayState state = silent ? PlayState::Silent : PlayState::Playing;
  const bool late = record.missed != missed_;
  missed_ = record.missed;
  if (late) {
    set_state(state, Reason::Late, record.first, now);
  } else if (state != state_) {
    set_state(state, silent ? Reason::ZeroSamples : Reason::None, record.first, now);
  }

  const std::int64_t unsent = record.unsent - unsent_;
  unsent_ = record.unsent;
  for (Peer& peer : peers_) {
    if (!peer.is_subscribed() || peer.wishes().loops) continue;
    if (unsent > 0) peer.skip(unsent);
    if (!peer.send_block(session_, block, now))
      count_.skipped.fetch_add(1, std::memory_order_relaxed);
  }
  next_sample_ = record.first + record.samples;
  next_play_ns_ = record.play_ns +
                  static_cast<std::int64_t>(record.samples * 1e9 / StreamSettings::kSampleRate);
}

void StreamServer::set_state(PlayState state, Reason reason, std::int64_t sample,
                             Clock::time_point now) {
  state_ = state;
  reason_ = reason;
  state_sample_ = sample;
  for (Peer& peer : peers_) {
    if (peer.is_subscribed()) send_state(peer, now);
  }
}

void StreamServer::send_state(Peer& peer, Clock::time_point now) {
  const bool no_loop = peer.wishes().loops && playing_loop_ == 0 && state_ != PlayState::Stopped;
  const bool told = peer.send(session_, now, [&](auto out, const Envelope& e) {
    return no_loop ? put_state(out, e, PlayState::Stopped, Reason::NoLoop, state_sample_)
                   : put_state(out, e, state_, reason_, state_sample_);
  });
  // over TCP, a receiver that missed a state must not continue
  if (!told && peer.is_tcp()) peer.close();
}

/// Sends the loop, and the time when it began, to subscribers of loops.
void StreamServer::send_loops(Clock::time_point now) {
  {
    const std::unique_lock lock(loop_mutex_, std::try_to_lock);
    if (lock && sent_loop_ != loop_) sent_loop_ = loop_;
  }
  if (!sent_loop_ || state_ == PlayState::Stopped) return;
  for (Peer& peer : peers_) {
    if (!peer.is_subscribed() || !peer.wishes().loops) continue;
    peer.send_loop(session_, sent_loop_, now);
    if (playing_loop_ != sent_loop_->id || peer.started_loop == sent_loop_->id ||
        !peer.has_whole(*sent_loop_))
      continue;
    const bool told = peer.send(session_, now, [&](auto out, const Envelope& e) {
      return put_loop_start(out, e, playing_loop_, loop_first_, loop_play_ns_);
    });
    if (told) peer.started_loop = sent_loop_->id;
  }
}

/// Sends heartbeats, and ends the subscriptions of silent receivers.
void StreamServer::maintain_peers(Clock::time_point now) {
  for (Peer& peer : peers_) {
    if (peer.is_free()) continue;
    const auto quiet = now - peer.heard();
    if (peer.state() == Peer::State::Closing) {
      if (quiet > kClosing) peer.close();
    } else if (quiet > kExpiry) {
      const bool greeting = peer.state() == Peer::State::Greeting;
      peer.end(session_, greeting ? Kind::Error : Kind::End,
               greeting ? Reason::NotSubscribed : Reason::NothingHeard, now);
    } else if (peer.is_subscribed() && now - peer.sent() >= kHeartbeat) {
      peer.send(session_, now, [&](auto out, const Envelope& e) {
        return put_heartbeat(out, e, to_ns(now), next_sample_, state_);
      });
    }
  }
  count_.subscribers.store(subscribers(), std::memory_order_relaxed);
}

/// Sends END to all receivers, and waits a little for those that have not read it.
void StreamServer::finish() {
  const auto end = Clock::now() + kFinish;
  for (Peer& peer : peers_) {
    if (!peer.is_free() && peer.state() != Peer::State::Closing)
      peer.end(session_, Kind::End, Reason::ProstmEnds, Clock::now());
  }
  const auto waits = [](Peer& peer) {
    return !peer.is_free() && peer.is_tcp() && peer.flush() && peer.has_waiting();
  };
  while (Clock::now() < end && std::any_of(peers_.begin(), peers_.end(), waits))
    std::this_thread::sleep_for(milliseconds(1));
  for (Peer& peer : peers_) peer.close();
}

Peer* StreamServer::free_peer() {
  const auto it =
      std::find_if(peers_.begin(), peers_.end(), [](const Peer& peer) { return peer.is_free(); });
  return it == peers_.end() ? nullptr : &*it;
}

Peer* StreamServer::peer_of(const Address& address) {
  const auto it = std::find_if(peers_.begin(), peers_.end(), [&](const Peer& peer) {
    return !peer.is_free() && !peer.is_tcp() && peer.address() == address;
  });
  return it == peers_.end() ? nullptr : &*it;
}

int StreamServer::subscribers() const {
  return static_cast<int>(
      std::count_if(peers_.begin(), peers_.end(), [](const Peer& p) { return p.is_subscribed(); }));
}

}  // namespace prostm::stream
