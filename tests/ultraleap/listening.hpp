#pragma once
/// Sources for the adapter's tests, and a record of the stand-in's emission.

#include <cmath>
#include <memory>
#include <ultraleap/haptics/stand_in.hpp>
#include <vector>

#include "prostm/device/ultraleap/ultraleap.hpp"

namespace prostm::test {

namespace stand_in = ultraleap_stand_in;
namespace ulh = Ultraleap::Haptics;

inline DeviceSetup setup_of(int foci, const std::string& address = "") {
  return {.array = usx_array(), .address = address, .foci = foci};
}

/// A source whose samples carry their index; points are 30 mm apart.
class Numbered final : public SampleSource {
 public:
  explicit Numbered(int foci) : foci_(foci) {}
  int foci() const override { return foci_; }
  static FocusSample sample(std::int64_t number, int focus) {
    const auto n = static_cast<float>(number);
    return {Eigen::Vector3f(1e-6F * n, 0.03F * static_cast<float>(focus), 0.2F),
            0.5F + 0.4F * std::sin(0.001F * n + static_cast<float>(focus))};
  }
  void fill(std::int64_t first, std::span<FocusSample> out) noexcept override {
    in_order_ = in_order_ && first == next_;
    const auto width = static_cast<std::size_t>(foci_);
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i] = sample(first + static_cast<std::int64_t>(i / width), static_cast<int>(i % width));
    next_ = first + static_cast<std::int64_t>(out.size() / width);
  }
  bool in_order() const { return in_order_; }
  /// Samples requested so far.
  std::int64_t taken() const { return next_; }

 private:
  const int foci_;
  std::int64_t next_ = 0;
  bool in_order_ = true;
};

/// Records the stand-in's emission in preallocated memory.
class Listener {
 public:
  struct Heard {
    double time = 0.0;
    FocusSample point[8];
  };

  explicit Listener(std::size_t most) : heard_(most) {
    stand_in::set_sink([this](ulh::LocalTimePoint time, std::span<const ulh::ControlPoint> points) {
      if (count_ == heard_.size()) return;
      Heard& h = heard_[count_++];
      h.time = std::chrono::duration<double>(time.time_since_epoch()).count();
      for (std::size_t f = 0; f < points.size(); ++f) {
        const ulh::Vector3 p = points[f].getPosition();
        h.point[f] = {Eigen::Vector3f(p.x, p.y, p.z), points[f].getIntensity()};
      }
    });
  }
  ~Listener() { stand_in::set_sink(nullptr); }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  std::span<const Heard> heard() const { return std::span(heard_).first(count_); }

 private:
  std::vector<Heard> heard_;
  std::size_t count_ = 0;
};

}  // namespace prostm::test
