/// A small OpenXR runtime without a display that plays hands from a recording, to test a client
/// through the real loader. It does not prove conformance. It reads these environment variables:
///
///   PROSTM_REPLAY_HANDS    the recording (.hands.jsonl), repeated from the session's begin on
///   PROSTM_REPLAY_WITHOUT  an extension to leave out
///   PROSTM_REPLAY_INFERRED number of joints per hand that it does not see: valid, but not tracked
///   PROSTM_REPLAY_LOSS     seconds after which each session is lost

#include <ctime>
#define XR_USE_TIMESPEC
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "prostm/io/hand/hand_file.hpp"

namespace {

using prostm::Hand;
using prostm::HandFrame;
using prostm::HandRecording;

constexpr std::array<const char*, 3> kExtensions = {XR_EXT_HAND_TRACKING_EXTENSION_NAME,
                                                    XR_MND_HEADLESS_EXTENSION_NAME,
                                                    XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME};

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// The only instance with its only session.
struct Runtime {
  HandRecording recording;
  std::size_t inferred = 0;           // per hand
  std::optional<double> loss;         // since the session's start [s]
  std::deque<XrSessionState> events;  // waiting to be polled
  std::optional<double> begun;        // on the steady clock [s]
  bool session = false;
};
std::unique_ptr<Runtime> runtime;

// handles are addresses of these
char instance_handle, session_handle, space_handle, hand_handles[2];

template <class Handle>
Handle handle(char& place) {
  return reinterpret_cast<Handle>(&place);
}

bool lacks(const char* extension) {
  const char* without = std::getenv("PROSTM_REPLAY_WITHOUT");
  return without != nullptr && std::strcmp(without, extension) == 0;
}

XrResult XRAPI_CALL enumerate_extensions(const char*, std::uint32_t capacity, std::uint32_t* count,
                                         XrExtensionProperties* properties) {
  *count = 0;
  for (const char* name : kExtensions) {
    if (lacks(name)) continue;
    if (*count < capacity) {
      std::strcpy(properties[*count].extensionName, name);
      properties[*count].extensionVersion = 1;
    }
    ++*count;
  }
  return capacity == 0 || capacity >= *count ? XR_SUCCESS : XR_ERROR_SIZE_INSUFFICIENT;
}

XrResult XRAPI_CALL create_instance(const XrInstanceCreateInfo*, XrInstance* instance) {
  const char* file = std::getenv("PROSTM_REPLAY_HANDS");
  if (runtime || file == nullptr) return XR_ERROR_RUNTIME_FAILURE;
  try {
    runtime = std::make_unique<Runtime>();
    runtime->recording = prostm::read_hand_recording(file);
  } catch (const std::exception&) {
    runtime.reset();
    return XR_ERROR_RUNTIME_FAILURE;
  }
  if (const char* inferred = std::getenv("PROSTM_REPLAY_INFERRED"))
    runtime->inferred = static_cast<std::size_t>(std::atoi(inferred));
  if (const char* loss = std::getenv("PROSTM_REPLAY_LOSS")) runtime->loss = std::atof(loss);
  *instance = handle<XrInstance>(instance_handle);
  return XR_SUCCESS;
}

XrResult XRAPI_CALL destroy_instance(XrInstance) {
  runtime.reset();
  return XR_SUCCESS;
}

XrResult XRAPI_CALL instance_properties(XrInstance, XrInstanceProperties* properties) {
  properties->runtimeVersion = XR_MAKE_VERSION(1, 0, 0);
  std::strcpy(properties->runtimeName, "replayed hands");
  return XR_SUCCESS;
}

XrResult XRAPI_CALL get_system(XrInstance, const XrSystemGetInfo*, XrSystemId* system) {
  *system = 1;
  return XR_SUCCESS;
}

XrResult XRAPI_CALL system_properties(XrInstance, XrSystemId, XrSystemProperties* properties) {
  std::strcpy(properties->systemName, "replayed hands");
  auto* next = static_cast<XrBaseOutStructure*>(properties->next);
  for (; next != nullptr; next = next->next) {
    if (next->type == XR_TYPE_SYSTEM_HAND_TRACKING_PROPERTIES_EXT)
      reinterpret_cast<XrSystemHandTrackingPropertiesEXT*>(next)->supportsHandTracking = XR_TRUE;
  }
  return XR_SUCCESS;
}

XrResult XRAPI_CALL create_session(XrInstance, const XrSessionCreateInfo*, XrSession* session) {
  if (runtime->session) return XR_ERROR_LIMIT_REACHED;
  runtime->session = true;
  runtime->events = {XR_SESSION_STATE_IDLE, XR_SESSION_STATE_READY};
  *session = handle<XrSession>(session_handle);
  return XR_SUCCESS;
}

XrResult XRAPI_CALL destroy_session(XrSession) {
  runtime->session = false;
  return XR_SUCCESS;
}

XrResult XRAPI_CALL begin_session(XrSession, const XrSessionBeginInfo*) {
  runtime->begun = now();
  runtime->events.insert(
      runtime->events.end(),
      {XR_SESSION_STATE_SYNCHRONIZED, XR_SESSION_STATE_VISIBLE, XR_SESSION_STATE_FOCUSED});
  return XR_SUCCESS;
}

XrResult XRAPI_CALL end_session(XrSession) {
  runtime->begun.reset();
  return XR_SUCCESS;
}

XrResult XRAPI_CALL poll_event(XrInstance, XrEventDataBuffer* buffer) {
  if (runtime->begun && runtime->loss && now() - *runtime->begun > *runtime->loss) {
    runtime->begun.reset();
    runtime->events = {XR_SESSION_STATE_LOSS_PENDING};
  }
  if (runtime->events.empty()) return XR_EVENT_UNAVAILABLE;
  XrEventDataSessionStateChanged change{};
  change.type = XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED;
  change.session = handle<XrSession>(session_handle);
  change.state = runtime->events.front();
  runtime->events.pop_front();
  std::memcpy(static_cast<void*>(buffer), &change, sizeof change);
  return XR_SUCCESS;
}

XrResult XRAPI_CALL reference_spaces(XrSession, std::uint32_t capacity, std::uint32_t* count,
                                     XrReferenceSpaceType* types) {
  constexpr std::array<XrReferenceSpaceType, 2> kTypes = {XR_REFERENCE_SPACE_TYPE_VIEW,
                                                          XR_REFERENCE_SPACE_TYPE_LOCAL};
  *count = kTypes.size();
  if (capacity >= kTypes.size()) std::copy(kTypes.begin(), kTypes.end(), types);
  return XR_SUCCESS;
}

XrResult XRAPI_CALL create_space(XrSession, const XrReferenceSpaceCreateInfo* info,
                                 XrSpace* space) {
  *space = handle<XrSpace>(space_handle);
  return info->referenceSpaceType == XR_REFERENCE_SPACE_TYPE_LOCAL
             ? XR_SUCCESS
             : XR_ERROR_REFERENCE_SPACE_UNSUPPORTED;
}

XrResult XRAPI_CALL destroy_space(XrSpace) {
  return XR_SUCCESS;
}

XrResult XRAPI_CALL convert_time(XrInstance, const timespec* monotonic, XrTime* time) {
  *time = monotonic->tv_sec * 1'000'000'000 + monotonic->tv_nsec;
  return XR_SUCCESS;
}

XrResult XRAPI_CALL create_hand(XrSession, const XrHandTrackerCreateInfoEXT* info,
                                XrHandTrackerEXT* hand) {
  *hand = handle<XrHandTrackerEXT>(hand_handles[info->hand == XR_HAND_LEFT_EXT ? 0 : 1]);
  return XR_SUCCESS;
}

XrResult XRAPI_CALL destroy_hand(XrHandTrackerEXT) {
  return XR_SUCCESS;
}

/// Returns the recording's newest frame at a time since the session's start; the recording repeats.
const HandFrame& frame_at(double time) {
  const auto& frames = runtime->recording.frames;
  const double t = std::fmod(std::max(time, 0.0), frames.back().time + 0.2);
  return *std::prev(std::upper_bound(frames.begin() + 1, frames.end(), t,
                                     [](double x, const HandFrame& f) { return x < f.time; }));
}

void set_joint(const Hand& hand, std::size_t j, XrHandJointLocationEXT& joint) {
  const auto single = [](double x) { return static_cast<float>(x); };
  joint.locationFlags =
      XR_SPACE_LOCATION_POSITION_VALID_BIT | XR_SPACE_LOCATION_ORIENTATION_VALID_BIT;
  if (j >= runtime->inferred)
    joint.locationFlags |=
        XR_SPACE_LOCATION_POSITION_TRACKED_BIT | XR_SPACE_LOCATION_ORIENTATION_TRACKED_BIT;
  const prostm::Vec3& p = hand.position[j];
  const prostm::Quat& q = hand.orientation[j];
  joint.pose.position = {single(p.x()), single(p.y()), single(p.z())};
  joint.pose.orientation = {single(q.x()), single(q.y()), single(q.z()), single(q.w())};
  joint.radius = single(hand.radius[j]);
}

XrResult XRAPI_CALL locate_joints(XrHandTrackerEXT tracker, const XrHandJointsLocateInfoEXT* info,
                                  XrHandJointLocationsEXT* locations) {
  if (locations->jointCount != XR_HAND_JOINT_COUNT_EXT) return XR_ERROR_VALIDATION_FAILURE;
  locations->isActive = XR_FALSE;
  if (!runtime->begun) return XR_SUCCESS;
  const prostm::Side side = tracker == handle<XrHandTrackerEXT>(hand_handles[0])
                                ? prostm::Side::Left
                                : prostm::Side::Right;
  const HandFrame& frame = frame_at(1e-9 * static_cast<double>(info->time) - *runtime->begun);
  for (const Hand& hand : frame.hands) {
    if (hand.side != side) continue;
    locations->isActive = XR_TRUE;
    for (std::size_t j = 0; j < prostm::kJointCount; ++j)
      set_joint(hand, j, locations->jointLocations[j]);
  }
  return XR_SUCCESS;
}

struct Entry {
  const char* name;
  PFN_xrVoidFunction function;
};

template <class Function>
Entry entry(const char* name, Function function) {
  return {name, reinterpret_cast<PFN_xrVoidFunction>(function)};
}

XrResult XRAPI_CALL get_instance_proc_addr(XrInstance, const char* name,
                                           PFN_xrVoidFunction* function) {
  static const Entry kEntries[] = {
      entry("xrGetInstanceProcAddr", get_instance_proc_addr),
      entry("xrEnumerateInstanceExtensionProperties", enumerate_extensions),
      entry("xrCreateInstance", create_instance),
      entry("xrDestroyInstance", destroy_instance),
      entry("xrGetInstanceProperties", instance_properties),
      entry("xrPollEvent", poll_event),
      entry("xrGetSystem", get_system),
      entry("xrGetSystemProperties", system_properties),
      entry("xrCreateSession", create_session),
      entry("xrDestroySession", destroy_session),
      entry("xrBeginSession", begin_session),
      entry("xrEndSession", end_session),
      entry("xrEnumerateReferenceSpaces", reference_spaces),
      entry("xrCreateReferenceSpace", create_space),
      entry("xrDestroySpace", destroy_space),
      entry("xrConvertTimespecTimeToTimeKHR", convert_time),
      entry("xrCreateHandTrackerEXT", create_hand),
      entry("xrDestroyHandTrackerEXT", destroy_hand),
      entry("xrLocateHandJointsEXT", locate_joints)};
  const auto* found = std::find_if(std::begin(kEntries), std::end(kEntries),
                                   [&](const Entry& e) { return std::strcmp(e.name, name) == 0; });
  *function = found == std::end(kEntries) ? nullptr : found->function;
  return *function == nullptr ? XR_ERROR_FUNCTION_UNSUPPORTED : XR_SUCCESS;
}

}  // namespace

// The negotiation between loader and runtime, as specified by the loader: no package has a
// header for it.
struct XrNegotiateLoaderInfo {
  std::uint32_t structType, structVersion;
  std::size_t structSize;
  std::uint32_t minInterfaceVersion, maxInterfaceVersion;
  XrVersion minApiVersion, maxApiVersion;
};
struct XrNegotiateRuntimeRequest {
  std::uint32_t structType, structVersion;
  std::size_t structSize;
  std::uint32_t runtimeInterfaceVersion;
  XrVersion runtimeApiVersion;
  PFN_xrGetInstanceProcAddr getInstanceProcAddr;
};

extern "C" __attribute__((visibility("default"))) XrResult xrNegotiateLoaderRuntimeInterface(
    const XrNegotiateLoaderInfo* loader, XrNegotiateRuntimeRequest* request) {
  if (loader->minInterfaceVersion > 1 || loader->maxInterfaceVersion < 1)
    return XR_ERROR_INITIALIZATION_FAILED;
  request->runtimeInterfaceVersion = 1;
  request->runtimeApiVersion = XR_CURRENT_API_VERSION;
  request->getInstanceProcAddr = get_instance_proc_addr;
  return XR_SUCCESS;
}
