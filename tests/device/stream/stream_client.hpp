#pragma once
/// A subscriber to prostm-stream/1 for tests. It decodes by the tables of docs/devices/stream.md,
/// without using the device's own code.

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

namespace prostm::test {

enum class Over { Tcp, Udp };

/// A number at an offset of a message's body, in wire format.
template <class T>
T number_at(const std::vector<std::uint8_t>& bytes, std::size_t at) {
  T value{};
  std::memcpy(&value, &bytes.at(at + sizeof(T) - 1) - (sizeof(T) - 1), sizeof(T));
  return value;
}

struct StreamMessage {
  int kind = 0;
  std::uint32_t session = 0, sequence = 0;
  std::vector<std::uint8_t> body;

  template <class T>
  T at(std::size_t place) const {
    return number_at<T>(body, place);
  }
  std::string text(std::size_t place) const {
    return {body.begin() + static_cast<std::ptrdiff_t>(place), body.end()};
  }
};

struct StreamWish {
  int want = 1, foci = 0, stride = 1, flags = 0;
};

class StreamClient {
 public:
  StreamClient(Over over, std::uint16_t port, int receive_buffer = 0) : over_(over) {
    fd_ = socket(AF_INET, over == Over::Tcp ? SOCK_STREAM : SOCK_DGRAM, 0);
    if (receive_buffer > 0)
      setsockopt(fd_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof(receive_buffer));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    connected = connect(fd_, reinterpret_cast<sockaddr*>(&address), sizeof(address)) == 0;
  }
  ~StreamClient() { ::close(fd_); }
  StreamClient(const StreamClient&) = delete;
  StreamClient& operator=(const StreamClient&) = delete;

  bool connected = false;
  bool ended = false;  ///< the server has closed the connection
  bool renews = true;  ///< next() keeps the subscription
  std::uint32_t token = 0;

  static std::vector<std::uint8_t> message(int kind, const std::vector<std::uint8_t>& body) {
    std::vector<std::uint8_t> out(16 + body.size());
    const std::uint8_t header[] = {'P',
                                   'S',
                                   'T',
                                   'M',
                                   1,
                                   static_cast<std::uint8_t>(kind),
                                   static_cast<std::uint8_t>(body.size() & 0xFFU),
                                   static_cast<std::uint8_t>(body.size() >> 8U)};
    std::copy(std::begin(header), std::end(header), out.begin());
    std::copy(body.begin(), body.end(), out.begin() + 16);
    return out;
  }
  std::vector<std::uint8_t> subscribe_message(const StreamWish& wish) const {
    std::vector<std::uint8_t> body(72);
    std::memcpy(body.data(), &token, 4);
    body[4] = static_cast<std::uint8_t>(wish.want);
    body[5] = static_cast<std::uint8_t>(wish.foci);
    body[6] = static_cast<std::uint8_t>(wish.stride & 0xFF);
    body[7] = static_cast<std::uint8_t>(wish.stride >> 8);
    body[8] = static_cast<std::uint8_t>(wish.flags);
    return message(1, body);
  }
  void send(const std::vector<std::uint8_t>& bytes) const {
    [[maybe_unused]] const auto sent = ::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  }
  void ask_time(std::int64_t number) const {
    std::vector<std::uint8_t> body(8);
    std::memcpy(body.data(), &number, 8);
    send(message(2, body));
  }

  /// Subscribes; returns HELLO, or the message that arrived instead.
  std::optional<StreamMessage> subscribe(const StreamWish& wish = {}) {
    wish_ = wish;
    renewed_ = std::chrono::steady_clock::now();
    send(subscribe_message(wish));
    auto hello = next();
    if (over_ == Over::Tcp || !hello || hello->kind != 16) return hello;
    token = hello->at<std::uint32_t>(0);
    if (hello->body.at(4) == 1) return hello;
    send(subscribe_message(wish));
    return next();
  }

  /// The next message; empty after a time-out that only a failure reaches, or at the end.
  std::optional<StreamMessage> next(int wait_ms = 10'000) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(wait_ms);
    for (;;) {
      if (auto message = take()) return message;
      renew();
      const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
          end - std::chrono::steady_clock::now());
      pollfd polled{fd_, POLLIN, 0};
      if (ended || left.count() <= 0 || poll(&polled, 1, static_cast<int>(left.count())) <= 0)
        return {};
      std::uint8_t bytes[1 << 16];
      const auto got = recv(fd_, bytes, sizeof(bytes), 0);
      if (got <= 0) {
        ended = true;
        continue;
      }
      if (over_ == Over::Udp) in_.clear();
      in_.insert(in_.end(), bytes, bytes + got);
    }
  }
  /// The next message of a kind. Others are skipped, for at most the time-out of next().
  std::optional<StreamMessage> next_of(int kind) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (std::chrono::steady_clock::now() < end) {
      auto message = next();
      if (!message || message->kind == kind) return message;
    }
    return {};
  }
  /// Reads for this long, so that heartbeats do not fill the socket and displace later messages.
  /// @return whether it was never held up for so long that its subscription may have expired.
  bool pass_over(std::chrono::milliseconds time) {
    const auto end = std::chrono::steady_clock::now() + time;
    bool kept = true;
    for (auto last = std::chrono::steady_clock::now();;) {
      const auto now = std::chrono::steady_clock::now();
      kept = kept && now - last < std::chrono::milliseconds(700);
      last = now;
      const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - now);
      if (left.count() <= 0) return kept;
      next(static_cast<int>(left.count()));
    }
  }

 private:
  void renew() {
    const auto now = std::chrono::steady_clock::now();
    if (!wish_ || !renews || now - renewed_ < std::chrono::milliseconds(200)) return;
    renewed_ = now;
    if (over_ == Over::Tcp) {
      ask_time(0);
    } else {
      send(subscribe_message(*wish_));
    }
  }
  std::optional<StreamMessage> take() {
    if (in_.size() < 16) return {};
    const std::size_t size = 16U + number_at<std::uint16_t>(in_, 6);
    if (std::memcmp(in_.data(), "PSTM\1", 5) != 0 || in_.size() < size) return {};
    StreamMessage message{in_[5],
                          number_at<std::uint32_t>(in_, 8),
                          number_at<std::uint32_t>(in_, 12),
                          {in_.begin() + 16, in_.begin() + static_cast<std::ptrdiff_t>(size)}};
    in_.erase(in_.begin(), in_.begin() + static_cast<std::ptrdiff_t>(size));
    return message;
  }

  const Over over_;
  std::optional<StreamWish> wish_;  // set once subscribed
  std::chrono::steady_clock::time_point renewed_{};
  int fd_;
  std::vector<std::uint8_t> in_;
};

}  // namespace prostm::test
