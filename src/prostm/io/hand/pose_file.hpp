#pragma once
/// Where the tracker is, in files: prostm-pose/1.

#include <string>
#include <string_view>

#include "prostm/core/geometry.hpp"
#include "prostm/track/calibration.hpp"

namespace prostm {

/// The pose, and what the calibration left.
std::string pose_to_json(const Calibration& calibration);

/// A quaternion within 1e-3 of length 1 is made a unit one; residuals may be left out (0).
/// @throws InputError with a sentence: what is not JSON, missing, or out of bounds (positions
/// within 5 m).
Calibration pose_from_json(std::string_view text, const std::string& file);
/// The same from a file. @throws InputError also when it cannot be read.
Calibration read_pose(const std::string& path);
/// Writes it whole or not at all. @throws InputError when it cannot be written.
void write_pose(const std::string& path, const Calibration& calibration);

/// X_DT by name: "centre", one of kTrackerKits, or a file (.json). @throws InputError also for
/// another name.
Pose tracker_pose_from_name(const std::string& name);

}  // namespace prostm
