#pragma once
/// Markers: when each stimulus of a study began and ended on the array, for those who record
/// something else beside it.

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "prostm/study/protocol/protocol.hpp"
#include "prostm/study/session/session.hpp"

namespace prostm {

/// A stimulus, or training, between two mutes. It travels with the samples as their label.
struct Presentation {
  std::uint32_t number = 0;     ///< of this run, from 1: a trial may be presented again
  std::uint32_t trial = 0;      ///< from 1; 0: training
  std::uint16_t condition = 0;  ///< from 1, methods in rows of scenes; 0: is not told

  /// Numbers below 2²⁴ come back.
  std::uint64_t label() const;
  static Presentation of_label(std::uint64_t label);
  bool operator==(const Presentation&) const = default;
};

/// The presentation that a session wants now. The condition is told only if the protocol lets it.
Presentation presentation_of(const StudySession& session, std::uint32_t number);

/// The bytes that trigger boxes get, docs/study/study-files.md.
enum class MarkerCode : std::uint8_t {
  On = 1,
  Off = 2,
  OnAgain = 3,  ///< after a silence within the trial
  TrainingOn = 4,
  TrainingOff = 5,
  FirstCondition = 16  ///< On, of the first condition; others follow
};

/// The output began or ended.
struct Marker {
  std::int64_t sequence = 0;  ///< of this run, from 1
  bool on = false;
  Presentation presentation;
  int part = 1;  ///< of the presentation: sounds before it, and 1
  /// Emission of the presentation's newest plan; none without a plan, or where it is not told.
  std::optional<StudyPlayed> emission;
  std::int64_t stream = 0, sample = 0;
  double sample_rate = 0.0;  ///< of the device [Hz]
  /// When the sample leaves the array, by the clock that does not jump [s]; nothing if the device
  /// stopped before it could be asked.
  std::optional<double> played;
  double sent = 0.0;         ///< by the same clock [s]
  double utc_offset = 0.0;   ///< of the day's clock, since 1970, from the same clock [s]
  std::uint32_t failed = 0;  ///< bits of the targets that did not take it
};

std::uint8_t code_of(const Marker& marker);

/// Returns all that a marker says. Times in microseconds at best [s].
nlohmann::ordered_json marker_json(const Marker& marker, const Protocol& protocol, int run);

}  // namespace prostm
