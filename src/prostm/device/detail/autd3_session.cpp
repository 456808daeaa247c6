#include "prostm/device/detail/autd3_session.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>
#include <thread>

namespace prostm::autd3 {
namespace {

enum Request : std::uint8_t { kGeometry = 1, kSend = 3, kRead = 4, kClose = 5, kHello = 0x10 };
constexpr std::uint8_t kAccepted = 0, kError = 0xFF;
constexpr std::string_view kMagic = "AUTD3REMOTE";
constexpr int kProtocol = 1;
constexpr int kMessages = 16;
constexpr std::size_t kMostWords = 500;  // of a server's complaint
constexpr int kMeasured = 25;            // frames
// opening a real bus takes seconds
constexpr std::chrono::seconds kConnectTime{1}, kOpenTime{10};

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
    return "v" + std::to_string(v.major) + "." + std::to_string(number - v.first) + "." +
           std::to_string(patch);
  }
  return number < kVersions.front().first ? "older than v9" : "newer than v12.1";
}

}  // namespace

Session::Session(TcpAddress address, std::vector<Pose> units)
    : address_(std::move(address)), units_(std::move(units)) {
  frames_.resize(units_.size());
  answers_.resize(units_.size());
  out_.reserve(1 + units_.size() * sizeof(Frame));
  in_.resize(1 + units_.size() * 2);
}

bool Session::fail(std::string sentence) {
  problem_ =
      "autd3://" + address_.host + ":" + std::to_string(address_.port) + " " + std::move(sentence);
  connection_.close();
  return false;
}

bool Session::lost() {
  return fail("is lost: it did not answer within 200 ms; look after its program and its cable");
}

bool Session::open() {
  problem_.clear();
  const std::string why = connection_.open(address_, kConnectTime);
  if (!why.empty()) {
    return fail("cannot be reached: " + why +
                "; start AUTD3's simulator (port 8080) or RemoteServer, and check the port");
  }
  if (!greet() || !tell_geometry()) return false;
  nop(frames_[0]);
  same_for_all();
  if (!exchange()) return false;
  clear_and_synchronise(frames_[0]);
  same_for_all();
  if (!exchange() || !read_firmware()) return false;
  read_state(frames_[0]);
  same_for_all();
  return exchange() && measure();
}

bool Session::request(std::span<const std::uint8_t> bytes) {
  return connection_.send(bytes, kPatience) || lost();
}

/// Reads whether the server accepted a request; if not, says so with its words.
bool Session::accepted(const char* what) {
  std::uint8_t status = kError;
  if (!connection_.receive({&status, 1}, kOpenTime))
    return fail(std::string("did not answer to ") + what +
                ": it is no server of AUTD3 v38, or "
                "another program is connected to it");
  if (status == kAccepted) return true;
  if (status != kError)
    return fail("answered with byte " + std::to_string(status) + " to " + what +
                ": it is no server of AUTD3 v38");
  std::array<std::uint8_t, 4> size_bytes;
  if (!connection_.receive(size_bytes, kPatience)) return lost();
  std::uint32_t size = 0;
  std::memcpy(&size, size_bytes.data(), sizeof(size));
  std::string words(std::min<std::size_t>(size, kMostWords), ' ');
  connection_.receive({reinterpret_cast<std::uint8_t*>(words.data()), words.size()}, kPatience);
  return fail(std::string("refused ") + what + ": \"" + words + "\"");
}

bool Session::greet() {
  out_.assign({kHello, kProtocol, 0});
  append(out_, kMagic.data(), kMagic.size());
  return request(out_) && accepted("the greeting of protocol 1");
}

bool Session::tell_geometry() {
  out_.assign({kGeometry});
  const auto count = static_cast<std::uint32_t>(units_.size());
  append(out_, &count, sizeof(count));
  for (const Pose& X_DU : units_) {
    for (int axis = 0; axis < 3; ++axis) append_float(out_, 1e3 * X_DU.translation()[axis]);
    const Quat q(X_DU.linear());
    for (const double part : {q.w(), q.x(), q.y(), q.z()}) append_float(out_, part);
  }
  return request(out_) && accepted("the places of the units");
}

bool Session::read_firmware() {
  std::array<int, 4> number{};
  const std::array kinds = {Info::CpuMajor, Info::CpuMinor, Info::FpgaMajor, Info::FpgaMinor};
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    autd3::firmware(frames_[0], kinds[i]);
    same_for_all();
    if (!exchange()) return false;
    number[i] = answers_[0].data;
  }
  firmware_ =
      "CPU " + version_of(number[0], number[1]) + ", FPGA " + version_of(number[2], number[3]);
  autd3::firmware(frames_[0], Info::Done);
  same_for_all();
  if (!exchange()) return false;
  if (number[0] != kNeeded || number[2] != kNeeded)
    return fail("has firmware " + firmware_ + "; AUTD3 v38 needs v12.1 in both");
  return true;
}

bool Session::measure() {
  const Clock::time_point start = Clock::now();
  for (int i = 0; i < kMeasured; ++i) {
    nop(frames_[0]);
    same_for_all();
    if (!exchange()) return false;
  }
  const std::chrono::duration<double, std::milli> time = Clock::now() - start;
  frames_per_ms_ = kMeasured / time.count();
  return true;
}

void Session::same_for_all() {
  std::fill(frames_.begin() + 1, frames_.end(), frames_.front());
}

bool Session::exchange() noexcept {
  message_ = (message_ + 1) % kMessages;
  out_.assign({kSend});
  for (Frame& frame : frames_) {
    frame[0] = static_cast<std::uint8_t>(message_);
    append(out_, frame.data(), frame.size());
  }
  if (!request(out_) || !accepted("a frame")) return false;
  const Clock::time_point end = Clock::now() + kPatience;
  for (;;) {
    if (!poll()) return false;
    const auto waits = [&](const Answer& answer) { return answer.message() != message_; };
    if (std::none_of(answers_.begin(), answers_.end(), waits)) break;
    if (Clock::now() > end) return lost();
    std::this_thread::sleep_for(kPolls);
  }
  for (const Answer& answer : answers_)
    if (answer.error() != 0) return fail(error_sentence(answer.error()));
  return true;
}

bool Session::poll() noexcept {
  const std::uint8_t read = kRead;
  if (!request({&read, 1}) || !accepted("a question for the units' state")) return false;
  const std::span<std::uint8_t> bytes(in_.data(), 2 * units_.size());
  if (!connection_.receive(bytes, kPatience)) return lost();
  for (std::size_t u = 0; u < answers_.size(); ++u) answers_[u] = {bytes[2 * u], bytes[2 * u + 1]};
  return true;
}

int Session::playing_segment() const {
  const auto segment = [](const Answer& answer) {
    return (answer.data & kFociSegment) != 0 ? 1 : 0;
  };
  const int first = segment(answers_.front());
  const bool same = std::all_of(answers_.begin(), answers_.end(),
                                [&](const Answer& answer) { return segment(answer) == first; });
  return same ? first : -1;
}

bool Session::is_hot() const {
  return std::any_of(answers_.begin(), answers_.end(),
                     [](const Answer& answer) { return (answer.data & kHot) != 0; });
}

void Session::close() noexcept {
  if (!connection_.is_open()) return;
  const std::uint8_t bye = kClose;
  std::uint8_t status = kError;
  if (connection_.send({&bye, 1}, kPatience)) connection_.receive({&status, 1}, kPatience);
  connection_.close();
}

}  // namespace prostm::autd3
