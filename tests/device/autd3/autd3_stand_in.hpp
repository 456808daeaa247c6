#pragma once
/// Runs the stand-in for AUTD3 units, tests/support/standins/autd3, and provides sources for it.

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "prostm/device/autd3/autd3_array.hpp"
#include "support/heap_guard.hpp"

namespace prostm::test {

/// A sample played by the stand-in's first unit, as stored in its log.
struct PlayedSample {
  double time;
  std::int32_t index;
  std::uint8_t segment, slots, loudest, intensity;
  std::int64_t divider;
  std::array<std::uint64_t, 8> words;

  /// Position of a slot in D for a unit centred there [m].
  Vec3 place(std::size_t slot) const {
    Vec3 p;
    for (int axis = 0; axis < 3; ++axis) {
      auto value = static_cast<std::int64_t>(words[slot] >> (18 * axis) & 0x3FFFF);
      if (value >= 1 << 17) value -= 1 << 18;
      p[axis] = static_cast<double>(value) * 0.025e-3;
    }
    return p - Vec3(8.5 * 10.16e-3, 6.5 * 10.16e-3, 0.0);
  }
};
static_assert(sizeof(PlayedSample) == 88);

class StandIn {
 public:
  explicit StandIn(const std::vector<std::string>& options = {"--frames-per-ms", "2"}) {
    std::array<int, 2> in{}, out{};
    if (::pipe(in.data()) != 0 || ::pipe(out.data()) != 0) throw std::runtime_error("no pipe");
    std::vector<std::string> words = {PROSTM_AUTD3_SERVER};
    words.insert(words.end(), options.begin(), options.end());
    process_ = ::fork();
    if (process_ == 0) {
      ::dup2(in[0], 0);
      ::dup2(out[1], 1);
      for (int file = 3; file < 64; ++file) ::close(file);
      std::vector<char*> arguments;
      for (std::string& word : words) arguments.push_back(word.data());
      arguments.push_back(nullptr);
      ::execv(arguments[0], arguments.data());
      ::_exit(127);
    }
    ::close(in[0]);
    ::close(out[1]);
    to_ = in[1];
    from_ = ::fdopen(out[0], "r");
    port_ = static_cast<std::uint16_t>(std::stoi(line()));
  }
  ~StandIn() {
    ::close(to_);
    std::fclose(from_);
    ::waitpid(process_, nullptr, 0);
  }
  StandIn(const StandIn&) = delete;
  StandIn& operator=(const StandIn&) = delete;

  std::string say(const std::string& what) {
    const std::string text = what + "\n";
    if (::write(to_, text.data(), text.size()) != static_cast<ssize_t>(text.size())) return {};
    return line();
  }
  nlohmann::json report() { return nlohmann::json::parse(say("report")); }
  std::vector<PlayedSample> log() {
    const std::string path = testing::TempDir() + "autd3_log_" + std::to_string(::getpid());
    say("log " + path);
    std::vector<PlayedSample> samples;
    {
      std::ifstream file(path, std::ios::binary);
      PlayedSample sample;
      while (file.read(reinterpret_cast<char*>(&sample), sizeof(sample))) samples.push_back(sample);
    }
    std::remove(path.c_str());
    return samples;
  }
  /// A setup that connects to the stand-in.
  Autd3Setup setup(int foci = 4) const {
    Autd3Setup setup;
    setup.address = {"127.0.0.1", port_};
    setup.foci = foci;
    return setup;
  }
  /// Waits until it plays, or is silent. @return time of the observation [s]; 0 if never.
  double wait_until_it(bool sounds, double patience = 30.0) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(patience);
    while (std::chrono::steady_clock::now() < end) {
      const nlohmann::json now = report();
      if (now["sounds"] == sounds) return now["now"];
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return 0.0;
  }

 private:
  std::string line() {
    std::string text;
    for (int c = std::fgetc(from_); c != EOF && c != '\n'; c = std::fgetc(from_))
      text.push_back(static_cast<char>(c));
    return text;
  }

  pid_t process_ = 0;
  int to_ = -1;
  std::FILE* from_ = nullptr;
  std::uint16_t port_ = 0;
};

inline double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

inline void sleep_s(double seconds) {
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

/// The smallest result of several trials: a busy machine may spoil some, but not all.
template <class Trial>
double best_of(int trials, double enough, Trial&& trial) {
  double least = trial();
  for (int i = 1; i < trials && !(least < enough); ++i) least = std::min<double>(least, trial());
  return least;
}

/// Stops an array before its source is destroyed.
class StopAtEnd {
 public:
  explicit StopAtEnd(Autd3Array& array) : array_(array) {}
  ~StopAtEnd() { array_.stop(); }
  StopAtEnd(const StopAtEnd&) = delete;
  StopAtEnd& operator=(const StopAtEnd&) = delete;

 private:
  Autd3Array& array_;
};

/// Focal points on circles of 20 mm at 7 m/s, at the device's own rate, each with its own
/// intensity.
class Circles final : public SampleSource {
 public:
  Circles(int foci, double rate) : foci_(foci), rate_(rate) {}
  int foci() const override { return foci_; }
  Vec3 place(int focus, std::int64_t sample) const {
    constexpr double kRadius = 0.02;
    const double angle = 7.0 / kRadius * static_cast<double>(sample) / rate_ + focus;
    return {kRadius * std::cos(angle) + 0.015 * (focus % 2), kRadius * std::sin(angle) - 0.02,
            0.2 + 0.01 * focus};
  }
  float intensity(int focus) const { return 1.0F - 0.15F * static_cast<float>(focus); }
  void fill(std::int64_t first, std::span<FocusSample> out) noexcept override {
    if (samples_ == 0) guard_.emplace();
    for (std::size_t i = 0; i < out.size(); ++i) {
      const int focus = static_cast<int>(i) % foci_;
      out[i] = {place(focus, first + static_cast<int>(i) / foci_).cast<float>(), intensity(focus)};
    }
    samples_ += static_cast<std::int64_t>(out.size()) / foci_;
    allocations_ = guard_->allocations();
  }
  std::int64_t samples() const { return samples_; }
  /// Counted on the thread that calls fill() first.
  std::size_t allocations() const { return allocations_; }

 private:
  int foci_;
  double rate_;
  std::atomic<std::int64_t> samples_{0};
  std::atomic<std::size_t> allocations_{0};
  std::optional<HeapGuard> guard_;
};

}  // namespace prostm::test
