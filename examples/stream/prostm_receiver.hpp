#pragma once
// A receiver of prostm-stream/1 (docs/devices/stream.md) to be included, without dependencies:
// C++17, on Linux and on Windows (link ws2_32, and call WSAStartup first).
//
// The class Receiver maintains the connection on its own thread. Receiver::at() returns the focal
// points at a given time, and fades to silence when the stream stops. Call it in the callback in
// which an array's library requests focal points, or in a loop as in prostm_receiver.cpp.

#ifdef _WIN32
#include <winsock2.h>
#include <ws2tcpip.h>
#else
#include <arpa/inet.h>
#include <fcntl.h>
#include <netdb.h>
#include <netinet/tcp.h>
#include <sys/select.h>
#include <sys/socket.h>
#include <unistd.h>
#endif

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace prostm_receiver {

#ifdef _WIN32
using Socket = SOCKET;
const Socket kNoSocket = INVALID_SOCKET;
inline void close_socket(Socket s) {
  closesocket(s);
}
inline bool would_block() {
  const int e = WSAGetLastError();
  return e == WSAEWOULDBLOCK || e == WSAECONNRESET || e == WSAEMSGSIZE;
}
inline void set_non_blocking(Socket s) {
  u_long yes = 1;
  ioctlsocket(s, FIONBIO, &yes);
}
const int kSendFlags = 0;
#else
using Socket = int;
const Socket kNoSocket = -1;
inline void close_socket(Socket s) {
  close(s);
}
inline bool would_block() {
  return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR || errno == EINPROGRESS ||
         errno == ECONNREFUSED;
}
inline void set_non_blocking(Socket s) {
  fcntl(s, F_SETFL, O_NONBLOCK);
}
const int kSendFlags = MSG_NOSIGNAL;
#endif

using Ns = std::int64_t;  // nanoseconds
constexpr Ns kMs = 1'000'000;

/// Returns the time of this machine's steady clock.
inline Ns now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

// Numbers on the wire are little-endian.
template <class T>
T get(const std::uint8_t* from) {
  std::uint64_t bits = 0;
  for (std::size_t i = sizeof(T); i-- > 0;) bits = (bits << 8) | from[i];
  T value;
  if constexpr (sizeof(T) == 8) {
    std::memcpy(&value, &bits, 8);
  } else if constexpr (sizeof(T) == 4) {
    const auto bits32 = static_cast<std::uint32_t>(bits);
    std::memcpy(&value, &bits32, 4);
  } else {
    value = static_cast<T>(bits);
  }
  return value;
}
inline void put(std::uint8_t* to, std::uint64_t value, std::size_t bytes) {
  for (std::size_t i = 0; i < bytes; ++i) to[i] = static_cast<std::uint8_t>(value >> (8 * i));
}

enum Kind : std::uint8_t {
  kSubscribe = 1,
  kTimeRequest = 2,
  kBye = 3,
  kHello = 16,
  kBlock = 17,
  kState = 18,
  kHeartbeat = 19,
  kTime = 20,
  kEnd = 23,
  kError = 24
};
constexpr std::size_t kHeader = 16;
constexpr int kMostFoci = 8;
constexpr std::int64_t kDatagram = 1200 - kHeader - 32;  // most bytes of samples in a datagram
constexpr Ns kConcealed = 2'000'000;                     // longest gap that is concealed
constexpr int kReadsAtOnce = 64;  // reads between two checks for a due renewal

struct Focus {
  float x = 0, y = 0, z = 0;  ///< [m], from the array's centre, z away from it
  float intensity = 0;        ///< 0..1, linear in acoustic pressure amplitude
};
struct Sample {
  std::int64_t index = -1;
  Ns time = 0;  ///< play time, by prostm's clock
  int foci = 0;
  std::array<Focus, kMostFoci> focus;
};

struct Settings {
  std::string host = "127.0.0.1", port = "7140";
  bool udp = false;
  int foci = 0;                 ///< number of focal points, from the first; 0: all
  int every = 1;                ///< every n-th sample is sent
  bool shared = false;          ///< one intensity for all focal points of a sample
  Ns silence_after = 20 * kMs;  ///< time without a message before the fade-out
  Ns ramp = 5 * kMs;            ///< duration of a fade-out or fade-in
};

struct Statistics {
  std::int64_t samples = 0;    ///< received
  std::int64_t lost = 0;       ///< missing at their play time
  std::int64_t concealed = 0;  ///< lost samples that were interpolated
  std::int64_t late = 0;       ///< arrived after their play time
  std::int64_t skipped = 0;    ///< omitted by prostm because this receiver read too slowly
  std::int64_t silences = 0;   ///< fade-outs because the stream was interrupted
  std::int64_t malformed = 0;  ///< messages or samples that violated the protocol
  std::int64_t subscriptions = 0;
  double round_trip_ms = 0, offset_ms = 0, buffered_ms = 0;
  std::int64_t last_heard = 0;  ///< arrival of the last message [ns]
};

class Receiver {
 public:
  /// Called on the receiver's thread with every sample, and with messages about the connection.
  /// on_sample must return quickly: at() waits for it.
  std::function<void(const Sample&)> on_sample;
  std::function<void(const std::string&)> on_event;

  explicit Receiver(const Settings& settings) : settings_(settings), ring_(kRing) {}
  ~Receiver() { stop(); }
  void start() {
    thread_ = std::thread([this] { run(); });
  }
  void stop() {
    ending_ = true;
    if (thread_.joinable()) thread_.join();
  }

  /// Computes the focal points at a time of this machine's steady clock, with the silence rule
  /// applied. Times must increase from call to call. @return the gain that the intensities contain:
  /// 1 if the stream is not interrupted.
  float at(Ns time, Sample& out);
  Statistics statistics() const;

 private:
  static constexpr std::int64_t kRing = 1 << 14;  // samples: 0.4 s at 40 kHz

  void run();
  bool connect();
  void session();
  bool renew(Ns now);
  bool send(Kind kind, const std::uint8_t* body, std::size_t size);
  bool receive();
  bool take(const std::uint8_t* message, std::size_t size);
  void take_hello(const std::uint8_t* body);
  void take_block(const std::uint8_t* body, std::size_t size);
  void take_time(const std::uint8_t* body);
  void reset();
  void report(const std::string& sentence) {
    if (on_event) on_event(sentence);
  }
  bool bridges(const Sample& last, const Sample& next) const;
  Sample& slot(std::int64_t index) {
    return ring_[static_cast<std::size_t>((index / settings_.every) % kRing)];
  }

  const Settings settings_;
  std::thread thread_;
  std::atomic<bool> ending_{false};

  // used only by the receiver's thread
  Socket socket_ = kNoSocket;
  std::vector<std::uint8_t> in_;
  std::uint32_t token_ = 0, session_ = 0, sequence_ = 0;
  Ns requested_ = 0;
  int requests_ = 0;

  mutable std::mutex mutex_;  // guards the members below
  Statistics count_;
  std::vector<Sample> ring_;  // sample i is at (i / every) mod kRing
  bool subscribed_ = false, stopped_ = false;
  double rate_ = 40e3;  // [Hz]
  std::int64_t newest_ = -1, played_ = -1;
  std::int64_t rejected_ = -1;  // newest sample that violated the protocol
  Ns heard_ = 0, best_trip_ = 0, best_at_ = 0;
  double wanted_offset_ = 0, offset_ = 0;  // prostm's clock minus this machine's [ns]
  bool has_offset_ = false;
  Sample held_;
  float gain_ = 0;
  bool falling_ = true;
  Ns last_at_ = 0;
};

/// Returns true if the samples missing between two may be interpolated: at most one datagram's.
inline bool Receiver::bridges(const Sample& last, const Sample& next) const {
  const std::int64_t missing = (next.index - last.index) / settings_.every - 1;
  const auto period = static_cast<Ns>(1e9 / rate_) * settings_.every;
  const bool wrong = last.index < rejected_ && rejected_ < next.index;  // rejected, not lost
  return !wrong && last.index >= 0 && last.foci == next.foci && missing * period <= kConcealed &&
         missing * last.foci * 16 <= kDatagram &&
         std::abs(next.time - last.time - (missing + 1) * period) <= period;
}

/// Interpolates linearly between the focal points of `last` (share 0) and of `next` (share 1).
inline Sample between(const Sample& last, const Sample& next, double share) {
  const auto mix = [s = static_cast<float>(share)](float a, float b) { return a + s * (b - a); };
  Sample out = last;
  for (std::size_t f = 0; f < out.focus.size(); ++f) {
    const Focus &a = last.focus[f], &b = next.focus[f];
    out.focus[f] = {mix(a.x, b.x), mix(a.y, b.y), mix(a.z, b.z), mix(a.intensity, b.intensity)};
  }
  return out;
}

inline float Receiver::at(Ns time, Sample& out) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const Ns step = last_at_ == 0 ? 0 : std::max<Ns>(0, time - last_at_);
  last_at_ = time;
  // during output the clock offset is adjusted slowly, so that no sample is skipped
  const double change = gain_ == 0.0F ? 1e18 : 1e-3 * static_cast<double>(step);
  offset_ += std::min(change, std::max(-change, wanted_offset_ - offset_));
  const Ns at = time + static_cast<Ns>(offset_);

  // advance to the last sample that is due
  const Ns period = static_cast<Ns>(1e9 / rate_) * settings_.every;
  bool gap = false;
  const Sample* coming = nullptr;  // the first received sample that is not due
  for (std::int64_t next = played_ + settings_.every; next <= newest_; next += settings_.every) {
    const Sample& sample = slot(next);
    if (sample.index != next) continue;  // lost, or not received yet
    if (sample.time > at) {
      coming = &sample;
      break;
    }
    const std::int64_t missing = (next - played_) / settings_.every - 1;
    const bool concealed = missing > 0 && !falling_ && bridges(slot(played_), sample);
    gap = gap || (missing > 0 && !concealed);
    count_.lost += missing;
    if (concealed) count_.concealed += missing;
    played_ = next;
  }
  const Sample* sample = played_ >= 0 ? &slot(played_) : nullptr;
  const bool known = sample != nullptr && sample->index == played_ && at >= sample->time;
  const bool inside = known && at >= sample->time + period && coming != nullptr &&
                      bridges(*sample, *coming);  // a gap to conceal
  const bool here = known && (inside || at < sample->time + period + period / 2);
  const bool fresh = std::max(time, now_ns()) - heard_ <= settings_.silence_after;
  const bool stalled = step > settings_.ramp && step > 2 * period;  // at() was called too late
  const bool good = here && fresh && !stalled && subscribed_ && !stopped_;

  // the silence rule: after any interruption, fade out at the current positions, then fade in
  if ((!good || gap) && !falling_) {
    falling_ = true;
    ++count_.silences;
  }
  const float ramp = static_cast<float>(step) / static_cast<float>(settings_.ramp);
  if (falling_) {
    gain_ = std::max(0.0F, gain_ - ramp);
    if (gain_ == 0.0F && good) falling_ = false;
  } else {
    gain_ = std::min(1.0F, gain_ + ramp);
  }
  if (!falling_ && !inside) held_ = *sample;
  if (!falling_ && inside) {
    const Ns whole = coming->time - sample->time;
    held_ = between(*sample, *coming,
                    static_cast<double>(at - sample->time) / static_cast<double>(whole));
  }
  out = held_;
  for (Focus& focus : out.focus) focus.intensity *= gain_;
  return gain_;
}

