#pragma once
/// Messages for the user about the state of a live tracker, one for each change.

#include <cstdint>
#include <optional>
#include <string>

#include "prostm/track/hand_source.hpp"

namespace prostm {

/// Reports that the tracker is missing, connected, silent, lost, or reconnected. If it comes and
/// goes, its current state is reported at most every few seconds.
class TrackerNews {
 public:
  /// @param time since the start [s]; must not decrease.
  /// @return a sentence, or nothing if nothing changed.
  std::optional<std::string> look(const TrackerStatus& status, double time);

 private:
  enum class State : std::uint8_t { Unknown, Missing, Connected, Silent, Lost };
  State state_of(const TrackerStatus& status, double time);
  static const char* news_of_connection(State before);

  State told_ = State::Unknown;
  double told_at_ = 0.0;          // [s]
  double connected_since_ = 0.0;  // [s]
  bool connected_ = false, was_connected_ = false;
};

}  // namespace prostm
