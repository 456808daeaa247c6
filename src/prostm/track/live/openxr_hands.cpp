#include "prostm/track/live/openxr_hands.hpp"

// openxr_platform.h needs these first
#include <ctime>
#define XR_USE_TIMESPEC
#include <fmt/format.h>
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "prostm/core/input_error.hpp"
#include "prostm/core/spsc_ring.hpp"
#include "prostm/core/stage_timer.hpp"
#include "prostm/track/hand_json.hpp"

namespace prostm {
namespace {

using std::chrono::milliseconds;

static_assert(XR_HAND_JOINT_COUNT_EXT == kJointCount, "our joints are OpenXR's");

constexpr milliseconds kPeriod{10};
constexpr int kPeriodsToRetry = 100;
constexpr std::size_t kFramesKept = 128;
constexpr std::array<const char*, 3> kExtensions = {XR_EXT_HAND_TRACKING_EXTENSION_NAME,
                                                    XR_MND_HEADLESS_EXTENSION_NAME,
                                                    XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME};
constexpr double kMinRadius = 0.003, kMaxRadius = 0.040, kReach = 10.0;  // [m]

/// The loader writes its own messages to standard error unless told otherwise.
void silence_loader() {
  ::setenv("XR_LOADER_DEBUG", "none", 0);
}

/// Describes a failed call in a sentence.
InputError failure(const char* call, XrResult result) {
  return InputError(
      fmt::format("the OpenXR runtime failed in {} (result {})", call, static_cast<int>(result)));
}

void require(const char* call, XrResult result) {
  if (XR_FAILED(result)) throw failure(call, result);
}

void require_extensions() {
  std::uint32_t count = 0;
  const XrResult result = xrEnumerateInstanceExtensionProperties(nullptr, 0, &count, nullptr);
  if (XR_FAILED(result)) {
    throw InputError(
        "there is no OpenXR runtime here; install one with hand tracking, such as Monado (Debian's "
        "monado-service and libopenxr1-monado), and make it the active one, or name its manifest "
        "in "
        "XR_RUNTIME_JSON");
  }
  XrExtensionProperties blank{};
  blank.type = XR_TYPE_EXTENSION_PROPERTIES;
  std::vector<XrExtensionProperties> all(count, blank);
  require("xrEnumerateInstanceExtensionProperties",
          xrEnumerateInstanceExtensionProperties(nullptr, count, &count, all.data()));
  for (const char* wanted : kExtensions) {
    const bool there = std::any_of(all.begin(), all.end(), [&](const XrExtensionProperties& p) {
      return std::strcmp(p.extensionName, wanted) == 0;
    });
    if (!there) {
      throw InputError(fmt::format(
          "the OpenXR runtime lacks {}, which tracking hands without a display needs", wanted));
    }
  }
}

/// One instance with one session.
class Session {
 public:
  /// @throws InputError.
  Session() {
    require_extensions();
    try {
      create();
    } catch (...) {
      destroy();
      throw;
    }
  }
  ~Session() { destroy(); }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Handles pending events; false when the session is over.
  bool poll() {
    XrEventDataBuffer event{};
    event.type = XR_TYPE_EVENT_DATA_BUFFER;
    XrResult result = XR_SUCCESS;
    while ((result = xrPollEvent(instance_, &event)) == XR_SUCCESS) {
      if (event.type == XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING) return false;
      if (event.type == XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED) {
        XrEventDataSessionStateChanged change{};
        std::memcpy(&change, &event, sizeof change);
        if (!enter(change.state)) return false;
      }
      event = {};
      event.type = XR_TYPE_EVENT_DATA_BUFFER;
    }
    return !XR_FAILED(result);
  }

  bool running() const { return running_; }

