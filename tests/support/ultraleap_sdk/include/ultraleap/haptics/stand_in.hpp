#pragma once
/// Controls of the stand-in, for tests: the available arrays, and faults.

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "ultraleap/haptics/streaming.hpp"

namespace ultraleap_stand_in {

namespace ulh = Ultraleap::Haptics;

struct Array {
  std::string identifier = "MockDevice:USX";
  std::string model = "USX", layout = "square", firmware = "3.1.0";
  std::vector<float> rates = {40e3F, 20e3F, 16e3F, 13333.3333F, 10e3F, 8e3F};  ///< [Hz], by points
  float separation = 0.01F;                                                    ///< [m]
  ulh::Vector3 centre = {};  ///< middle of the transducers
  bool streams = true;
  bool emitter_follows = true;  ///< a new number of points also changes the emitter's rate
};

/// Receives each sample as it is committed. Called by the emission's thread.
using Sink = std::function<void(ulh::LocalTimePoint, std::span<const ulh::ControlPoint>)>;

/// One service with some free arrays, stepped manually; discards all earlier state.
void reset(const std::vector<Array>& arrays);
void set_sink(Sink sink);
void set_service(bool runs);   ///< whether the service answers; "direct" always does
void set_manual(bool manual);  ///< no thread: step() calls back, in simulated time
void claim(const std::string& identifier, const std::string& owner);
void disconnect(const std::string& identifier);
void reconnect(const std::string& identifier);
void rescind(const std::string& identifier, const std::string& new_owner);
void report_error(const std::string& identifier, int code);
void end_service();
/// Makes later calls of that name fail with the message; "" restores them.
void refuse(const std::string& call, const std::string& message);
/// Changes the running emission's rate without notifying anyone [Hz].
void change_rate(float rate);

/// Calls back n times, like the emission's thread. @pre set_manual(true), an emission runs.
void step(int n);
void miss(int n);           ///< skips the next n callbacks while time passes
void make_late(bool late);  ///< passes deadlines that have already expired
void make_callback_late_in_destructor(bool wanted);

/// Number of the adapter's violations of the interface: a second walk, an unfinished
/// walk, a point that does not exist, numbers that are not finite, sounding points that are too
/// close, a listener added or removed in a callback, a callback with an array that was not claimed.
int violations();
std::string last_violation();
int emitters();  ///< existing ones
std::string owner(const std::string& identifier);
std::size_t control_points();  ///< of the newest emitter
long callbacks();

}  // namespace ultraleap_stand_in