inline Statistics Receiver::statistics() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  Statistics s = count_;
  s.offset_ms = offset_ / 1e6;
  s.buffered_ms = static_cast<double>(newest_ - played_) / rate_ * 1e3;
  s.last_heard = heard_;
  return s;
}

inline void Receiver::run() {
  while (!ending_) {
    if (connect()) session();
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      subscribed_ = false;
    }
    if (socket_ != kNoSocket) close_socket(socket_);
    socket_ = kNoSocket;
    for (int i = 0; i < 20 && !ending_; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

inline bool Receiver::connect() {
  addrinfo hints{};
  hints.ai_socktype = settings_.udp ? SOCK_DGRAM : SOCK_STREAM;
  addrinfo* list = nullptr;
  if (getaddrinfo(settings_.host.c_str(), settings_.port.c_str(), &hints, &list) != 0) return false;
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> owner(list,
                                                             [](addrinfo* a) { freeaddrinfo(a); });
  socket_ = socket(list->ai_family, list->ai_socktype, 0);
  if (socket_ == kNoSocket) return false;
  const int yes = 1, room = 1 << 20;
  if (!settings_.udp)
    setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, reinterpret_cast<const char*>(&yes), sizeof(yes));
  else
    setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, reinterpret_cast<const char*>(&room), sizeof(room));
  set_non_blocking(socket_);
  if (::connect(socket_, list->ai_addr, static_cast<socklen_t>(list->ai_addrlen)) != 0 &&
      !would_block())
    return false;
  if (settings_.udp) return true;
  fd_set ready;
  FD_ZERO(&ready);
  FD_SET(socket_, &ready);
  timeval limit{1, 0};
  int error = 0;
  socklen_t size = sizeof(error);
  return select(static_cast<int>(socket_) + 1, nullptr, &ready, nullptr, &limit) == 1 &&
         getsockopt(socket_, SOL_SOCKET, SO_ERROR, reinterpret_cast<char*>(&error), &size) == 0 &&
         error == 0;
}

