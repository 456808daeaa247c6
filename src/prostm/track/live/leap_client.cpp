#include "prostm/track/live/leap_client.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <boost/asio/connect.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <mutex>
#include <optional>
#include <thread>

#include "prostm/core/input_error.hpp"
#include "prostm/core/spsc_ring.hpp"
#include "prostm/core/stage_timer.hpp"
#include "prostm/track/live/leap_frame.hpp"

namespace prostm {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;
using asio::ip::tcp;
using boost::system::error_code;
using std::chrono::milliseconds;

constexpr milliseconds kFirstRetry{50}, kLastRetry{1000}, kConnectTime{1000}, kSilence{2000};
constexpr std::size_t kMaxMessage = std::size_t{256} << 10;  // a frame of two hands has 12 kB
constexpr std::size_t kFramesKept = 128;

// The bridge compares these character by character, in a buffer of 32 characters.
constexpr std::array<std::string_view, 3> kRequests = {
    R"({"background":true})", R"({"focused":true})", R"({"optimizeHMD":false})"};

enum class Link : std::uint8_t { Connecting, Absent, Foreign, Lost, Connected };

/// Resolves a host's name.
std::vector<tcp::endpoint> endpoints_of(const HostPort& address, asio::io_context& io) {
  error_code error;
  const asio::ip::address numeric = asio::ip::make_address(address.host, error);
  if (!error) return {{numeric, address.port}};
  tcp::resolver resolver(io);
  const auto found = resolver.resolve(address.host, std::to_string(address.port), error);
  if (error) {
    throw InputError(
        fmt::format("leap://{}: the host {} is unknown; the service is "
                    "usually at leap://127.0.0.1:6437",
                    address.text(), address.host));
  }
  std::vector<tcp::endpoint> endpoints;
  for (const auto& entry : found) endpoints.push_back(entry.endpoint());
  return endpoints;
}

class LeapTracker final : public LiveTracker {
 public:
  explicit LeapTracker(const HostPort& address)
      : name_("leap://" + address.text()),
        host_(address.text()),
        endpoints_(endpoints_of(address, io_)),
        retry_(io_),
        thread_([this] { run(); }) {}

  ~LeapTracker() override {
    io_.stop();
    thread_.join();
  }

  bool next(HandFrame& frame) override { return ring_.pop(frame); }
  bool connected() const noexcept override {
    return link_.load(std::memory_order_relaxed) == Link::Connected;
  }

  /// Whether an attempt to connect has failed, or frames are arriving.
  bool is_settled() const noexcept {
    const Link link = link_.load(std::memory_order_relaxed);
    if (link == Link::Connected) return frames_.load(std::memory_order_relaxed) > 0;
    return link != Link::Connecting;
  }

  TrackerStatus status() const override {
    TrackerStatus status;
    const Link link = link_.load(std::memory_order_relaxed);
    status.connected = link == Link::Connected;
    status.frames = frames_.load(std::memory_order_relaxed);
    status.repeated = repeated_.load(std::memory_order_relaxed);
    status.reconnects = std::max<std::int64_t>(connections_.load(std::memory_order_relaxed) - 1, 0);
    status.sentence = sentence(link);
    {
      const std::lock_guard lock(faults_mutex_);
      add_faults(faults_, status);
    }
    if (status.repeated > 0) {
      status.sentence += fmt::format("; {} frames were ignored: their time stamp was seen before",
                                     status.repeated);
    }
    return status;
  }

 private:
  std::string sentence(Link link) const {
    switch (link) {
      case Link::Connecting:
        return "connecting to " + name_;
      case Link::Absent:
        return "nothing answers at " + name_ + "; " + std::string(leap_needs());
      case Link::Foreign:
        return "the program that answers at " + name_ + " does not serve /v6.json; " +
               std::string(leap_needs());
      case Link::Lost:
        return "the connection to " + name_ + " was lost; trying again";
      case Link::Connected:
        break;
    }
    return "connected to " + name_;
  }

  // ---- the tracker's thread: one operation at a time, each of which starts the next ----

  void run() {
    connect();
    io_.run();
  }

  void connect() {
    socket_.emplace(io_);
    auto& stream = beast::get_lowest_layer(*socket_);
    stream.expires_after(kConnectTime);
    stream.async_connect(endpoints_, [this](error_code error, const tcp::endpoint&) {
      if (error) return try_again(Link::Absent);
      shake_hands();
    });
  }