  /// Locates both hands now; false when the session is lost.
  bool locate(HandFrame& frame, HandFaults& faults) {
    frame.hands.clear();
    frame.time = steady_now();
    const auto nanoseconds = static_cast<std::int64_t>(frame.time * 1e9);
    timespec monotonic{};  // the steady clock's
    monotonic.tv_sec = static_cast<time_t>(nanoseconds / 1'000'000'000);
    monotonic.tv_nsec = static_cast<long>(nanoseconds % 1'000'000'000);
    XrTime time = 0;
    if (XR_FAILED(convert_time_(instance_, &monotonic, &time))) return false;
    for (std::size_t side = 0; side < trackers_.size(); ++side) {
      if (!locate(side, time, frame, faults)) return false;
    }
    return true;
  }

 private:
  void create() {
    XrInstanceCreateInfo info{};
    info.type = XR_TYPE_INSTANCE_CREATE_INFO;
    std::strcpy(info.applicationInfo.applicationName, "prostm");
    info.applicationInfo.apiVersion = XR_CURRENT_API_VERSION;
    info.enabledExtensionCount = static_cast<std::uint32_t>(kExtensions.size());
    info.enabledExtensionNames = kExtensions.data();
    require("xrCreateInstance", xrCreateInstance(&info, &instance_));
    load("xrCreateHandTrackerEXT", create_tracker_);
    load("xrDestroyHandTrackerEXT", destroy_tracker_);
    load("xrLocateHandJointsEXT", locate_joints_);
    load("xrConvertTimespecTimeToTimeKHR", convert_time_);

    XrSystemGetInfo get{};
    get.type = XR_TYPE_SYSTEM_GET_INFO;
    get.formFactor = XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY;
    XrSystemId system = XR_NULL_SYSTEM_ID;
    if (XR_FAILED(xrGetSystem(instance_, &get, &system))) {
      throw InputError("the OpenXR runtime has no device; is it connected and switched on?");
    }
    XrSystemHandTrackingPropertiesEXT hands{};
    hands.type = XR_TYPE_SYSTEM_HAND_TRACKING_PROPERTIES_EXT;
    XrSystemProperties properties{};
    properties.type = XR_TYPE_SYSTEM_PROPERTIES;
    properties.next = &hands;
    require("xrGetSystemProperties", xrGetSystemProperties(instance_, system, &properties));
    if (hands.supportsHandTracking != XR_TRUE) {
      throw InputError(fmt::format("the OpenXR device {} does not track hands",
                                   static_cast<const char*>(properties.systemName)));
    }

    XrSessionCreateInfo session{};
    session.type = XR_TYPE_SESSION_CREATE_INFO;
    session.systemId = system;
    require("xrCreateSession", xrCreateSession(instance_, &session, &session_));
    create_space();
    for (std::size_t side = 0; side < trackers_.size(); ++side) {
      XrHandTrackerCreateInfoEXT hand{};
      hand.type = XR_TYPE_HAND_TRACKER_CREATE_INFO_EXT;
      hand.hand = side == 0 ? XR_HAND_LEFT_EXT : XR_HAND_RIGHT_EXT;
      hand.handJointSet = XR_HAND_JOINT_SET_DEFAULT_EXT;
      require("xrCreateHandTrackerEXT", create_tracker_(session_, &hand, &trackers_[side]));
    }
  }

  /// STAGE is fixed in the room; LOCAL has its origin at the head's initial place.
  void create_space() {
    std::array<XrReferenceSpaceType, 16> types{};
    std::uint32_t count = 0;
    require("xrEnumerateReferenceSpaces",
            xrEnumerateReferenceSpaces(session_, static_cast<std::uint32_t>(types.size()), &count,
                                       types.data()));
    const auto end = types.begin() + static_cast<std::ptrdiff_t>(count);
    XrReferenceSpaceCreateInfo info{};
    info.type = XR_TYPE_REFERENCE_SPACE_CREATE_INFO;
    info.referenceSpaceType = std::find(types.begin(), end, XR_REFERENCE_SPACE_TYPE_STAGE) != end
                                  ? XR_REFERENCE_SPACE_TYPE_STAGE
                                  : XR_REFERENCE_SPACE_TYPE_LOCAL;
    info.poseInReferenceSpace.orientation.w = 1.0F;
    require("xrCreateReferenceSpace", xrCreateReferenceSpace(session_, &info, &space_));
  }

  void destroy() {
    for (XrHandTrackerEXT& tracker : trackers_) {
      if (tracker != XR_NULL_HANDLE) destroy_tracker_(tracker);
    }
    if (space_ != XR_NULL_HANDLE) xrDestroySpace(space_);
    if (session_ != XR_NULL_HANDLE) xrDestroySession(session_);
    if (instance_ != XR_NULL_HANDLE) xrDestroyInstance(instance_);
  }

  template <class Function>
  void load(const char* name, Function& function) {
    PFN_xrVoidFunction found = nullptr;
    require(name, xrGetInstanceProcAddr(instance_, name, &found));
    function = reinterpret_cast<Function>(found);
  }

  bool enter(XrSessionState state) {
    switch (state) {
      case XR_SESSION_STATE_READY: {
        XrSessionBeginInfo begin{};
        begin.type = XR_TYPE_SESSION_BEGIN_INFO;
        begin.primaryViewConfigurationType = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
        running_ = !XR_FAILED(xrBeginSession(session_, &begin));
        return running_;
      }
      case XR_SESSION_STATE_STOPPING:
        running_ = false;
        return !XR_FAILED(xrEndSession(session_));
      case XR_SESSION_STATE_EXITING:
      case XR_SESSION_STATE_LOSS_PENDING:
        return false;
      default:
        return true;  // idle, synchronised, visible, focused
    }
  }

  bool locate(std::size_t side, XrTime time, HandFrame& frame, HandFaults& faults) {
    std::array<XrHandJointLocationEXT, kJointCount> joints{};
    XrHandJointLocationsEXT locations{};
    locations.type = XR_TYPE_HAND_JOINT_LOCATIONS_EXT;
    locations.jointCount = kJointCount;
    locations.jointLocations = joints.data();
    XrHandJointsLocateInfoEXT info{};
    info.type = XR_TYPE_HAND_JOINTS_LOCATE_INFO_EXT;
    info.baseSpace = space_;
    info.time = time;
    if (XR_FAILED(locate_joints_(trackers_[side], &info, &locations))) return false;
    const bool was_there = there_[side];
    there_[side] = locations.isActive == XR_TRUE && all_valid(joints);
    if (!there_[side]) return true;
    Hand hand;
    hand.side = side == 0 ? Side::Left : Side::Right;
    if (const auto problem = take(joints, hand)) {
      faults.add(problem->fault, fmt::format("the {} hand {}", name_of(hand.side), problem->words));
      there_[side] = false;
      return true;
    }
    if (!was_there) ids_[side] = ++last_id_;
    hand.id = ids_[side];
    hand.confidence = tracked_share(joints);
    frame.hands.push_back(hand);
    return true;
  }

  static bool all_valid(const std::array<XrHandJointLocationEXT, kJointCount>& joints) {
    constexpr XrSpaceLocationFlags kNeeded =
        XR_SPACE_LOCATION_POSITION_VALID_BIT | XR_SPACE_LOCATION_ORIENTATION_VALID_BIT;
    return std::all_of(joints.begin(), joints.end(), [](const XrHandJointLocationEXT& joint) {
      return (joint.locationFlags & kNeeded) == kNeeded;
    });
  }

  /// Share of the joints that the runtime tracks now; others are inferred, or last known places.
  static double tracked_share(const std::array<XrHandJointLocationEXT, kJointCount>& joints) {
    constexpr XrSpaceLocationFlags kTracked =
        XR_SPACE_LOCATION_POSITION_TRACKED_BIT | XR_SPACE_LOCATION_ORIENTATION_TRACKED_BIT;
    const auto tracked =
        std::count_if(joints.begin(), joints.end(), [](const XrHandJointLocationEXT& joint) {
          return (joint.locationFlags & kTracked) == kTracked;
        });
    return static_cast<double>(tracked) / static_cast<double>(joints.size());
  }

  /// Reads the joints of a hand whose side is known; returns the first problem, if any.
  static std::optional<HandProblem> take(
      const std::array<XrHandJointLocationEXT, kJointCount>& joints, Hand& hand) {
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const XrVector3f& p = joints[j].pose.position;
      const XrQuaternionf& q = joints[j].pose.orientation;
      for (const float number : {p.x, p.y, p.z, q.x, q.y, q.z, q.w, joints[j].radius}) {
        if (!std::isfinite(number))
          return HandProblem{HandFault::Member, "has a joint that is not a number"};
      }
      hand.position[j] = Eigen::Vector3f(p.x, p.y, p.z).cast<double>();
      hand.orientation[j] = Eigen::Quaternionf(q.w, q.x, q.y, q.z).cast<double>();
      const double length = hand.orientation[j].norm();
      if (hand.position[j].cwiseAbs().maxCoeff() > kReach)
        return HandProblem{HandFault::Member, "has a joint farther than 10 m away"};
      if (std::abs(length - 1.0) > 0.01)
        return HandProblem{HandFault::Axes, "has a quaternion that is not of length 1"};
      hand.orientation[j].normalize();
      hand.radius[j] = std::clamp(static_cast<double>(joints[j].radius), kMinRadius, kMaxRadius);
      hand.velocity[j] = Vec3::Zero();
    }
    return hand_problem(hand);
  }

  XrInstance instance_ = XR_NULL_HANDLE;
  XrSession session_ = XR_NULL_HANDLE;
  XrSpace space_ = XR_NULL_HANDLE;
  std::array<XrHandTrackerEXT, 2> trackers_{XR_NULL_HANDLE, XR_NULL_HANDLE};  // left, right
  bool running_ = false;
  std::array<bool, 2> there_{};
  std::array<std::int64_t, 2> ids_{};
  std::int64_t last_id_ = 0;
  PFN_xrCreateHandTrackerEXT create_tracker_ = nullptr;
  PFN_xrDestroyHandTrackerEXT destroy_tracker_ = nullptr;
  PFN_xrLocateHandJointsEXT locate_joints_ = nullptr;
  PFN_xrConvertTimespecTimeToTimeKHR convert_time_ = nullptr;
};

class OpenXrTracker final : public LiveTracker {
 public:
  OpenXrTracker() : thread_([this] { run(); }) {}
  ~OpenXrTracker() override {
    stop_.store(true);
    thread_.join();
  }

