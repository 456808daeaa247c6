/// Stands in for a chain of AUTD3 units with the AUTD3 SDK's firmware: a port on ::1 for the group,
/// like the SDK's simulator, and a separate port for each unit. Reads commands line by line from
/// its standard input and answers each with a line of JSON.
///
/// usage: autd3_sdk_units [--units N] [--port P] [--activate-bytes 10|14] [--record] [--seed S]

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <fstream>
#include <iostream>
#include <memory>
#include <random>
#include <sstream>

#include "unit.hpp"

namespace {

using standin::Bytes;

constexpr std::int64_t kMillisecond = 1'000'000;  // [ns]

std::int64_t clock_now(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return t.tv_sec * 1'000'000'000LL + t.tv_nsec;
}

std::int64_t host_now() {
  return clock_now(CLOCK_MONOTONIC);
}

/// Nanoseconds from the realtime clock, which time-stamps datagrams, to the monotonic clock.
std::int64_t clock_offset() {
  std::int64_t best = INT64_MAX, offset = 0;
  for (int i = 0; i < 1000; ++i) {
    const std::int64_t before = host_now(), real = clock_now(CLOCK_REALTIME), after = host_now();
    if (after - before >= best) continue;
    best = after - before;
    offset = before + best / 2 - real;
  }
  return offset;
}

struct Port {
  int socket = -1;
  int number = 0;
};

Port bind_port(int number) {
  Port port{::socket(AF_INET6, SOCK_DGRAM | SOCK_CLOEXEC, 0), number};
  sockaddr_in6 address{};
  address.sin6_family = AF_INET6;
  address.sin6_addr = in6addr_loopback;
  address.sin6_port = htons(static_cast<std::uint16_t>(number));
  const int on = 1, buffer = 1 << 21;
  ::setsockopt(port.socket, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof(on));
  ::setsockopt(port.socket, SOL_SOCKET, SO_RCVBUF, &buffer, sizeof(buffer));
  if (::bind(port.socket, reinterpret_cast<sockaddr*>(&address), sizeof(address)) != 0 ||
      ::fcntl(port.socket, F_SETFL, O_NONBLOCK) != 0) {
    std::cerr << "cannot bind [::1]:" << number << ": " << std::strerror(errno) << '\n';
    std::exit(2);
  }
  socklen_t size = sizeof(address);
  ::getsockname(port.socket, reinterpret_cast<sockaddr*>(&address), &size);
  port.number = ntohs(address.sin6_port);
  return port;
}

struct Arrival {
  std::int64_t due = 0;  // [ns]
  int unit = -1;         // −1: the group
  sockaddr_in6 from{};
  Bytes bytes;
};

class Chain {
 public:
  Chain(int units, int port) : group_(bind_port(port)) {
    for (int u = 0; u < units; ++u) {
      ports_.push_back(bind_port(0));
      units_.push_back(std::make_unique<standin::Unit>(findings_, behaviour_));
    }
  }

  standin::Behaviour behaviour_;
  std::mt19937 random_{1};
  int port() const { return group_.number; }
  void record() {
    for (auto& unit : units_) unit->playback.records = true;
  }

  /// Waits up to 1 ms for datagrams and answers them.
  void turn();
  /// Executes a line. @return the answer; empty to quit.
  std::string obey(const std::string& line);

 private:
  void receive(const Port& port, int unit);
  void handle(const Arrival& arrival);
  void reply(std::size_t unit, const Arrival& arrival, const Bytes& bytes);
  bool chance(double percent) {
    return std::uniform_real_distribution<>(0, 100)(random_) < percent;
  }
  std::string report() const;
  bool dump(const std::string& file) const;
  bool set(const std::string& word, std::istringstream& in);

