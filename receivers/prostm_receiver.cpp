// A receiver of prostm-stream/1 (docs/stream.md) in one file, without dependencies: C++17, on Linux
// and on Windows.
//
//   c++ -std=c++17 -O2 -pthread prostm_receiver.cpp -o prostm_receiver
//   x86_64-w64-mingw32-g++ -std=c++17 -O2 -static prostm_receiver.cpp -o prostm_receiver.exe
//   -lws2_32
//
// The class Receiver keeps the connection on a thread of its own and answers one question: what do
// the focal points do at this time? It falls silent by itself when the stream stops. To drive an
// array, put its library's call into play() near the end, or call Receiver::at() in the callback
// in which the library asks for focal points. main() prints statistics and writes samples to files.

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
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
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
void close_socket(Socket s) {
  closesocket(s);
}
bool would_block() {
  const int e = WSAGetLastError();
  return e == WSAEWOULDBLOCK || e == WSAECONNRESET || e == WSAEMSGSIZE;
}
void do_not_wait(Socket s) {
  u_long yes = 1;
  ioctlsocket(s, FIONBIO, &yes);
}
const int kSendFlags = 0;
#else
using Socket = int;
const Socket kNoSocket = -1;
void close_socket(Socket s) {
  close(s);
}
bool would_block() {
  return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR || errno == EINPROGRESS ||
         errno == ECONNREFUSED;
}
void do_not_wait(Socket s) {
  fcntl(s, F_SETFL, O_NONBLOCK);
}
const int kSendFlags = MSG_NOSIGNAL;
#endif

using Ns = std::int64_t;  // nanoseconds
constexpr Ns kMs = 1'000'000;

/// Time of this machine's steady clock.
Ns now_ns() {
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
void put(std::uint8_t* to, std::uint64_t value, std::size_t bytes) {
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
constexpr int kReadsAtOnce = 64;  // then it is looked whether the subscription must be renewed

struct Focus {
  float x = 0, y = 0, z = 0;  ///< [m], from the array's centre, z away from it
  float intensity = 0;        ///< 0..1, linear in acoustic pressure amplitude
};
struct Sample {
  std::int64_t index = -1;
  Ns time = 0;  ///< when it plays, by prostm's clock
  int foci = 0;
  std::array<Focus, kMostFoci> focus;
};

struct Settings {
  std::string host = "127.0.0.1", port = "7140";
  bool udp = false;
  int foci = 0;                 ///< the first so many focal points; 0: all
  int every = 1;                ///< every so many samples
  bool shared = false;          ///< one intensity for all focal points of a sample
  Ns silence_after = 20 * kMs;  ///< without a message, the output falls silent
  Ns ramp = 5 * kMs;            ///< in this time
};

struct Statistics {
  std::int64_t samples = 0;    ///< received
  std::int64_t lost = 0;       ///< not there at their play time
  std::int64_t late = 0;       ///< came after their play time
  std::int64_t skipped = 0;    ///< left out by prostm, because this side read too slowly
  std::int64_t silences = 0;   ///< times when sound was ramped down because the stream stopped
  std::int64_t malformed = 0;  ///< messages or samples that broke the protocol
  std::int64_t subscriptions = 0;
  double round_trip_ms = 0, offset_ms = 0, buffered_ms = 0;
  std::int64_t last_heard = 0;  ///< [ns]
};

class Receiver {
 public:
  /// Called on the receiver's thread with every sample, and with sentences about the connection.
  /// on_sample must be quick: at() waits for it.
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

  /// The focal points at a time of this machine's steady clock, with the silence rule applied.
  /// Times must rise from call to call. @return the factor in the intensities: 1 while all is well.
  float at(Ns time, Sample& out);
  Statistics statistics() const;

 private:
  static constexpr std::int64_t kRing = 1 << 14;  // samples: 0.4 s at 40 kHz

  void run();
  bool connect();
  void session();
  bool ask(Ns now);
  bool send(Kind kind, const std::uint8_t* body, std::size_t size);
  bool receive();
  bool take(const std::uint8_t* message, std::size_t size);
  void take_hello(const std::uint8_t* body);
  void take_block(const std::uint8_t* body, std::size_t size);
  void take_time(const std::uint8_t* body);
  void forget();
  void say(const std::string& sentence) {
    if (on_event) on_event(sentence);
  }
  Sample& slot(std::int64_t index) {
    return ring_[static_cast<std::size_t>((index / settings_.every) % kRing)];
  }

  const Settings settings_;
  std::thread thread_;
  std::atomic<bool> ending_{false};

  // of the receiver's thread
  Socket socket_ = kNoSocket;
  std::vector<std::uint8_t> in_;
  std::uint32_t token_ = 0, session_ = 0, sequence_ = 0;
  Ns asked_ = 0;
  int asks_ = 0;

  mutable std::mutex mutex_;  // guards what follows
  Statistics count_;
  std::vector<Sample> ring_;  // sample i lies at (i / every) mod kRing
  bool subscribed_ = false, stopped_ = false;
  double rate_ = 40e3;  // [Hz]
  std::int64_t newest_ = -1, played_ = -1;
  Ns heard_ = 0, best_trip_ = 0, best_at_ = 0;
  double wanted_offset_ = 0, offset_ = 0;  // prostm's clock less this machine's [ns]
  bool has_offset_ = false;
  Sample held_;
  float gain_ = 0;
  bool falling_ = true;
  Ns last_at_ = 0;
};

float Receiver::at(Ns time, Sample& out) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const Ns step = last_at_ == 0 ? 0 : std::max<Ns>(0, time - last_at_);
  last_at_ = time;
  // while it sounds, the clocks' difference is followed slowly, so that no sample is jumped over
  const double change = gain_ == 0.0F ? 1e18 : 1e-3 * static_cast<double>(step);
  offset_ += std::min(change, std::max(-change, wanted_offset_ - offset_));
  const Ns at = time + static_cast<Ns>(offset_);

  // on to the last sample whose time has come
  const Ns period = static_cast<Ns>(1e9 / rate_) * settings_.every;
  bool gap = false;
  for (std::int64_t next = played_ + settings_.every; next <= newest_; next += settings_.every) {
    const Sample& sample = slot(next);
    if (sample.index != next) continue;  // lost, or not here yet
    if (sample.time > at) break;
    const std::int64_t missing = (next - played_) / settings_.every - 1;
    gap = gap || missing > 0;
    count_.lost += missing;
    played_ = next;
  }
  const Sample* sample = played_ >= 0 ? &slot(played_) : nullptr;
  const bool here = sample != nullptr && sample->index == played_ && at >= sample->time &&
                    at < sample->time + period + period / 2;
  const bool fresh = std::max(time, now_ns()) - heard_ <= settings_.silence_after;
  const bool stalled = step > settings_.ramp && step > 2 * period;  // the caller was away
  const bool good = here && fresh && !stalled && subscribed_ && !stopped_;

  // the silence rule: after any interruption down to 0 where the focal points are, and up again
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
  if (!falling_) held_ = *sample;
  out = held_;
  for (Focus& focus : out.focus) focus.intensity *= gain_;
  return gain_;
}

Statistics Receiver::statistics() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  Statistics s = count_;
  s.offset_ms = offset_ / 1e6;
  s.buffered_ms = static_cast<double>(newest_ - played_) / rate_ * 1e3;
  s.last_heard = heard_;
  return s;
}

