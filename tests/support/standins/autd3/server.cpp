#include "server.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <sstream>

namespace standin {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000, kMillisecond = 1'000'000, kTick = 25'000;  // [ns]
constexpr std::size_t kFrame = kFrameBytes, kPlace = 28;
constexpr std::size_t kMostUnits = 200;

std::int64_t now() {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return kSecond * t.tv_sec + t.tv_nsec;
}

float float_at(const std::string& bytes, std::size_t at) {
  float value = 0.0F;
  std::memcpy(&value, bytes.data() + at, sizeof(value));
  return value;
}

std::uint32_t u32_at(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof(value));
  return value;
}

}  // namespace

Server::Server(const Options& options) : options_(options) {
  ear_.keep_log(options.keeps_log);
  tick_ = now() / kTick;
  listen();
  std::printf("%d\n", options_.port);
  std::fflush(stdout);
}

void Server::listen() {
  listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  const int again = 1;
  ::setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &again, sizeof(again));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(options_.port));
  socklen_t size = sizeof(address);
  if (::bind(listener_, reinterpret_cast<sockaddr*>(&address), sizeof(address)) != 0 ||
      ::listen(listener_, 8) != 0) {
    std::fprintf(stderr, "autd3_server: port %d cannot be used: %s\n", options_.port,
                 std::strerror(errno));
    std::exit(1);
  }
  ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
  options_.port = ntohs(address.sin_port);
}

void Server::run() {
  while (!quits_) {
    wait();
    play();
    if (listener_ < 0 && now() >= closed_until_) listen();
    if (listener_ >= 0 && client_ < 0) accept();
    if (now() >= stalled_until_) {
      read_client();
      flush();
    }
  }
  play();
  std::printf("%s\n", report().c_str());
  std::fflush(stdout);
}

void Server::wait() {
  std::array<pollfd, 3> waiting{};
  waiting[0] = {STDIN_FILENO, POLLIN, 0};
  const bool stalled = now() < stalled_until_;
  nfds_t count = 1;
  if (client_ >= 0 && !stalled && out_.empty()) waiting[count++] = {client_, POLLIN, 0};
  if (client_ < 0 && listener_ >= 0) waiting[count++] = {listener_, POLLIN, 0};
  // sleeps for up to 1 ms, less if a reply is due
  std::int64_t left = kMillisecond;
  if (!out_.empty() && !stalled)
    left = std::clamp<std::int64_t>(out_.front().due - now(), 0, kMillisecond);
  const timespec time{0, static_cast<long>(left)};
  if (::ppoll(waiting.data(), count, &time, nullptr) > 0 && waiting[0].revents != 0) read_control();
}

/// Lets the units play up to the present time.
void Server::play() {
  const std::int64_t until = now() / kTick;
  for (; tick_ < until; ++tick_) {
    const std::int64_t time = (tick_ + 1) * kTick;
    const double seconds = static_cast<double>(time) / static_cast<double>(kSecond);
    for (std::size_t u = 0; u < units_.size(); ++u) {
      units_[u].go_to(tick_ + 1, static_cast<std::uint64_t>(time));
      if (u == 0) {
        ear_.hear(units_[u].playing(), tick_ + 1, seconds);
        continue;
      }
      const Playing other = units_[u].playing();
      if (other.intensity * other.modulation / 255 > 0) other_sound_ = seconds;
    }
  }
}

void Server::accept() {
  client_ = ::accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
  if (client_ < 0) return;
  const int at_once = 1;
  ::setsockopt(client_, IPPROTO_TCP, TCP_NODELAY, &at_once, sizeof(at_once));
  ++connections_;
  in_.clear();
  out_.clear();
  greeted_ = has_units_ = leaves_ = false;
}

/// The units continue to play: the server's link does not silence them.
void Server::disconnect() {
  if (client_ >= 0) ::close(client_);
  client_ = -1;
  out_.clear();
  in_.clear();
}

void Server::read_client() {
  if (client_ < 0 || leaves_) return;
  std::array<char, 65'536> buffer;
  bool left = false;
  for (;;) {
    const ssize_t got = ::recv(client_, buffer.data(), buffer.size(), 0);
    if (got > 0) {
      in_.append(buffer.data(), static_cast<std::size_t>(got));
      continue;
    }
    left = got == 0 || (errno != EAGAIN && errno != EINTR);
    break;
  }
  while (client_ >= 0 && !leaves_ && !in_.empty()) {
    const std::size_t used = take_message();
    if (used == 0) break;
    in_.erase(0, used);
  }
  if (!left || client_ < 0) return;
  if (!in_.empty() && !leaves_) problem("the client left in the middle of a message");
  disconnect();
}