  const std::int64_t offset_ = clock_offset();
  standin::Findings findings_;
  Port group_;
  std::vector<Port> ports_;
  std::vector<std::unique_ptr<standin::Unit>> units_;
  std::vector<Arrival> waiting_;
  double drops_ = 0.0, reorders_ = 0.0;  // [%]
  std::int64_t delay_ = 0, cut_until_ = 0;
  std::int64_t dropped_ = 0, reordered_ = 0;
};

void Chain::receive(const Port& port, int unit) {
  std::array<std::uint8_t, 2048> buffer;
  for (;;) {
    Arrival arrival;
    arrival.unit = unit;
    iovec part{buffer.data(), buffer.size()};
    alignas(cmsghdr) std::array<char, 256> control{};
    msghdr message{};
    message.msg_name = &arrival.from;
    message.msg_namelen = sizeof(arrival.from);
    message.msg_iov = &part;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    const ssize_t size = ::recvmsg(port.socket, &message, 0);
    if (size < 0) return;
    // time of arrival, even if this program was not scheduled in time
    std::int64_t came = host_now();
    for (cmsghdr* c = CMSG_FIRSTHDR(&message); c != nullptr; c = CMSG_NXTHDR(&message, c)) {
      if (c->cmsg_level != SOL_SOCKET || c->cmsg_type != SCM_TIMESTAMPNS) continue;
      timespec t{};
      std::memcpy(&t, CMSG_DATA(c), sizeof(t));
      came = t.tv_sec * 1'000'000'000LL + t.tv_nsec + offset_;
    }
    if (came < cut_until_ || chance(drops_)) {
      ++dropped_;
      continue;
    }
    arrival.due = came + delay_;
    if (chance(reorders_)) {
      ++reordered_;
      arrival.due += 300'000;
    }
    arrival.bytes.assign(buffer.begin(), buffer.begin() + size);
    waiting_.push_back(std::move(arrival));
  }
}

void Chain::turn() {
  std::vector<pollfd> fds{{group_.socket, POLLIN, 0}};
  for (const Port& port : ports_) fds.push_back({port.socket, POLLIN, 0});
  ::poll(fds.data(), fds.size(), 1);
  const std::int64_t before = host_now();
  receive(group_, -1);
  for (std::size_t u = 0; u < ports_.size(); ++u) receive(ports_[u], static_cast<int>(u));
  const auto earlier = [](const Arrival& a, const Arrival& b) { return a.due < b.due; };
  std::stable_sort(waiting_.begin(), waiting_.end(), earlier);
  std::size_t done = 0;
  for (; done < waiting_.size() && waiting_[done].due <= host_now(); ++done) handle(waiting_[done]);
  waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(done));
  // delayed or queued datagrams must not reach a later state
  std::int64_t safe = before;
  for (const Arrival& arrival : waiting_) safe = std::min(safe, arrival.due);
  for (auto& unit : units_) unit->advance(safe);
}

void Chain::handle(const Arrival& arrival) {
  // each unit blocks the group's datagrams for the units behind it until it is opened
  for (std::size_t u = 0; u < units_.size(); ++u) {
    standin::Unit& unit = *units_[u];
    const bool last = u + 1 == units_.size();
    if (arrival.unit < 0 || arrival.unit == static_cast<int>(u)) {
      const auto out = unit.answer(arrival.due, arrival.bytes, arrival.unit >= 0, last);
      if (out) reply(u, arrival, *out);
      if (unit.sets_time)
        for (auto& each : units_) each->set_clock(arrival.due, unit.set_to, each->is_numbered());
    }
    if (!unit.open) break;
  }
}

void Chain::reply(std::size_t unit, const Arrival& arrival, const Bytes& bytes) {
  if (host_now() < cut_until_ || chance(drops_)) {
    ++dropped_;
    return;
  }
  ::sendto(ports_[unit].socket, bytes.data(), bytes.size(), 0,
           reinterpret_cast<const sockaddr*>(&arrival.from), sizeof(arrival.from));
}

std::string Chain::report() const {
  std::ostringstream out;
  std::int64_t sounding = -1, trips = 0, turns = 0, stops = 0;
  double step = 0.0, speed = 0.0;
  bool failsafe = false;
  for (const auto& unit : units_) {
    sounding = std::max(sounding, unit->last_sounding());
    trips += unit->trips;
    turns += unit->playback.turns;
    stops += unit->playback.stops;
    step = std::max(step, unit->playback.largest_step);
    speed = std::max(speed, unit->playback.largest_speed);
    failsafe = failsafe || unit->failsafe();
  }
  out << "{\"protocol_errors\":" << findings_.protocol_errors << ",\"last_error\":\""
      << findings_.last_error << "\",\"frames\":" << findings_.frames
      << ",\"heartbeats\":" << findings_.heartbeats << ",\"mismatches\":" << findings_.mismatches
      << ",\"duplicates\":" << findings_.duplicates << ",\"resets\":" << findings_.resets
      << ",\"clears\":" << findings_.clears << ",\"releases\":" << findings_.releases
      << ",\"dropped\":" << dropped_ << ",\"reordered\":" << reordered_ << ",\"trips\":" << trips
      << ",\"failsafe\":" << (failsafe ? "true" : "false") << ",\"turns\":" << turns
      << ",\"stops\":" << stops << ",\"largest_step_mm\":" << step
      << ",\"largest_speed_m_s\":" << speed << ",\"last_sounding_ns\":" << sounding
      << ",\"now_ns\":" << host_now() << "}";
  return out.str();
}

