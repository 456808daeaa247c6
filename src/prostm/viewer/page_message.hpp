#pragma once
/// The messages of a page: the text messages of docs/reference/wire.md.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "prostm/study/session/session.hpp"

namespace prostm {

inline constexpr std::size_t kMaxPageMessage = 4096;                                ///< bytes
inline constexpr double kMinPageRate = 1.0, kMaxPageRate = 60.0, kPageRate = 30.0;  ///< [Hz]

/// A control is turned; whether there is such a control, and within what bounds, is not known here.
struct SetMessage {
  std::string id;
  std::variant<double, bool, std::string> value;
};

struct TransportMessage {
  enum class Do { Play, Pause, Step, Seek } what = Do::Play;
  double time = 0.0;  ///< of Seek, in the recording [s], ≥ 0
};

/// The page's hand. Angles are 0 for a palm down with the fingers along +y.
struct HandMessage {
  bool release = false;                       ///< it lets go, and nothing else counts
  bool hidden = false;                        ///< of a release: nobody sees the page any more
  bool take = false;                          ///< takes the hand from another page that holds it
  double palm[3] = {};                        ///< in D [m], each within 0.5 m
  double yaw = 0.0, pitch = 0.0, roll = 0.0;  ///< [rad]
  double closure = 0.0;                       ///< 0 open to 1 closed
  bool left = false;
};

struct CalibrationMessage {
  enum class Do { Begin, Take, Solve, Save, Cancel } what = Do::Begin;
  std::optional<int> mark;  ///< of Take, from 0
};

/// Silences the output until a page asks for it again.
struct MuteMessage {
  bool on = true;
};

struct RateMessage {
  double rate = kPageRate;  ///< [Hz], kMinPageRate to kMaxPageRate
};

/// PageReport is the participant's page's (study/session/participant_page.hpp).
using PageMessage = std::variant<SetMessage, TransportMessage, HandMessage, CalibrationMessage,
                                 MuteMessage, RateMessage, StudyAct, PageReport>;

/// Reads one message; never throws for its contents. @return false for an invalid message, with one
/// sentence in `problem` that says what would be right.
bool read_page_message(std::string_view text, PageMessage& out, std::string& problem);

}  // namespace prostm