void Receiver::run() {
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

bool Receiver::connect() {
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
  do_not_wait(socket_);
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

/// Receives until the connection ends, or nothing was heard for a second.
void Receiver::session() {
  in_.clear();
  token_ = 0;
  asked_ = 0;
  asks_ = 0;
  const Ns begin = now_ns();
  bool goes_on = true;
  while (!ending_ && goes_on) {
    const Ns now = now_ns();
    const Ns heard = std::max(begin, heard_);
    if (!ask(now) || now - heard > 1000 * kMs) return;
    fd_set ready;
    FD_ZERO(&ready);
    FD_SET(socket_, &ready);
    timeval limit{0, 5000};
    if (select(static_cast<int>(socket_) + 1, &ready, nullptr, nullptr, &limit) == 1)
      goes_on = receive();
  }
  if (!ending_) return;
  std::uint8_t body[8] = {};
  put(body, token_, 4);
  send(kBye, body, sizeof(body));
}

/// Renews the subscription and asks for the time, when it is time to; false if that fails.
bool Receiver::ask(Ns now) {
  // often at first, until the subscription stands and the clocks' difference is known
  if (asks_ > 0 && now - asked_ < (asks_ < 10 ? 20 : 250) * kMs) return true;
  asked_ = now;
  bool sent = true;
  if (asks_ == 0 || settings_.udp) {
    std::uint8_t body[72] = {};
    put(body, token_, 4);
    body[4] = 1;  // samples
    body[5] = static_cast<std::uint8_t>(settings_.foci);
    put(body + 6, static_cast<std::uint64_t>(settings_.every), 2);
    body[8] = settings_.shared ? 1 : 0;
    sent = send(kSubscribe, body, sizeof(body));
  }
  ++asks_;
  if (!subscribed_) return sent;
  std::uint8_t body[8];
  put(body, static_cast<std::uint64_t>(now_ns()), 8);
  return sent && send(kTimeRequest, body, sizeof(body));
}

bool Receiver::send(Kind kind, const std::uint8_t* body, std::size_t size) {
  std::uint8_t message[kHeader + 72] = {'P', 'S', 'T', 'M', 1, kind};
  put(message + 6, size, 2);
  put(message + 8, session_, 4);
  put(message + 12, sequence_++, 4);
  std::memcpy(message + kHeader, body, size);
  const auto sent = ::send(socket_, reinterpret_cast<const char*>(message),
                           static_cast<int>(kHeader + size), kSendFlags);
  return sent >= 0 ? static_cast<std::size_t>(sent) == kHeader + size : would_block();
}

/// Reads what has arrived; false at the end of the connection.
bool Receiver::receive() {
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

/// Takes a whole message; false if it ends the subscription.
bool Receiver::take(const std::uint8_t* message, std::size_t size) {
  const std::uint8_t* body = message + kHeader;
  const auto text = [&](std::size_t at) {
    return std::string(reinterpret_cast<const char*>(body) + std::min(at, size),
                       size - std::min(at, size));
  };
  std::string event;
  bool goes_on = true;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto session = get<std::uint32_t>(message + 8);
    if (session != session_) forget();
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
        subscribed_ = goes_on = false;
        event = (message[5] == kEnd ? "end: " : "error: ") + text(4);
        break;
      default:
        break;  // a later version's message
    }
  }
  if (!event.empty()) say(event);
  return goes_on;
}

void Receiver::take_hello(const std::uint8_t* body) {
  token_ = get<std::uint32_t>(body);
  if (body[4] != 1 || subscribed_) return;
  subscribed_ = true;
  ++count_.subscriptions;
  const auto rate = get<double>(body + 16);
  if (rate >= 1.0 && rate <= 1e6) rate_ = rate;
  if (!has_offset_)
    offset_ = wanted_offset_ = static_cast<double>(get<std::int64_t>(body + 24) - now_ns());
}

void Receiver::take_block(const std::uint8_t* body, std::size_t size) {
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
  // samples of a stream that starts anew, or goes on after a pause longer than the buffer
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
    if (!good) ++count_.malformed;
    if (sample.time < here) ++count_.late;
    if (!good || sample.index <= played_) continue;
    slot(sample.index) = sample;
    newest_ = std::max(newest_, sample.index);
    if (on_sample) on_sample(sample);
  }
}

