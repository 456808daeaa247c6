#pragma once
/// Markers: the times at which each stimulus of a study began and ended on the array, for
/// synchronisation with other recordings.

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "prostm/study/protocol/protocol.hpp"
#include "prostm/study/session/session.hpp"

namespace prostm {

/// A stimulus, or training, between two mutes. Samples carry it as their label.
struct Presentation {
  std::uint32_t number = 0;  ///< counts presentations of this run, from 1; a trial may have several
  std::uint32_t trial = 0;   ///< from 1; 0: training or practice
  std::uint16_t condition = 0;  ///< from 1, scenes varying fastest; 0: not disclosed

  /// Packs the presentation; numbers below 2²⁴ are preserved.
  std::uint64_t label() const;
  static Presentation of_label(std::uint64_t label);
  bool operator==(const Presentation&) const = default;
};

/// The presentation that a session wants now. Its condition is set only if the protocol allows it.
Presentation presentation_of(const StudySession& session, std::uint32_t number);

/// The bytes sent to trigger boxes (docs/study/study-files.md).
enum class MarkerCode : std::uint8_t {
  On = 1,
  Off = 2,
  OnAgain = 3,  ///< after a silence within the trial
  TrainingOn = 4,
  TrainingOff = 5,
  FirstCondition = 16  ///< On for the first condition; the others follow
};

/// The start or the end of output.
struct Marker {
  std::int64_t sequence = 0;  ///< counts markers of this run, from 1
  bool on = false;
  Presentation presentation;
  int part = 1;  ///< part of the presentation, from 1; silences separate parts
  /// Emission of the presentation's newest plan; none without a plan, or if the condition is not
  /// disclosed.
  std::optional<StudyPlayed> emission;
  std::int64_t stream = 0, sample = 0;
  double sample_rate = 0.0;  ///< of the device [Hz]
  /// Time at which the sample leaves the array, by the steady clock [s]; nothing if the device had
  /// already stopped.
  std::optional<double> played;
  double sent = 0.0;         ///< time of sending, by the steady clock [s]
  double utc_offset = 0.0;   ///< Unix time minus the steady clock [s]
  std::uint32_t failed = 0;  ///< bit i: sending to target i failed
};

std::uint8_t code_of(const Marker& marker);

/// Returns all fields of a marker. Times in seconds are rounded to a microsecond.
nlohmann::ordered_json marker_json(const Marker& marker, const Protocol& protocol, int run);

}  // namespace prostm
