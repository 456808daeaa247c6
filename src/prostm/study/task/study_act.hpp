#pragma once
/// The acts of participants and experimenters.

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string_view>

#include "prostm/core/text/names.hpp"

namespace prostm {

/// An act of somebody at the study.
struct StudyAct {
  enum class Do : std::uint8_t {
    Next,     ///< goes on from Ready, Break and Paused; ends Training; closes what is over
    Anyway,   ///< presents a trial although the gate does not pass or the page lacks something
    Answer,   ///< to the question: `yes`, or `interval` where the task has several
    Correct,  ///< the last answer was the other one, before the next is asked for
    Pause,    ///< a trial under way is presented again
    Consent,  ///< the participant agrees
    About,    ///< `about`
    Explore,  ///< in Training: the scene `scene`
    Withdraw,
    Tune,   ///< an adjustment's level, by `steps`
    Accept  ///< it feels like the standard
  } what = Do::Next;
  bool yes = false;
  int scene = 0;
  nlohmann::ordered_json about = nlohmann::ordered_json::object();  ///< texts by name
  int interval = 0;                                                 ///< from 1
  int steps = 0;                                                    ///< up or, below 0, down
  bool coarse = false;                                              ///< large ones
};
template <>
inline constexpr std::array<std::string_view, 11> kNames<StudyAct::Do> = {
    "next",  "anyway",  "answer",   "correct", "pause", "consent",
    "about", "explore", "withdraw", "tune",    "accept"};

}  // namespace prostm