/// Receives until the connection ends, or no message has arrived for a second.
inline void Receiver::session() {
  in_.clear();
  token_ = 0;
  requested_ = 0;
  requests_ = 0;
  const Ns begin = now_ns();
  bool connected = true;
  while (!ending_ && connected) {
    const Ns now = now_ns();
    const Ns heard = std::max(begin, heard_);
    if (!renew(now) || now - heard > 1000 * kMs) return;
    fd_set ready;
    FD_ZERO(&ready);
    FD_SET(socket_, &ready);
    timeval limit{0, 5000};
    if (select(static_cast<int>(socket_) + 1, &ready, nullptr, nullptr, &limit) == 1)
      connected = receive();
  }
  if (!ending_) return;
  std::uint8_t body[8] = {};
  put(body, token_, 4);
  send(kBye, body, sizeof(body));
}

/// Renews the subscription and requests the time, if they are due; false on failure.
inline bool Receiver::renew(Ns now) {
  // often at first, until the subscription is confirmed and the clock offset is known
  if (requests_ > 0 && now - requested_ < (requests_ < 10 ? 20 : 250) * kMs) return true;
  requested_ = now;
  bool sent = true;
  if (requests_ == 0 || settings_.udp) {
    std::uint8_t body[72] = {};
    put(body, token_, 4);
    body[4] = 1;  // samples
    body[5] = static_cast<std::uint8_t>(settings_.foci);
    put(body + 6, static_cast<std::uint64_t>(settings_.every), 2);
    body[8] = settings_.shared ? 1 : 0;
    sent = send(kSubscribe, body, sizeof(body));
  }
  ++requests_;
  if (!subscribed_) return sent;
  std::uint8_t body[8];
  put(body, static_cast<std::uint64_t>(now_ns()), 8);
  return sent && send(kTimeRequest, body, sizeof(body));
}