  bool next(HandFrame& frame) override { return ring_.pop(frame); }
  bool connected() const noexcept override { return connected_.load(std::memory_order_relaxed); }

  TrackerStatus status() const override {
    TrackerStatus status;
    status.connected = connected();
    status.frames = frames_.load(std::memory_order_relaxed);
    status.reconnects = std::max<std::int64_t>(sessions_.load(std::memory_order_relaxed) - 1, 0);
    const std::lock_guard lock(problem_mutex_);
    if (status.connected) {
      status.sentence = "the OpenXR session is running";
    } else {
      status.sentence = problem_.empty() ? "the OpenXR session has not begun yet" : problem_;
    }
    add_faults(faults_, status);
    return status;
  }

 private:
  void run() {
    auto due = std::chrono::steady_clock::now();
    int wait = 0;
    while (!stop_.load()) {
      if (session_ && !turn()) {
        session_.reset();
        connected_.store(false, std::memory_order_relaxed);
        say("the OpenXR session has ended; requesting another one");
        wait = kPeriodsToRetry;
      } else if (!session_ && --wait <= 0) {
        open();
        wait = kPeriodsToRetry;
      }
      due = std::max(due + kPeriod, std::chrono::steady_clock::now());
      std::this_thread::sleep_until(due);
    }
    session_.reset();
  }