/// Writes the samples that the units played: unit, tick and words of each.
bool Chain::dump(const std::string& file) const {
  std::ofstream out(file, std::ios::binary);
  for (std::size_t u = 0; u < units_.size(); ++u) {
    for (const standin::Played& p : units_[u]->playback.played) {
      const auto unit = static_cast<std::int64_t>(u);
      out.write(reinterpret_cast<const char*>(&unit), sizeof(unit));
      out.write(reinterpret_cast<const char*>(&p), sizeof(p));
    }
  }
  return out.good();
}

bool Chain::set(const std::string& word, std::istringstream& in) {
  int a = 0, b = 0, c = -1;
  if (word == "refuse" && in >> a >> b) {
    in >> c;
    behaviour_.refusals[a] = {b, c};
  } else if (word == "status" && in >> a >> b) {
    behaviour_.statuses[a] = b;
  } else if (word == "delay" && in >> a) {
    delay_ = a * 1'000;
  } else if (word == "drop" && in >> a) {
    drops_ = a;
  } else if (word == "reorder" && in >> a) {
    reorders_ = a;
  } else if (word == "cut" && in >> a) {
    cut_until_ = host_now() + a * kMillisecond;
  } else if (word == "never-ready" && in >> a) {
    behaviour_.never_ready = a != 0;
  } else if (word == "unlocked" && in >> a) {
    behaviour_.unlocked = a != 0;
  } else if (word == "hot" && in >> a) {
    for (auto& unit : units_) unit->hot = a != 0;
  } else if (word == "hold-latch" && in >> a) {
    behaviour_.forgets_to_release = a != 0;
  } else if (word == "latch") {
    for (auto& unit : units_) unit->trip();
  } else if (word == "power-cycle") {
    const bool alone = static_cast<bool>(in >> a);
    for (std::size_t u = 0; u < units_.size(); ++u)
      if (!alone || static_cast<int>(u) == a) units_[u]->power_cycle();
  } else {
    return false;
  }
  return true;
}

std::string Chain::obey(const std::string& line) {
  std::istringstream in(line);
  std::string word, file;
  in >> word;
  if (word == "report") return report();
  if (word == "dump" && in >> file) return dump(file) ? "{}" : "{\"error\":\"cannot write\"}";
  if (word == "restart-counts") {
    findings_ = {};
    return "{}";
  }
  return set(word, in) ? "{}" : "{\"error\":\"unknown command\"}";
}

}  // namespace

int main(int argc, char** argv) {
  int units = 1, port = 0, activate_bytes = 10;
  unsigned seed = 1;
  bool records = false;
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    const int value = i + 1 < argc ? std::atoi(argv[i + 1]) : 0;
    if (name == "--record") {
      records = true;
      continue;
    }
    ++i;
    if (name == "--units")
      units = value;
    else if (name == "--port")
      port = value;
    else if (name == "--activate-bytes")
      activate_bytes = value;
    else if (name == "--seed")
      seed = static_cast<unsigned>(value);
    else
      return std::cerr << "unknown option " << name << '\n', 2;
  }
  if (units < 1 || units > 100) return std::cerr << "--units must be 1 to 100\n", 2;
  // hardware does not wait for other programs; ignored if it is not permitted
  ::setpriority(PRIO_PROCESS, 0, -15);
  Chain chain(units, port);
  chain.behaviour_.activate_bytes = static_cast<std::size_t>(activate_bytes);
  chain.random_.seed(seed);
  if (records) chain.record();
  std::cout << "{\"port\":" << chain.port() << "}" << std::endl;
  ::fcntl(STDIN_FILENO, F_SETFL, O_NONBLOCK);
  std::string typed;
  for (;;) {
    chain.turn();
    std::array<char, 512> buffer;
    const ssize_t got = ::read(STDIN_FILENO, buffer.data(), buffer.size());
    if (got == 0) return 0;  // the parent process is gone
    if (got < 0) continue;
    typed.append(buffer.data(), static_cast<std::size_t>(got));
    for (std::size_t end; (end = typed.find('\n')) != typed.npos; typed.erase(0, end + 1))
      std::cout << chain.obey(typed.substr(0, end)) << std::endl;
  }
}