  void shake_hands() {
    error_code ignored;
    beast::get_lowest_layer(*socket_).socket().set_option(tcp::no_delay(true), ignored);
    beast::get_lowest_layer(*socket_).expires_never();
    socket_->set_option(websocket::stream_base::timeout{kConnectTime, kSilence, true});
    socket_->read_message_max(kMaxMessage);
    socket_->async_handshake(host_, "/v6.json", [this](error_code error) {
      if (error) return try_again(Link::Foreign);
      link_.store(Link::Connected, std::memory_order_relaxed);
      connections_.fetch_add(1, std::memory_order_relaxed);
      clock_.reset();
      request(0);
    });
  }

  void request(std::size_t i) {
    if (i == kRequests.size()) return read();
    socket_->text(true);
    socket_->async_write(asio::buffer(kRequests[i]), [this, i](error_code error, std::size_t) {
      if (error) return try_again(Link::Lost);
      request(i + 1);
    });
  }

  void read() {
    buffer_.clear();
    socket_->async_read(buffer_, [this](error_code error, std::size_t) {
      if (error) return try_again(Link::Lost);
      take(steady_now());
      read();
    });
  }

  void take(double arrival) {
    const auto bytes = buffer_.cdata();
    const std::string_view text(static_cast<const char*>(bytes.data()), bytes.size());
    HandFaults faults;
    const LeapMessage kind = leap_message(text, frame_, faults);
    if (kind == LeapMessage::Other) return;
    frames_.fetch_add(1, std::memory_order_relaxed);
    if (faults.any()) {
      const std::lock_guard lock(faults_mutex_);
      faults_.add(faults);
    }
    if (kind == LeapMessage::Refused) return;
    wait_ = kFirstRetry;
    const std::optional<double> time = clock_.time_of(frame_.time, arrival);
    if (!time) {
      repeated_.fetch_add(1, std::memory_order_relaxed);
      return;
    }
    frame_.time = *time;
    ring_.push(frame_);
  }

  void try_again(Link why) {
    link_.store(why, std::memory_order_relaxed);
    socket_.reset();
    retry_.expires_after(wait_);
    wait_ = std::min(2 * wait_, kLastRetry);
    retry_.async_wait([this](error_code error) {
      if (!error) connect();
    });
  }

  const std::string name_, host_;
  asio::io_context io_{1};
  const std::vector<tcp::endpoint> endpoints_;

  // used by the tracker's thread only
  std::optional<websocket::stream<beast::tcp_stream, false>> socket_;  // no compression
  asio::steady_timer retry_;
  beast::flat_buffer buffer_;
  milliseconds wait_ = kFirstRetry;
  StampClock clock_;
  HandFrame frame_;

  SpscRing<HandFrame> ring_{kFramesKept};
  std::atomic<Link> link_{Link::Connecting};
  std::atomic<std::int64_t> frames_{0}, repeated_{0}, connections_{0};
  mutable std::mutex faults_mutex_;  // planner and emitter never wait for it
  HandFaults faults_;

  std::thread thread_;  // constructed last: it uses all of the above
};

}  // namespace

std::string_view leap_needs() {
  return "a Leap Motion service up to version 4 must run there, or Ultraleap's tracking service "
         "with its bridge UltraleapTrackingWebSocket, usually at port 6437";
}

HostPort leap_address(const std::string& text) {
  return host_port(text, "leap", 6437);
}

std::unique_ptr<LiveTracker> make_leap_tracker(const HostPort& address) {
  return std::make_unique<LeapTracker>(address);
}

TrackerFinding look_for_leap(const HostPort& address, double seconds) {
  const LeapTracker tracker(address);
  const double end = steady_now() + seconds;
  while (!tracker.is_settled() && steady_now() < end) std::this_thread::sleep_for(milliseconds(5));
  const TrackerStatus status = tracker.status();
  if (!status.connected) {
    if (tracker.is_settled()) return {false, status.sentence};
    return {false, fmt::format("nothing answered at leap://{} within {:g} s; {}, and a firewall "
                               "must let it in",
                               address.text(), seconds, leap_needs())};
  }
  if (status.frames > 0) return {true, status.sentence + ", and frames come in"};
  return {true, status.sentence + ", but no frame came in " + fmt::format("{:g} s", seconds) +
                    ": is the tracker plugged in?"};
}

}  // namespace prostm
