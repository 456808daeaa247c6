#if defined(PROSTM_ULTRALEAP)
#include "prostm/device/ultraleap/detail/ultraleap_session.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <type_traits>
#include <utility>

namespace prostm {
namespace {

namespace ulh = Ultraleap::Haptics;

constexpr float kCallRate = 1000.0F;                 // callbacks a second
constexpr double kLeastRate = 1e3, kMostRate = 1e6;  // of samples that an emission can make [Hz]
constexpr double kRateTolerance = 1e-4;
// largest distance of the transducers' middle from the origin [m]: not every array is symmetrical,
// and a kit's tracker, the nearest other origin, is at least 89 mm away
constexpr double kCentreTolerance = 0.02;

[[noreturn]] void refuse(const std::string& sentence) {
  throw std::invalid_argument(sentence);
}

/// Throws if a result is an error: "WHAT (the SDK's message)REMEDY."
template <class Result>
void require(const Result& result, const std::string& what, const std::string& remedy = "") {
  if (!result) refuse(what + " (" + message_of(result) + ")" + remedy + ".");
}

/// Describes an error of the SDK, which may be a number or an object with a message.
template <class Error>
std::string words_of(const Error& error) {
  if constexpr (std::is_enum_v<Error> || std::is_integral_v<Error>) {
    return "number " + std::to_string(static_cast<long long>(error));
  } else {
    return std::string(error.message());
  }
}

std::string hertz(double rate) {
  return std::to_string(std::llround(rate)) + " Hz";
}

ulh::Device find_device(ulh::Library& library, const std::string& name) {
  auto device = name.empty() ? library.findDevice(ulh::DeviceFeatures::StreamingHaptics)
                             : library.getDevice(name.c_str());
  if (name.empty()) {
    require(device, "No Ultraleap array that streams was found",
            ": connect it, switch it on, and look with prostm devices");
  } else {
    require(device, "The Ultraleap array '" + name + "' was not found",
            ": prostm devices lists the connected ones");
  }
  return device.value();
}

}  // namespace

UltraleapEvents::UltraleapEvents(std::string device, UltraleapEmission& emission)
    : device_(std::move(device)), emission_(emission) {}

void UltraleapEvents::end(const std::string& sentence) {
  if (closed_) return;
  emission_.mute();
  const std::lock_guard lock(mutex_);
  if (gone_) return;
  problem_ = sentence;
  gone_.store(true, std::memory_order_release);
}

std::string UltraleapEvents::problem() const {
  const std::lock_guard lock(mutex_);
  return problem_;
}

void UltraleapEvents::onDeviceDisconnected(const char* identifier) {
  if (is_ours(identifier))
    end("The Ultraleap array '" + device_ + "' was disconnected: connect it and start again.");
}

void UltraleapEvents::onDeviceModificationRightsRescinded(const char* identifier) {
  if (is_ours(identifier))
    end("The Ultraleap array '" + device_ +
        "' was taken from this program: end the program that uses it and start again.");
}

void UltraleapEvents::onDeviceErrorDetected(const char* identifier, ulh::DeviceError error) {
  if (is_ours(identifier))
    end("The Ultraleap array '" + device_ + "' reports an error (" + words_of(error) +
        "): check the array, then start again.");
}

void UltraleapEvents::onLibraryDisconnected(const ulh::EndpointInfo& /*service*/) {
  end("The service of the Ultraleap Haptics SDK has ended: start it, then start again.");
}

void connect_ultraleap(ulh::Library& library, const std::string& connection) {
  const auto result = connection.empty() ? library.connect() : library.connect(connection.c_str());
  if (connection == "direct") {
    require(result, "The Ultraleap Haptics SDK found no way to the arrays without its service");
  }
  require(result, "The service of the Ultraleap Haptics SDK does not answer",
          ": start it, or name ultraleap://@direct, which needs no service");
}

std::string ultraleap_owner(const ulh::Device& device) {
  const auto status = device.getClaimStatus();
  if (!status || status.value() != ulh::DeviceClaimStatus::OtherClient) return {};
  const auto owner = device.getClaimOwner();
  const std::string name = owner ? owner.value().version().name() : std::string();
  return name.empty() ? "a program without a name" : name;
}

UltraleapSession::UltraleapSession(const UltraleapAddress& address, int foci,
                                   UltraleapEmission& emission)
    : library_(ulh::AppVersionInfo("prostm")) {
  connect_ultraleap(library_, address.connection);
  ulh::Device device = find_device(library_, address.device);
  identifier_ = device.getIdentifier();
  check_place(device);
  emitter_ = std::make_unique<ulh::StreamingEmitter>(library_);
  claim(device);
  set_rate(device, foci);
  const auto separation = device.getMinimumPointSeparation();
  require(separation,
          "The Ultraleap array '" + identifier_ + "' does not say its least separation");
  least_separation_ = static_cast<double>(separation.value());
  require(emitter_->setEmissionCallback(&UltraleapEmission::callback, &emission),
          "The Ultraleap Haptics SDK does not take a callback");
  require(emitter_->setCallbackRate(kCallRate),
          "The Ultraleap Haptics SDK does not call back 1000 times a second");
  events_ = std::make_shared<UltraleapEvents>(identifier_, emission);
  library_.addEventListener(events_);
}

UltraleapSession::~UltraleapSession() {
  events_->close();
  library_.removeEventListener(events_);
  // callbacks may continue until the emitter is gone; the emission is silent and outlives it
  stop();
  emitter_.reset();
  static_cast<void>(library_.disconnect());
}

/// Throws unless the middle of the transducers is the origin, as in D.
void UltraleapSession::check_place(const ulh::Device& device) const {
  const auto info = device.getInfo();
  require(info, "The Ultraleap array '" + identifier_ + "' does not report its properties");
  if (!info.value().hasSupportFor(ulh::DeviceFeatures::StreamingHaptics))
    refuse("The Ultraleap array '" + identifier_ + "' cannot stream.");
  const auto transducers = info.value().getTransducers();
  if (transducers.empty()) return;
  Eigen::Vector2d least = Eigen::Vector2d::Constant(1e9), most = -least;
  for (const auto& transducer : transducers) {
    const Eigen::Vector2d at(static_cast<double>(transducer.position.x),
                             static_cast<double>(transducer.position.y));
    least = least.cwiseMin(at);
    most = most.cwiseMax(at);
  }
  const Eigen::Vector2d middle = 0.5 * (least + most);
  if (middle.norm() <= kCentreTolerance) return;
  refuse("The middle of the transducers of '" + identifier_ + "' is " +
         std::to_string(std::lround(1e3 * middle.norm())) +
         " mm from the origin of its coordinates; prostm needs it there.");
}

void UltraleapSession::claim(ulh::Device& device) {
  const std::string used = "The Ultraleap array '" + identifier_ + "' is used by ";
  const std::string remedy = ": end that program, then try again.";
  std::string owner = ultraleap_owner(device);
  if (!owner.empty()) refuse(used + owner + remedy);
  // D is the device's own frame: metres, origin in the middle of the array, z out of it
  const auto added = emitter_->addDevice(device, ulh::Transform());
  if (added) return;
  owner = ultraleap_owner(device);
  if (!owner.empty()) refuse(used + owner + remedy);
  require(added, "The Ultraleap array '" + identifier_ + "' cannot be claimed");
}

/// Sets the number of control points and reads the rate at which the array plays them.
void UltraleapSession::set_rate(const ulh::Device& device, int foci) {
  require(emitter_->setControlPointCount(static_cast<std::size_t>(foci), ulh::AdjustRate::All),
          "The Ultraleap array '" + identifier_ + "' does not take " + std::to_string(foci) +
              " focal points",
          ": try fewer --paths");
  foci_ = foci;
  // the emitter may keep a rate that is too fast for the array
  const auto limit = emitter_->getDeviceUpdateRateLimit(device, static_cast<std::size_t>(foci));
  require(limit, "The Ultraleap array '" + identifier_ + "' does not say its fastest rate");
  if (emitter_rate() > static_cast<double>(limit.value()) * (1.0 + kRateTolerance)) {
    require(emitter_->setEmitterUpdateRate(limit.value()),
            "The Ultraleap array '" + identifier_ + "' does not take its fastest rate");
  }
  rate_ = emitter_rate();
  if (!(rate_ >= kLeastRate && rate_ <= kMostRate)) {
    refuse("The Ultraleap array '" + identifier_ + "' gives a rate of " + hertz(rate_) + " with " +
           std::to_string(foci) + " focal points; it must be 1000 to 1000000 Hz.");
  }
}

double UltraleapSession::emitter_rate() const {
  const auto rate = emitter_->getEmitterUpdateRate();
  require(rate, "The Ultraleap array '" + identifier_ + "' does not say its rate");
  return static_cast<double>(rate.value());
}

void UltraleapSession::set_foci(int foci, double rate) {
  const auto is_rate = [&] { return std::abs(emitter_rate() - rate) <= kRateTolerance * rate; };
  if (foci == foci_ && is_rate()) return;
  const auto set =
      emitter_->setControlPointCount(static_cast<std::size_t>(foci), ulh::AdjustRate::AsRequired);
  require(set,
          "The Ultraleap array '" + identifier_ + "' does not take " + std::to_string(foci) +
              " focal points",
          ": try fewer --paths");
  foci_ = foci;
  if (!is_rate()) static_cast<void>(emitter_->setEmitterUpdateRate(static_cast<float>(rate)));
  if (!is_rate()) {
    refuse("The Ultraleap array '" + identifier_ + "' plays " + std::to_string(foci) +
           " focal points at " + hertz(emitter_rate()) + ", and these samples are made for " +
           hertz(rate) + ": open it again for that number of focal points.");
  }
  rate_ = rate;
}

void UltraleapSession::start() {
  require(emitter_->start(), "The Ultraleap array '" + identifier_ + "' does not start");
}

void UltraleapSession::stop() {
  static_cast<void>(emitter_->stop());
}

int UltraleapSession::most_foci() const {
  return std::max(foci_,
                  static_cast<int>(std::min<std::size_t>(emitter_->getControlPointLimit(), 8)));
}

int UltraleapSession::samples_a_call() const {
  const double calls = static_cast<double>(emitter_->getCallbackRate());
  return std::max(1, static_cast<int>(std::lround(rate_ / std::max(1.0, calls))));
}

std::int64_t UltraleapSession::missed_calls() const {
  const auto missed = emitter_->getMissedCallbackIterations();
  return missed ? static_cast<std::int64_t>(missed.value()) : 0;
}

}  // namespace prostm
#endif
