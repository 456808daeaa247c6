#pragma once
/// The actions of participants and experimenters.

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string_view>

#include "prostm/core/text/names.hpp"

namespace prostm {

/// An action of the participant or the experimenter.
struct StudyAct {
  enum class Do : std::uint8_t {
    Next,     ///< continues from Ready, Break and Paused; closes a finished session
    Anyway,   ///< presents a trial although the gate does not pass or the page does not meet a need
    Answer,   ///< answers the question: `yes`, or `interval` if the task has several
    Correct,  ///< changes the last answer to the other one, until the next question
    Pause,    ///< pauses; an interrupted trial is presented again
    Consent,  ///< the participant agrees
    About,    ///< `about`
    Explore,  ///< in Training: the scene `scene`
    Withdraw,
    Tune,         ///< changes an adjustment's level by `steps`
    Accept,       ///< accepts the level: it feels like the standard
    EndTraining,  ///< ends Training before its time
    Practise      ///< in Ready, repeats a practice that ended without its criterion
  } what = Do::Next;
  bool yes = false;
  int scene = 0;
  nlohmann::ordered_json about = nlohmann::ordered_json::object();  ///< texts by name
  int interval = 0;                                                 ///< from 1
  int steps = 0;        ///< upwards; negative: downwards
  bool coarse = false;  ///< large steps
};
template <>
inline constexpr std::array<std::string_view, 13> kNames<StudyAct::Do> = {
    "next",    "anyway",   "answer", "correct", "pause",        "consent", "about",
    "explore", "withdraw", "tune",   "accept",  "end-training", "practise"};

}  // namespace prostm