inline bool Receiver::send(Kind kind, const std::uint8_t* body, std::size_t size) {
  std::uint8_t message[kHeader + 72] = {'P', 'S', 'T', 'M', 1, kind};
  put(message + 6, size, 2);
  put(message + 8, session_, 4);
  put(message + 12, sequence_++, 4);
  std::memcpy(message + kHeader, body, size);
  const auto sent = ::send(socket_, reinterpret_cast<const char*>(message),
                           static_cast<int>(kHeader + size), kSendFlags);
  return sent >= 0 ? static_cast<std::size_t>(sent) == kHeader + size : would_block();
}

/// Reads the data that have arrived; false at the end of the connection.
inline bool Receiver::receive() {
  std::uint8_t bytes[1 << 16];
  for (int i = 0; i < kReadsAtOnce; ++i) {
    const auto got = recv(socket_, reinterpret_cast<char*>(bytes), sizeof(bytes), 0);
    if (got < 0) return would_block();
    if (got == 0 && !settings_.udp) return false;
    if (settings_.udp) in_.clear();  // a datagram is a message
    in_.insert(in_.end(), bytes, bytes + got);
    std::size_t begin = 0;
    while (in_.size() - begin >= kHeader) {
      const std::uint8_t* message = in_.data() + begin;
      const std::size_t size = get<std::uint16_t>(message + 6);
      if (std::memcmp(message, "PSTM\1", 5) != 0) {
        const std::lock_guard<std::mutex> lock(mutex_);
        ++count_.malformed;
        if (!settings_.udp) return false;
        break;
      }
      if (in_.size() - begin < kHeader + size) break;
      if (!take(message, size)) return false;
      begin += kHeader + size;
    }
    in_.erase(in_.begin(), in_.begin() + static_cast<std::ptrdiff_t>(begin));
  }
  return true;
}

