#include "prostm/device/autd3/detail/link_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <thread>

#include "prostm/device/autd3/autd3_reply.hpp"

namespace prostm::autd3 {
namespace {

using Clock = std::chrono::steady_clock;

// -- the forked process: its parent has threads, so until _exit() it calls only functions that are
// async-signal-safe

constexpr int kReplyTime = 30, kSilenceTime = 50;  // [ms], after the owner has left
constexpr std::uint8_t kClear = 0x01;
constexpr int kMessages = 16;
constexpr std::size_t kMostRequest = 5 + kMostUnits * kFrameBytes;
constexpr std::size_t kTimeBytes = sizeof(std::int64_t);  // before each request

// used only in the forked process, which has its own copy
std::array<std::uint8_t, kMostRequest> request_buffer;
std::array<std::uint8_t, kMostReply> reply_buffer;

std::int64_t now_ns() {
  timespec time{};
  ::clock_gettime(CLOCK_MONOTONIC, &time);  // that of std::chrono::steady_clock
  return std::int64_t{1'000'000'000} * time.tv_sec + time.tv_nsec;
}

std::int64_t now_ms() {
  return now_ns() / 1'000'000;
}

bool should_retry() {
  return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
}

class Relay {
 public:
  Relay(int pipe, int server, std::size_t units) : pipe_(pipe), server_(server), units_(units) {}

  void run() {
    for (;;) {
      const std::size_t size = read_request();
      if (size == 0 || now_ns() > latest_) break;
      if (!ask(size)) return;
      if (!owner_left() && !write_all(pipe_, reply_buffer.data(), reply_size_)) leave();
      if (is_closed_) return;
      if (owner_left()) break;
    }
    leave();
    silence();
  }

 private:
  bool owner_left() const { return deadline_ != 0; }
  /// Records that the owner has left: from now on, waits are limited.
  void leave() {
    if (!owner_left()) deadline_ = now_ms() + kReplyTime;
  }
  bool is_late() const { return owner_left() && now_ms() >= deadline_; }

  /// Waits for a socket, and notices if the owner leaves. @return false on a timeout.
  bool wait(int socket, short events) {
    while (!is_late()) {
      std::array<pollfd, 2> waiting = {pollfd{socket, events, 0}, pollfd{pipe_, 0, 0}};
      const bool watches = socket != pipe_ && !owner_left();
      const int left = owner_left() ? static_cast<int>(deadline_ - now_ms()) : -1;
      const int ready =
          ::poll(waiting.data(), watches ? 2 : 1, owner_left() ? std::max(left, 0) : -1);
      if (ready < 0 && errno != EINTR) return false;
      if (ready <= 0) continue;
      if (watches && (waiting[1].revents & (POLLHUP | POLLERR)) != 0) leave();
      if (waiting[0].revents != 0) return true;
    }
    return false;
  }

  bool read_some(int socket, std::uint8_t* to, std::size_t size) {
    while (size > 0) {
      const ssize_t got = ::recv(socket, to, size, 0);
      if (got > 0) {
        to += got;
        size -= static_cast<std::size_t>(got);
      } else if (got == 0 || !should_retry() || !wait(socket, POLLIN)) {
        return false;
      }
    }
    return true;
  }

  bool write_all(int socket, const std::uint8_t* from, std::size_t size) {
    while (size > 0) {
      const ssize_t sent = ::send(socket, from, size, MSG_NOSIGNAL);
      if (sent > 0) {
        from += sent;
        size -= static_cast<std::size_t>(sent);
      } else if (!should_retry() || !wait(socket, POLLOUT)) {
        return false;
      }
    }
    return true;
  }

  /// Reads a whole request from the owner. @return its size; 0 if the owner has left.
  std::size_t read_request() {
    if (!read_some(pipe_, reinterpret_cast<std::uint8_t*>(&latest_), kTimeBytes)) return 0;
    std::size_t have = 0;
    for (;;) {
      const std::size_t known = request_bytes({request_buffer.data(), have}, units_);
      if (known > 0 && known <= have) return have;
      // the first byte alone, then enough bytes to know the size
      const std::size_t want = known > 0 ? known : have == 0 ? 1 : 5;
      if (want > request_buffer.size() || want <= have) return 0;
      if (!read_some(pipe_, request_buffer.data() + have, want - have)) return 0;
      have = want;
    }
  }

  /// Forwards the request in the buffer, and reads the reply. @return false if the connection to
  /// the server is lost.
  bool ask(std::size_t size) {
    const auto request = static_cast<Request>(request_buffer[0]);
    if (request == Request::Send) message_ = request_buffer[1];
    if (!write_all(server_, request_buffer.data(), size)) return false;
    reply_size_ = 0;
    for (;;) {
      const Reply reply = read_reply({reply_buffer.data(), reply_size_}, request, units_);
      if (reply.kind == Reply::Kind::Accepted) {
        has_units_ = has_units_ || request == Request::Geometry;
        is_closed_ = is_closed_ || request == Request::Close;
      }
      if (reply.kind != Reply::Kind::Incomplete) return true;
      if (!read_some(server_, reply_buffer.data() + reply_size_, reply.bytes - reply_size_))
        return false;
      reply_size_ = reply.bytes;
    }
  }

  bool ask_with(Request request) {
    request_buffer[0] = static_cast<std::uint8_t>(request);
    return ask(request_bytes({request_buffer.data(), 1}, units_));
  }

  /// Clears all units, waits until they acknowledge it, and sends Close.
  void silence() {
    if (!has_units_) return;
    deadline_ = now_ms() + kSilenceTime;
    const int message = (message_ + 1) % kMessages;
    request_buffer.fill(0);
    for (std::size_t u = 0; u < units_; ++u) {
      std::uint8_t* frame = request_buffer.data() + 1 + u * kFrameBytes;
      frame[0] = static_cast<std::uint8_t>(message);
      frame[4] = kClear;
    }
    if (!ask_with(Request::Send)) return;
    while (!is_late() && ask_with(Request::Read) && !have_answered(message)) ::poll(nullptr, 0, 1);
    deadline_ = now_ms() + kReplyTime;
    ask_with(Request::Close);
  }

  bool have_answered(int message) const {
    for (std::size_t u = 0; u < units_; ++u)
      if ((reply_buffer[1 + kAnswerBytes * u + 1] & 0xF) != message) return false;
    return true;
  }

  const int pipe_, server_;
  const std::size_t units_;
  std::size_t reply_size_ = 0;
  std::int64_t latest_ = 0;    // limit for the request in the buffer [ns]
  std::int64_t deadline_ = 0;  // [ms]; 0: the owner has not left
  int message_ = 0;            // id of the last frame
  bool has_units_ = false, is_closed_ = false;
};

void close_all_but(int a, int b) {
  const auto close_from = [](int first, int last) {
    if (first > last) return;
    if (::syscall(SYS_close_range, first, last, 0U) == 0) return;
    constexpr int kUsual = 1'024;  // for kernels without close_range
    for (int file = first; file <= std::min(last, kUsual); ++file) ::close(file);
  };
  constexpr int kLast = 0x7FFF'FFFF;
  const int low = std::min(a, b), high = std::max(a, b);
  close_from(0, low - 1);
  close_from(low + 1, high - 1);
  close_from(high + 1, kLast);
}

void ignore_signals() {
  struct sigaction ignore {};
  ignore.sa_handler = SIG_IGN;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, SIGUSR1, SIGUSR2, SIGALRM})
    ::sigaction(signal, &ignore, nullptr);
}

[[noreturn]] void hold_link(int pipe, int server, std::size_t units) {
  ignore_signals();
  ::prctl(PR_SET_NAME, "prostm-link", 0UL, 0UL, 0UL);
  close_all_but(pipe, server);
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  Relay(pipe, server, units).run();
  ::_exit(0);
}

// -- the owner

/// Forks with all signals blocked, so that no handler of the program runs in the new process.
pid_t fork_quietly() {
  sigset_t all, before;
  ::sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);
  const pid_t process = ::fork();
  if (process != 0) ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return process;
}

}  // namespace

