#include "prostm/device/autd3/detail/autd3_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <thread>

namespace prostm::autd3 {
namespace {

constexpr std::string_view kMagic = "AUTD3REMOTE";
constexpr int kProtocol = 1;
constexpr int kMessages = 16;
constexpr std::size_t kMeasured = 40;  // frames
constexpr std::chrono::seconds kConnectTime{1};

void append(std::vector<std::uint8_t>& out, const void* data, std::size_t size) {
  const auto* bytes = static_cast<const std::uint8_t*>(data);
  out.insert(out.end(), bytes, bytes + size);
}

void append_float(std::vector<std::uint8_t>& out, double value) {
  const auto number = static_cast<float>(value);
  append(out, &number, sizeof(number));
}

/// Major versions as the firmware numbers them, [first, last].
struct Versions {
  int first, last, major;
};
constexpr std::array kVersions = {Versions{0xA0, 0xA1, 9}, Versions{0xA2, 0xA2, 10},
                                  Versions{0xA3, 0xA3, 11}, Versions{0xA4, 0xA5, 12}};
constexpr int kNeeded = 0xA5;  // v12.1

std::string version_of(int number, int patch) {
  for (const Versions& v : kVersions) {
    if (number < v.first || number > v.last) continue;
    return fmt::format("v{}.{}.{}", v.major, number - v.first, patch);
  }
  return number < kVersions.front().first ? "older than v9" : "newer than v12.1";
}

/// Returns a server's message without control characters, which a terminal would obey.
std::string plain(std::string_view words) {
  std::string text(words.substr(0, 300));
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ' || c == 127) c = ' ';
  return text;
}

}  // namespace

Session::Session(HostPort address, std::vector<Pose> units)
    : address_(std::move(address)), units_(std::move(units)) {
  frames_.resize(units_.size());
  answers_.resize(units_.size());
  out_.reserve(5 + units_.size() * kFrameBytes);
  in_.resize(kMostReply);
}

bool Session::fail(const std::string& sentence) {
  problem_ = "autd3://" + address_.text() + " " + sentence;
  link_.close();
  return false;
}

bool Session::lost() {
  return fail(
      "is lost: it closed the connection or did not answer within 200 ms; check its program and "
      "its cable");
}

bool Session::open(Clock::duration patience) {
  problem_.clear();
  turns_ = nullptr;
  const std::string why =
      link_.open(address_, units_.size(), std::min<Clock::duration>(kConnectTime, patience));
  if (!why.empty()) {
    return fail("cannot be reached: " + why +
                "; start AUTD3's simulator (port 8080) or RemoteServer, and check the port");
  }
  if (!greet(patience) || !send_geometry(patience)) return false;
  nop(frames_[0]);
  return exchange_for_all() && read_firmware();
}

bool Session::prepare(TurnClock* turns) {
  clear_and_synchronise(frames_[0]);
  if (!exchange_for_all()) return false;
  read_state(frames_[0]);
  turns_ = turns;
  return exchange_for_all();
}

/// Sends the request in `out_` and reads the reply. If the server refuses it, fails with the
/// server's message.
bool Session::ask(Request request, const char* what, Clock::duration patience,
                  Clock::time_point latest) {
  if (!link_.send(out_, latest, kPatience)) return lost();
  std::size_t have = 0;
  for (;;) {
    const Reply reply = read_reply({in_.data(), have}, request, units_.size());
    switch (reply.kind) {
      case Reply::Kind::Accepted:
        return true;
      case Reply::Kind::Refused:
        return fail(std::string("refused ") + what + ": \"" + plain(reply.words) + "\"");
      case Reply::Kind::Strange:
        return fail(std::string("gave an unknown answer to ") + what +
                    ": it is no server of AUTD3 v38");
      case Reply::Kind::Incomplete:
        break;
    }
    if (!link_.receive({in_.data() + have, reply.bytes - have}, patience)) {
      if (request == Request::Send || request == Request::Read) return lost();
      return fail(std::string("did not answer to ") + what +
                  ": it is no server of AUTD3 v38, or another program is connected to it");
    }
    have = reply.bytes;
  }
}

bool Session::greet(Clock::duration patience) {
  out_.assign({static_cast<std::uint8_t>(Request::Hello), kProtocol, 0});
  append(out_, kMagic.data(), kMagic.size());
  return ask(Request::Hello, "the greeting of protocol 1", patience);
}

bool Session::send_geometry(Clock::duration patience) {
  out_.assign({static_cast<std::uint8_t>(Request::Geometry)});
  const auto count = static_cast<std::uint32_t>(units_.size());
  append(out_, &count, sizeof(count));
  for (const Pose& X_DU : units_) {
    for (int axis = 0; axis < 3; ++axis) append_float(out_, 1e3 * X_DU.translation()[axis]);
    const Quat q(X_DU.linear());
    for (const double part : {q.w(), q.x(), q.y(), q.z()}) append_float(out_, part);
  }
  return ask(Request::Geometry, "the poses of the units", patience);
}

bool Session::read_firmware() {
  std::array<int, 4> number{};
  const std::array kinds = {Info::CpuMajor, Info::CpuMinor, Info::FpgaMajor, Info::FpgaMinor};
  std::vector<std::array<int, 4>> numbers(units_.size(), number);
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    autd3::firmware(frames_[0], kinds[i]);
    if (!exchange_for_all()) return false;
    for (std::size_t u = 0; u < units_.size(); ++u) numbers[u][i] = answers_[u].data;
  }
  autd3::firmware(frames_[0], Info::Done);
  if (!exchange_for_all()) return false;
  for (std::size_t u = 0; u < units_.size(); ++u) {
    number = numbers[u];
    firmware_ =
        "CPU " + version_of(number[0], number[1]) + ", FPGA " + version_of(number[2], number[3]);
    if (number[0] != kNeeded || number[2] != kNeeded) {
      return fail("has unit " + std::to_string(u) + " with firmware " + firmware_ +
                  "; AUTD3 v38 needs v12.1 in both: update it with AUTD3's firmware tool");
    }
  }
  return true;
}

