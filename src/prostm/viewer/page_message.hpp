#pragma once
/// The messages from a page: the text messages of docs/reference/wire.md.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "prostm/study/session/session.hpp"

namespace prostm {

inline constexpr std::size_t kMaxPageMessage = 4096;                                ///< bytes
inline constexpr double kMinPageRate = 1.0, kMaxPageRate = 60.0, kPageRate = 30.0;  ///< [Hz]

/// Sets a control. Its existence and bounds are not checked here.
struct SetMessage {
  std::string id;
  std::variant<double, bool, std::string> value;
};

struct TransportMessage {
  enum class Do { Play, Pause, Step, Seek } what = Do::Play;
  double time = 0.0;  ///< for Seek: time in the recording [s], ≥ 0
};

/// The page's hand. Angles are 0 for a palm down with the fingers along +y.
struct HandMessage {
  bool release = false;  ///< releases the hand; the other members except `hidden` are unused
  bool hidden = false;   ///< for a release: because the page is hidden
  bool take = false;     ///< takes the hand over from another page
  double palm[3] = {};   ///< in D [m], each within 0.5 m
  double yaw = 0.0, pitch = 0.0, roll = 0.0;  ///< [rad]
  double closure = 0.0;                       ///< from 0 (open) to 1 (closed)
  bool left = false;
};

struct CalibrationMessage {
  enum class Do { Begin, Take, Solve, Save, Cancel } what = Do::Begin;
  std::optional<int> mark;  ///< for Take: from 0
};

/// Mutes the output until a page unmutes it.
struct MuteMessage {
  bool on = true;
};

struct RateMessage {
  double rate = kPageRate;  ///< [Hz], kMinPageRate to kMaxPageRate
};

/// PageReport comes from the participant's page (study/session/participant_page.hpp).
using PageMessage = std::variant<SetMessage, TransportMessage, HandMessage, CalibrationMessage,
                                 MuteMessage, RateMessage, StudyAct, PageReport>;

/// Reads one message; does not throw for invalid content. @return false for an invalid message,
/// with a sentence in `problem` that says what is required.
bool read_page_message(std::string_view text, PageMessage& out, std::string& problem);

}  // namespace prostm