/// Prefers the exchanges with the shortest way of the last seconds, whose error is the smallest.
void Receiver::take_time(const std::uint8_t* body) {
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

/// prostm has started anew: its clock and its samples are others.
void Receiver::forget() {
  newest_ = played_ = -1;
  has_offset_ = subscribed_ = stopped_ = false;
  for (Sample& sample : ring_) sample.index = -1;
}

/// Writes rows: as CSV, or for any other name as i64, i64, i32, f32 and four f32 per focal point.
class SampleFile {
 public:
  explicit SampleFile(const std::string& name, const char* first_column)
      : csv_(name.size() > 4 && name.substr(name.size() - 4) == ".csv"),
        file_(name.empty() ? nullptr : std::fopen(name.c_str(), "wb")) {
    if (!name.empty() && file_ == nullptr) {
      std::fprintf(stderr, "cannot write %s\n", name.c_str());
      std::exit(2);
    }
    if (file_ != nullptr && csv_)
      std::fprintf(file_, "%s,time_ns,foci,gain,x_m,y_m,z_m,intensity,...\n", first_column);
  }
  ~SampleFile() {
    if (file_ != nullptr) std::fclose(file_);
  }
  void row(std::int64_t first, const Sample& s, float gain) {
    if (file_ == nullptr) return;
    const auto foci = static_cast<std::size_t>(s.foci);
    if (csv_) {
      std::fprintf(file_, "%lld,%lld,%d,%g", static_cast<long long>(first),
                   static_cast<long long>(s.time), s.foci, static_cast<double>(gain));
      for (std::size_t f = 0; f < foci; ++f)
        std::fprintf(file_, ",%.9g,%.9g,%.9g,%.9g", static_cast<double>(s.focus[f].x),
                     static_cast<double>(s.focus[f].y), static_cast<double>(s.focus[f].z),
                     static_cast<double>(s.focus[f].intensity));
      std::fputc('\n', file_);
      return;
    }
    const std::int32_t n = s.foci;
    std::fwrite(&first, 8, 1, file_);
    std::fwrite(&s.time, 8, 1, file_);
    std::fwrite(&n, 4, 1, file_);
    std::fwrite(&gain, 4, 1, file_);
    std::fwrite(s.focus.data(), sizeof(Focus), foci, file_);
  }

 private:
  const bool csv_;
  std::FILE* file_;
};

/// Gets the output of the array, sample by sample, at about the time when it should sound. This is
/// the place for the call of an array's library.
void play(const Sample& sample, Ns handed, float gain, SampleFile& file) {
  file.row(handed, sample, gain);
}

}  // namespace prostm_receiver