std::string LinkProcess::open(const HostPort& address, std::size_t units, Duration patience) {
  close();
  TcpConnection server;
  const std::string why = server.open(address, patience);
  if (!why.empty()) return why;
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends.data()) != 0)
    return std::strerror(errno);
  TcpConnection own(ends[0]);
  const TcpConnection other(ends[1]);
  const pid_t process = fork_quietly();
  if (process == 0) hold_link(ends[1], server.socket(), units);
  if (process < 0) return std::strerror(errno);
  process_ = process;
  message_.reserve(kTimeBytes + kMostRequest);
  pipe_ = std::move(own);
  return {};
}

bool LinkProcess::send(std::span<const std::uint8_t> bytes, Clock::time_point latest,
                       Duration patience) noexcept {
  const std::int64_t time = std::chrono::nanoseconds(latest.time_since_epoch()).count();
  const auto* first = reinterpret_cast<const std::uint8_t*>(&time);
  message_.assign(first, first + kTimeBytes);
  message_.insert(message_.end(), bytes.begin(), bytes.end());
  return pipe_.send(message_, patience);
}

void LinkProcess::close() noexcept {
  pipe_.close();
  if (process_ == 0) return;
  const Clock::time_point end = Clock::now() + kPatience;
  while (::waitpid(process_, nullptr, WNOHANG) == 0) {
    if (Clock::now() > end) ::kill(process_, SIGKILL);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  process_ = 0;
}

}  // namespace prostm::autd3