/// Processes a complete message; false if it ends the subscription.
inline bool Receiver::take(const std::uint8_t* message, std::size_t size) {
  const std::uint8_t* body = message + kHeader;
  const auto text = [&](std::size_t at) {
    return std::string(reinterpret_cast<const char*>(body) + std::min(at, size),
                       size - std::min(at, size));
  };
  std::string event;
  bool connected = true;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto session = get<std::uint32_t>(message + 8);
    if (session != session_) reset();
    session_ = session;
    heard_ = now_ns();
    switch (message[5]) {
      case kHello:
        if (size >= 72) take_hello(body);
        break;
      case kBlock:
        take_block(body, size);
        break;
      case kState:
        if (size < 16) break;
        stopped_ = body[2] == 0;
        event = std::string(body[2] == 0   ? "stopped. "
                            : body[2] == 1 ? "silent. "
                                           : "playing. ") +
                text(16);
        break;
      case kHeartbeat:
        if (size >= 24) stopped_ = body[16] == 0;
        break;
      case kTime:
        if (size >= 24) take_time(body);
        break;
      case kEnd:
      case kError:
        subscribed_ = connected = false;
        event = (message[5] == kEnd ? "end: " : "error: ") + text(4);
        break;
      default:
        break;  // a message of a later version
    }
  }
  if (!event.empty()) report(event);
  return connected;
}

inline void Receiver::take_hello(const std::uint8_t* body) {
  token_ = get<std::uint32_t>(body);
  if (body[4] != 1 || subscribed_) return;
  subscribed_ = true;
  ++count_.subscriptions;
  const auto rate = get<double>(body + 16);
  if (rate >= 1.0 && rate <= 1e6) rate_ = rate;
  if (!has_offset_)
    offset_ = wanted_offset_ = static_cast<double>(get<std::int64_t>(body + 24) - now_ns());
}

inline void Receiver::take_block(const std::uint8_t* body, std::size_t size) {
  const std::size_t count = size >= 32 ? get<std::uint16_t>(body + 16) : 0;
  const std::size_t foci = size >= 32 ? body[20] : 0;
  const auto every = get<std::uint16_t>(body + 18);
  if (foci < 1 || foci > kMostFoci || size != 32 + count * foci * 16 || every != settings_.every) {
    ++count_.malformed;
    return;
  }
  const auto first = get<std::int64_t>(body);
  const Ns time = get<std::int64_t>(body + 8);
  if (first < 0) return;
  count_.skipped = get<std::int64_t>(body + 24);
  const double period = 1e9 / rate_ * every;
  const Ns here = heard_ + static_cast<Ns>(offset_);
  // the stream restarts, or resumes after a gap longer than the buffer
  if (newest_ < 0 || first - newest_ > kRing * every / 2) played_ = newest_ = first - every;
  const std::uint8_t* at = body + 32;
  for (std::size_t i = 0; i < count; ++i) {
    Sample sample;
    sample.index = first + static_cast<std::int64_t>(i) * every;
    sample.time = time + std::llround(static_cast<double>(i) * period);
    sample.foci = static_cast<int>(foci);
    bool good = true;
    for (std::size_t f = 0; f < foci; ++f, at += 16) {
      Focus& focus = sample.focus[f];
      focus = {get<float>(at), get<float>(at + 4), get<float>(at + 8), get<float>(at + 12)};
      good = good && std::isfinite(focus.x) && std::isfinite(focus.y) && std::isfinite(focus.z) &&
             focus.intensity >= 0.0F && focus.intensity <= 1.0F;
    }
    ++count_.samples;
    if (!good) {
      ++count_.malformed;
      rejected_ = std::max(rejected_, sample.index);
    }
    if (sample.time < here) ++count_.late;
    if (!good || sample.index <= played_) continue;
    slot(sample.index) = sample;
    newest_ = std::max(newest_, sample.index);
    if (on_sample) on_sample(sample);
  }
}

/// Uses the exchange with the shortest round trip of the last seconds: its error is the smallest.
inline void Receiver::take_time(const std::uint8_t* body) {
  const Ns asked = get<std::int64_t>(body), received = get<std::int64_t>(body + 8),
           sent = get<std::int64_t>(body + 16);
  const Ns trip = (heard_ - asked) - (sent - received);
  if (trip < 0 || trip > 1000 * kMs) return;
  count_.round_trip_ms = static_cast<double>(trip) / 1e6;
  if (has_offset_ && trip > best_trip_ && heard_ - best_at_ < 3000 * kMs) return;
  best_trip_ = trip;
  best_at_ = heard_;
  wanted_offset_ = 0.5 * static_cast<double>((received - asked) + (sent - heard_));
  if (!has_offset_) offset_ = wanted_offset_;
  has_offset_ = true;
}

/// Resets the state after a restart of prostm, which has a new clock and new sample indices.
inline void Receiver::reset() {
  newest_ = played_ = rejected_ = -1;
  has_offset_ = subscribed_ = stopped_ = false;
  for (Sample& sample : ring_) sample.index = -1;
}

}  // namespace prostm_receiver
