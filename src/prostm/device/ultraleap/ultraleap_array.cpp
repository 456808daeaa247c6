// The adapter to the vendor's SDK; empty in builds without it.
#if defined(PROSTM_ULTRALEAP)
#include <algorithm>
#include <chrono>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "prostm/device/detail/segment_player.hpp"
#include "prostm/device/ultraleap/detail/ultraleap_emission.hpp"
#include "prostm/device/ultraleap/detail/ultraleap_session.hpp"
#include "prostm/device/ultraleap/ultraleap.hpp"

namespace prostm {
namespace {

namespace ulh = Ultraleap::Haptics;

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

class UltraleapArray final : public Device {
 public:
  explicit UltraleapArray(const DeviceSetup& setup);
  ~UltraleapArray() override { stop(); }

  const DeviceInfo& info() const override { return info_; }
  DeviceStatus status() const override;
  std::string problem() const override;
  DeviceStatus start(SampleSource& source) override;
  void stop() override;
  DeviceStatus load_segment(std::span<const FocusSample> samples, int foci) override;
  DeviceStats stats() const override;
  std::int64_t samples() const override { return emission_->log().played(seconds_now()); }
  double play_time(std::int64_t sample) const override {
    return emission_->log().play_time(sample);
  }
  double ask_time(std::int64_t sample) const override { return emission_->log().ask_time(sample); }

 private:
  DeviceStatus refuse(const std::string& sentence);
  DeviceStatus state() const;
  bool is_stopped_by_fault() const { return emission_->fault() != UltraleapEmission::Fault::None; }
  DeviceStatus begin(SampleSource& source);
  void reopen(int foci);

  const UltraleapAddress address_;
  DeviceInfo info_;
  SegmentPlayer segment_;
  SampleSource* source_ = nullptr;
  // outlives the session, which may still call it while it ends
  const std::unique_ptr<UltraleapEmission> emission_ = std::make_unique<UltraleapEmission>();