bool Session::measure() {
  std::array<double, kMeasured> times{};
  for (double& time : times) {
    const Clock::time_point start = Clock::now();
    nop(frames_[0]);
    if (!exchange_for_all()) return false;
    time = std::chrono::duration<double>(Clock::now() - start).count();
  }
  double sum = 0.0;
  for (const double time : times) sum += time;
  frame_time_ = sum / static_cast<double>(kMeasured);
  std::sort(times.begin(), times.end());
  slow_frame_ = times[kMeasured * 9 / 10];
  return true;
}

void Session::same_for_all() {
  std::fill(frames_.begin() + 1, frames_.end(), frames_.front());
}

bool Session::send(Clock::time_point latest) noexcept {
  message_ = (message_ + 1) % kMessages;
  out_.assign(1, static_cast<std::uint8_t>(Request::Send));
  for (Frame& frame : frames_) {
    frame[0] = static_cast<std::uint8_t>(message_);
    append(out_, frame.data(), frame.size());
  }
  return ask(Request::Send, "a frame", kPatience, latest);
}

bool Session::confirm() noexcept {
  const Clock::time_point end = Clock::now() + kPatience;
  for (;;) {
    if (!poll()) return false;
    const auto waits = [&](const Answer& answer) { return answer.message() != message_; };
    if (std::none_of(answers_.begin(), answers_.end(), waits)) break;
    if (Clock::now() > end) return lost();
    std::this_thread::sleep_for(kPolls);
  }
  for (std::size_t u = 0; u < answers_.size(); ++u) {
    const int error = answers_[u].error();
    if (error != 0)
      return fail("has unit " + std::to_string(u) + ", which " + error_sentence(error));
  }
  return true;
}

bool Session::exchange_for_all(Clock::time_point latest) noexcept {
  same_for_all();
  return send(latest) && confirm();
}

bool Session::poll() noexcept {
  const Clock::time_point asked = Clock::now();
  out_.assign(1, static_cast<std::uint8_t>(Request::Read));
  if (!ask(Request::Read, "a request for the units' state", kPatience)) return false;
  for (std::size_t u = 0; u < answers_.size(); ++u)
    answers_[u] = {in_[1 + kAnswerBytes * u], in_[2 + kAnswerBytes * u]};
  if (turns_ != nullptr) turns_->see(asked, Clock::now(), playing_segment());
  return true;
}

int Session::playing_segment() const {
  const auto segment = [](const Answer& answer) {
    if ((answer.data & kStateIsRead) == 0) return -1;
    return (answer.data & kFociSegment) != 0 ? 1 : 0;
  };
  const int first = segment(answers_.front());
  const bool same = std::all_of(answers_.begin(), answers_.end(),
                                [&](const Answer& answer) { return segment(answer) == first; });
  return same ? first : -1;
}

bool Session::is_hot() const {
  return std::any_of(answers_.begin(), answers_.end(), [](const Answer& answer) {
    return (answer.data & kStateIsRead) != 0 && (answer.data & kHot) != 0;
  });
}

void Session::close() noexcept {
  turns_ = nullptr;
  if (!link_.is_open()) return;
  out_.assign(1, static_cast<std::uint8_t>(Request::Close));
  if (link_.send(out_, Clock::time_point::max(), kPatience))
    link_.receive({in_.data(), 1}, kPatience);
  link_.close();
}

}  // namespace prostm::autd3