namespace {

using namespace prostm_receiver;

volatile std::sig_atomic_t interrupted = 0;

struct Options {
  Settings settings;
  double seconds = 1e9;
  std::string received, played;
};

[[noreturn]] void usage(const char* problem) {
  std::fprintf(stderr,
               "%s\nusage: prostm_receiver [ADDRESS:PORT] [--udp] [--foci N] [--every N] "
               "[--shared] [--silence-ms MS] [--seconds S] [--received FILE] [--played FILE]\n",
               problem);
  std::exit(2);
}

Options options_of(int argc, char** argv) {
  Options o;
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    const auto value = [&]() -> const char* {
      if (++i == argc) usage((name + " needs a value.").c_str());
      return argv[i];
    };
    const std::size_t colon = name.rfind(':');
    if (name == "--udp")
      o.settings.udp = true;
    else if (name == "--shared")
      o.settings.shared = true;
    else if (name == "--foci")
      o.settings.foci = std::atoi(value());
    else if (name == "--every")
      o.settings.every = std::atoi(value());
    else if (name == "--silence-ms")
      o.settings.silence_after = static_cast<Ns>(std::atof(value()) * 1e6);
    else if (name == "--seconds")
      o.seconds = std::atof(value());
    else if (name == "--received")
      o.received = value();
    else if (name == "--played")
      o.played = value();
    else if (name[0] == '-' || colon == name.npos)
      usage((name + " is unknown.").c_str());
    else {
      o.settings.host = name.substr(0, colon);
      o.settings.port = name.substr(colon + 1);
      if (o.settings.host.size() > 2 && o.settings.host[0] == '[')  // IPv6
        o.settings.host = o.settings.host.substr(1, o.settings.host.size() - 2);
    }
  }
  if (o.settings.foci < 0 || o.settings.foci > kMostFoci) usage("--foci must be 0 to 8.");
  if (o.settings.every < 1 || o.settings.every > 1000) usage("--every must be 1 to 1000.");
  if (o.settings.silence_after < kMs || o.settings.silence_after > 100 * kMs)
    usage("--silence-ms must be 1 to 100.");
  return o;
}

void print(const Statistics& s) {
  std::printf(
      "{\"samples\": %lld, \"lost\": %lld, \"late\": %lld, \"skipped\": %lld, \"silences\": %lld, "
      "\"malformed\": %lld, \"subscriptions\": %lld, \"round_trip_ms\": %.3f, \"offset_ms\": %.3f, "
      "\"buffered_ms\": %.3f}\n",
      static_cast<long long>(s.samples), static_cast<long long>(s.lost),
      static_cast<long long>(s.late), static_cast<long long>(s.skipped),
      static_cast<long long>(s.silences), static_cast<long long>(s.malformed),
      static_cast<long long>(s.subscriptions), s.round_trip_ms, s.offset_ms, s.buffered_ms);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
#ifdef _WIN32
  WSADATA data;
  WSAStartup(MAKEWORD(2, 2), &data);
#endif
  const Options options = options_of(argc, argv);
  std::signal(SIGINT, [](int) { interrupted = 1; });
  std::signal(SIGTERM, [](int) { interrupted = 1; });

  SampleFile received(options.received, "index"), played(options.played, "handed_ns");
  Receiver receiver(options.settings);
  receiver.on_sample = [&](const Sample& sample) { received.row(sample.index, sample, 1.0F); };
  receiver.on_event = [](const std::string& sentence) {
    std::printf("%s\n", sentence.c_str());
    std::fflush(stdout);
  };
  receiver.start();

  // a library's callback would ask for times of its own; this asks for those that have come
  const Ns step = 25'000 * options.settings.every, begin = now_ns();
  Ns time = begin, next_line = begin + 1000 * kMs;
  bool sounds = false;
  while (interrupted == 0 && time - begin < static_cast<Ns>(options.seconds * 1e9)) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    const Ns now = now_ns();
    // after a sleep that was too long, the past is not played
    if (now - time > 20 * kMs) time = now - step;
    while (time + step <= now) {
      time += step;
      Sample sample;
      const float gain = receiver.at(time, sample);
      sample.time = time;
      if (sample.foci > 0) play(sample, now, gain, played);  // not before the first one came
      if (sounds && gain == 0.0F)
        std::printf("silent %.1f ms after the last message\n",
                    static_cast<double>(time - receiver.statistics().last_heard) / 1e6);
      sounds = gain > 0.0F;
    }
    if (now >= next_line) {
      print(receiver.statistics());
      next_line = now + 1000 * kMs;
    }
  }
  receiver.stop();
  print(receiver.statistics());
  return 0;
}