  mutable std::mutex mutex_;  // guards the members below; never held in the callback
  DeviceStatus status_ = DeviceStatus::Idle;
  std::string problem_;
  std::int64_t missed_ = 0;  // of the last emission, once it has ended
  std::unique_ptr<UltraleapSession> session_;
};

DeviceInfo info_of(const UltraleapSession& session) {
  return {.name = "Ultraleap " + session.identifier(),
          .sample_rate = session.rate(),
          .block_samples = session.samples_a_call(),
          .max_foci = session.most_foci(),
          .intensity_per_focus = true,
          .streams = true,
          .loads_segments = true,
          .keeps_time = true,
          .decimation = ultraleap_decimation(session.rate())};
}

UltraleapArray::UltraleapArray(const DeviceSetup& setup)
    : address_(ultraleap_address(setup.address)),
      session_(std::make_unique<UltraleapSession>(address_, setup.foci, *emission_)) {
  info_ = info_of(*session_);
  remember_ultraleap(setup, info_);
}

DeviceStatus UltraleapArray::refuse(const std::string& sentence) {
  const std::lock_guard lock(mutex_);
  problem_ = sentence;
  if (status_ != DeviceStatus::Running) status_ = DeviceStatus::Refused;
  return DeviceStatus::Refused;
}

/// Returns the status; Vanished if the emission has ended by itself. @pre locked.
DeviceStatus UltraleapArray::state() const {
  if (status_ != DeviceStatus::Running) return status_;
  emission_->watch();
  const bool gone = session_ == nullptr || session_->events().is_gone() || is_stopped_by_fault();
  return gone ? DeviceStatus::Vanished : DeviceStatus::Running;
}

DeviceStatus UltraleapArray::status() const {
  const std::lock_guard lock(mutex_);
  return state();
}

std::string UltraleapArray::problem() const {
  const std::lock_guard lock(mutex_);
  if (state() != DeviceStatus::Vanished) return problem_;
  if (session_ != nullptr && session_->events().is_gone()) return session_->events().problem();
  if (emission_->fault() == UltraleapEmission::Fault::Rate) {
    return "The Ultraleap array '" + (session_ ? session_->identifier() : address_.device) +
           "' changed its rate from " + std::to_string(std::lround(info_.sample_rate)) + " to " +
           std::to_string(std::lround(1.0 / std::max(1e-9, emission_->found_interval()))) +
           " Hz while it played: open it again.";
  }
  if (emission_->fault() == UltraleapEmission::Fault::Stalled)
    return "The Ultraleap Haptics SDK has requested no samples for a second: start again.";
  return "The Ultraleap Haptics SDK failed while it requested samples: start again.";
}

/// Closes the session, if it is open, and opens another.
void UltraleapArray::reopen(int foci) {
  std::unique_ptr<UltraleapSession> old;
  {
    const std::lock_guard lock(mutex_);
    old.swap(session_);
  }
  old.reset();  // release the claim first
  auto fresh = std::make_unique<UltraleapSession>(address_, foci, *emission_);
  const std::lock_guard lock(mutex_);
  session_ = std::move(fresh);
}

DeviceStatus UltraleapArray::begin(SampleSource& source) {
  const int foci = source.foci();
  try {
    if (session_ == nullptr || session_->events().is_gone() || is_stopped_by_fault()) reopen(foci);
    const std::lock_guard lock(mutex_);
    session_->set_foci(foci, info_.sample_rate);
    source_ = &source;
    emission_->start(
        source,
        {.rate = session_->rate(), .foci = foci, .least_separation = session_->least_separation()});
    session_->start();
    missed_ = 0;
    problem_.clear();
    return status_ = DeviceStatus::Running;
  } catch (const std::exception& error) {
    emission_->stop();
    source_ = nullptr;
    return refuse(error.what());
  }
}

DeviceStatus UltraleapArray::start(SampleSource& source) {
  stop();
  return begin(source);
}

void UltraleapArray::stop() {
  if (source_ == nullptr) {
    const std::lock_guard lock(mutex_);
    status_ = DeviceStatus::Idle;
    return;
  }
  emission_->fade_out();
  emission_->stop();
  source_ = nullptr;
  const std::lock_guard lock(mutex_);
  if (session_ != nullptr) {
    missed_ = session_->missed_calls();
    session_->stop();
  }
  status_ = DeviceStatus::Idle;
}

DeviceStatus UltraleapArray::load_segment(std::span<const FocusSample> samples, int foci) {
  const bool running = status() == DeviceStatus::Running;
  const std::string problem = segment_problem(samples, foci, info_.max_foci);
  if (!problem.empty()) return refuse(problem);
  if (running && (source_ != &segment_ || segment_.foci() != foci)) {
    return refuse(
        "The Ultraleap array is playing a stream, or a segment with another number of focal "
        "points; stop it first.");
  }
  if (!running) {
    stop();
    segment_.reset(foci);
  }
  segment_.load(samples);
  return running ? DeviceStatus::Running : begin(segment_);
}

DeviceStats UltraleapArray::stats() const {
  DeviceStats out;
  out.blocks = emission_->log().calls();
  out.late_blocks = emission_->late_calls();
  const PlayLog::Call newest = emission_->log().newest();
  const double ahead = (newest.play_time - newest.time) * info_.sample_rate / info_.block_samples;
  out.queue_blocks = static_cast<int>(std::clamp(std::round(ahead), 0.0, 1e6));
  const std::lock_guard lock(mutex_);
  const bool plays = status_ == DeviceStatus::Running && session_ != nullptr;
  out.missed_blocks = plays ? session_->missed_calls() : missed_;
  return out;
}

/// Describes an array: "USX:1 (Mock, firmware 1.2), free".
std::string words_of(const ulh::Device& device) {
  std::string out = device.getIdentifier();
  if (const auto info = device.getInfo()) {
    const ulh::DeviceInfo& told = info.value();
    out +=
        std::string(" (") + told.getModelDescription() + ", firmware " + told.getFirmwareVersion();
    const UltraleapKit* kit = ultraleap_kit(told.getModelName(), told.getTransducerLayoutName());
    if (kit != nullptr) {
      std::ostringstream place;
      place << ", its kit's tracker at y = " << 1e3 * kit->tracker_y << " mm";
      out += place.str();
    }
    if (!told.hasSupportFor(ulh::DeviceFeatures::StreamingHaptics)) out += ", cannot stream";
    out += ")";
  }
  const std::string owner = ultraleap_owner(device);
  return out + (owner.empty() ? ", free" : ", used by " + owner);
}

DeviceFinding look(const DeviceSetup& setup) {
  const UltraleapAddress address = ultraleap_address(setup.address);
  ulh::Library library(ulh::AppVersionInfo("prostm"));
  connect_ultraleap(library, address.connection);
  const auto devices = library.getDevices();
  if (!devices)
    return {false,
            "The Ultraleap Haptics SDK does not list its arrays (" + message_of(devices) + ")."};
  DeviceFinding out;
  std::string list;
  for (const ulh::Device& device : devices.value()) {
    list += (list.empty() ? "" : "; ") + words_of(device);
    const auto info = device.getInfo();
    const bool wanted =
        address.device.empty()
            ? info && info.value().hasSupportFor(ulh::DeviceFeatures::StreamingHaptics)
            : address.device == device.getIdentifier();
    out.found = out.found || (wanted && ultraleap_owner(device).empty());
  }
  out.words = list.empty()
                  ? "The Ultraleap Haptics SDK sees no array: connect one and switch it on."
                  : "Arrays: " + list + ".";
  return out;
}

}  // namespace

std::unique_ptr<Device> make_ultraleap(const DeviceSetup& setup) {
  return std::make_unique<UltraleapArray>(setup);
}

DeviceFinding look_for_ultraleap(const DeviceSetup& setup) {
  try {
    return look(setup);
  } catch (const std::exception& error) {
    return {false, error.what()};
  }
}

}  // namespace prostm
#endif