  /// Handles events and reads a frame; false when the session is over.
  bool turn() {
    if (!session_->poll()) return false;
    connected_.store(session_->running(), std::memory_order_relaxed);
    if (!session_->running()) return true;
    HandFaults faults;
    if (!session_->locate(frame_, faults)) return false;
    frames_.fetch_add(1, std::memory_order_relaxed);
    if (faults.any()) {
      const std::lock_guard lock(problem_mutex_);
      faults_.add(faults);
    }
    ring_.push(frame_);
    return true;
  }

  void open() {
    try {
      session_ = std::make_unique<Session>();
      sessions_.fetch_add(1, std::memory_order_relaxed);
      say({});
    } catch (const InputError& error) {
      say(error.what());
    }
  }

  void say(const std::string& problem) {
    const std::lock_guard lock(problem_mutex_);
    problem_ = problem;
  }

  std::unique_ptr<Session> session_;  // used by the tracker's thread only
  HandFrame frame_;
  SpscRing<HandFrame> ring_{kFramesKept};
  std::atomic<bool> stop_{false}, connected_{false};
  std::atomic<std::int64_t> frames_{0}, sessions_{0};
  mutable std::mutex problem_mutex_;  // planner and emitter never wait for it
  std::string problem_;
  HandFaults faults_;

  std::thread thread_;  // constructed last: it uses all of the above
};

}  // namespace

std::unique_ptr<LiveTracker> make_openxr_tracker() {
  silence_loader();
  return std::make_unique<OpenXrTracker>();
}

std::string openxr_problem() {
  silence_loader();
  try {
    require_extensions();
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace prostm