/// Answers the first message. @return its size; 0 if it is incomplete.
std::size_t Server::take_message() {
  const int kind = static_cast<unsigned char>(in_[0]);
  const std::int64_t at_once = std::max(now(), out_.empty() ? 0 : out_.back().due) + delay_;
  if (!out_.empty()) problem("a request came before the reply to the one before it");
  if (kind != 0x10 && !greeted_) {
    refuse("Handshake is required before sending commands");
    leaves_ = true;
    return in_.size();
  }
  switch (kind) {
    case 0x10:
      if (in_.size() < 14) return 0;
      if (hello_is_right(in_.substr(0, 14))) answer(std::string(1, '\0'), at_once);
      return 14;
    case 0x01: {
      if (in_.size() < 5) return 0;
      const std::size_t size = 5 + kPlace * u32_at(in_, 1);
      if (u32_at(in_, 1) > kMostUnits) problem("there are too many units");
      if (in_.size() < size) return 0;
      if (geometry_is_right(in_.substr(0, size))) answer(std::string(1, '\0'), at_once);
      return size;
    }
    case 0x03: {
      const std::size_t size = 1 + kFrame * units_.size();
      if (!has_units_) {
        refuse("Link is closed");
        return in_.size();
      }
      if (in_.size() < size) return 0;
      const double rate = options_.frames_per_ms;
      const auto slot =
          rate > 0.0 ? std::llround(static_cast<double>(kMillisecond) / rate) : std::int64_t{0};
      const std::int64_t due = std::max(at_once, next_slot_);
      next_slot_ = due + slot;
      out_.push_back({due, std::string(1, '\0'), in_.substr(1, size - 1)});
      return size;
    }
    case 0x04: {
      if (!has_units_) {
        refuse("Link is closed");
        return 1;
      }
      std::string bytes(1, '\0');
      for (const Unit& unit : units_)
        for (const std::uint8_t byte : unit.answer()) bytes.push_back(static_cast<char>(byte));
      answer(bytes, at_once);
      return 1;
    }
    case 0x05:
      ++goodbyes_;
      answer(std::string(1, '\0'), at_once);
      leaves_ = true;
      return 1;
    default:
      problem("a message of unknown type " + std::to_string(kind));
      refuse("Unknown message type: " + std::to_string(kind));
      return in_.size();
  }
}

bool Server::hello_is_right(const std::string& bytes) {
  std::string why;
  if (greeted_) why = "Handshake already completed";
  if (bytes[1] != 1 || bytes[2] != 0) why = "Unsupported protocol version";
  if (bytes.substr(3) != "AUTD3REMOTE") why = "Invalid client magic";
  if (why.empty()) return greeted_ = true;
  refuse(why);
  leaves_ = true;
  return false;
}

bool Server::geometry_is_right(const std::string& bytes) {
  if (has_units_) {
    refuse("Link is already opened");
    return false;
  }
  const std::size_t count = u32_at(bytes, 1);
  if (count == 0) problem("there is no unit");
  places_.clear();
  for (std::size_t u = 0; u < count; ++u) {
    double square = 0.0;
    for (std::size_t i = 0; i < 7; ++i) {
      const double value = static_cast<double>(float_at(bytes, 5 + kPlace * u + 4 * i));
      places_.push_back(value);
      if (!std::isfinite(value) || std::abs(value) > 1e4) problem("a unit's place is not finite");
      if (i >= 3) square += value * value;
    }
    if (std::abs(square - 1.0) > 1e-3) problem("a unit's quaternion is not of length 1");
  }
  // a bus that is reopened finds its units unchanged
  if (units_.size() != count) units_.assign(count, Unit());
  for (Unit& unit : units_) unit.set_version(options_.version);
  return has_units_ = true;
}

void Server::answer(const std::string& bytes, std::int64_t due) {
  out_.push_back({due, bytes});
}

void Server::refuse(const std::string& words) {
  std::string bytes(1, '\xFF');
  const auto size = static_cast<std::uint32_t>(words.size());
  bytes.append(reinterpret_cast<const char*>(&size), sizeof(size));
  out_.push_back({now(), bytes + words});
}

