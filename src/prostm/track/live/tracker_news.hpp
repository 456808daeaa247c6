#pragma once
/// The news of a live tracker for those who wait for its hands, each change once.

#include <cstdint>
#include <optional>
#include <string>

#include "prostm/track/hand_source.hpp"

namespace prostm {

/// Tells that the tracker is missing, is there, sends nothing, is lost, is back. One that comes and
/// goes is told at most every few seconds, with the state that it has then.
class TrackerNews {
 public:
  /// @param time since the start, never before that of the call before [s].
  /// @return a sentence, or nothing where there is nothing new.
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
