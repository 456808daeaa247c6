#pragma once
/// The parts of the lines that a session writes (docs/study/study-files.md).

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "prostm/core/geometry.hpp"
#include "prostm/stimulus/stimulus_gate.hpp"
#include "prostm/study/session/detail/rounded.hpp"
#include "prostm/study/session/response_file.hpp"
#include "prostm/study/session/study_sight.hpp"
#include "prostm/study/task/course.hpp"

namespace prostm::study {

/// [s, x, y, z in mm, quaternion x, y, z, w]
nlohmann::ordered_json pose_json(double time, const Pose& X_DP);
nlohmann::ordered_json gate_json(const std::optional<GateResult>& gate);
/// CRC-32 of everything that defines a trial's stimulus: the scene, and the settings with the
/// level.
std::string stimulus_hash(const Protocol& protocol, const Trial& trial);
/// Returns a number from a line of `file`. @throws InputError if it is missing.
double number_in(const ResponseLine& line, const char* key, const std::string& file);
/// Returns a sentence about a track at an end of its range; it names track and end only if the
/// study is not blind.
std::string bound_sentence(const Protocol& protocol, const Course::Lane& lane);
/// Returns the line with the time added.
ResponseLine stamped(ResponseLine line, const StudySight& sight);

}  // namespace prostm::study