/// Does all that is due: handles frames, and sends replies.
void Server::flush() {
  while (client_ >= 0 && !out_.empty() && out_.front().due <= now()) {
    const Out out = std::move(out_.front());
    out_.pop_front();
    if (!out.frames.empty()) {
      play();
      ++frames_;
      const auto* bytes = reinterpret_cast<const std::uint8_t*>(out.frames.data());
      for (std::size_t u = 0; u < units_.size(); ++u) {
        units_[u].take({bytes + kFrame * u, kFrame}, tick_,
                       static_cast<std::uint64_t>(tick_ * kTick));
      }
    }
    if (drops_ > 0) {
      --drops_;
      continue;
    }
    // replies are short, so a client that does not read them is at fault
    if (::send(client_, out.bytes.data(), out.bytes.size(), MSG_NOSIGNAL) !=
        static_cast<ssize_t>(out.bytes.size())) {
      return disconnect();
    }
  }
  if (leaves_ && out_.empty()) disconnect();
}

void Server::problem(const std::string& what) {
  ++problems_;
  if (first_problem_.empty()) first_problem_ = what;
}

void Server::read_control() {
  std::array<char, 4096> buffer;
  const ssize_t got = ::read(STDIN_FILENO, buffer.data(), buffer.size());
  if (got <= 0) {
    quits_ = true;
    return;
  }
  control_.append(buffer.data(), static_cast<std::size_t>(got));
  for (std::size_t end; (end = control_.find('\n')) != std::string::npos;) {
    control(control_.substr(0, end));
    control_.erase(0, end + 1);
  }
}

void Server::control(const std::string& line) {
  std::istringstream words(line);
  std::string what;
  double number = 0.0, times = 1.0;
  words >> what;
  if (what == "log") {
    std::string path;
    words >> path;
    write_log(path);
  } else {
    words >> number >> times;
  }
  const auto until = now() + static_cast<std::int64_t>(number * static_cast<double>(kMillisecond));
  if (what == "quit") quits_ = true;
  if (what == "rate") options_.frames_per_ms = number;
  if (what == "version") options_.version = static_cast<int>(number);
  if (what == "delay") delay_ = until - now();
  if (what == "drop") drops_ = static_cast<int>(number);
  if (what == "stall") stalled_until_ = until;
  if (what == "hot")
    for (Unit& unit : units_) unit.set_hot(number != 0.0);
  if (what == "modulation")
    for (Unit& unit : units_) unit.ignore_modulation(number == 0.0);
  if (what == "refuse" && !units_.empty())
    units_.back().refuse(static_cast<int>(number), static_cast<int>(times));
  if (what == "cut") {
    disconnect();
    ::close(listener_);
    listener_ = -1;
    closed_until_ = until;
  }
  play();
  std::printf("%s\n", what == "report" ? report().c_str() : "ok");
  std::fflush(stdout);
}

void Server::write_log(const std::string& path) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (file == nullptr) return problem("the log cannot be written");
  std::fwrite(ear_.log().data(), sizeof(Played), ear_.log().size(), file);
  std::fclose(file);
}

std::string Server::report() {
  std::int64_t problems = problems_, errors = 0;
  std::string first = first_problem_;
  std::array<std::int64_t, 16> by_error{};
  for (const Unit& unit : units_) {
    problems += unit.problems();
    if (first.empty()) first = unit.first_problem();
    for (std::size_t e = 1; e < by_error.size(); ++e) {
      by_error[e] += unit.errors()[e];
      errors += unit.errors()[e];
    }
  }
  const double seconds = static_cast<double>(now()) / static_cast<double>(kSecond);
  std::ostringstream out;
  out.precision(17);
  out << "{\"problems\": " << problems << ", \"first_problem\": \"" << first
      << "\", \"errors\": " << errors << ", \"frames\": " << frames_
      << ", \"connections\": " << connections_ << ", \"goodbyes\": " << goodbyes_
      << ", \"connected\": " << (client_ >= 0 ? "true" : "false")
      << ", \"units\": " << units_.size() << ", \"samples\": " << ear_.samples
      << ", \"now\": " << seconds << ", \"last_sound\": " << std::max(ear_.last_sound, other_sound_)
      << ", \"sounds\": " << (ear_.sounds ? "true" : "false") << ", \"silences\": " << ear_.silences
      << ", \"longest_silence\": " << ear_.longest_silence
      << ", \"largest_key\": " << ear_.largest_key
      << ", \"largest_step_mm\": " << 1e3 * ear_.largest_step
      << ", \"largest_speed\": " << ear_.largest_speed << ", \"phase_error\": " << ear_.phase_error
      << ", \"clears\": " << (units_.empty() ? 0 : units_[0].commands(1)) << ", \"places\": [";
  for (std::size_t i = 0; i < places_.size(); ++i) out << (i > 0 ? ", " : "") << places_[i];
  out << "]}";
  return out.str();
}

}  // namespace standin
