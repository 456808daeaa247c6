#pragma once
/// The pose of the tracker in files: prostm-pose/1.

#include <string>
#include <string_view>

#include "prostm/core/geometry.hpp"
#include "prostm/track/calibration.hpp"

namespace prostm {

/// Returns the pose and the residuals of the calibration.
std::string pose_to_json(const Calibration& calibration);

/// Reads a pose. A quaternion within 1e-3 of length 1 is normalised; residuals may be omitted (0).
/// @throws InputError: not JSON, a missing value, or one out of bounds (positions within 5 m).
Calibration pose_from_json(std::string_view text, const std::string& file);
/// Reads a pose file. @throws InputError also if it cannot be read.
Calibration read_pose(const std::string& path);
/// Writes a pose file, completely or not at all. @throws InputError if it cannot be written.
void write_pose(const std::string& path, const Calibration& calibration);

/// Returns X_DT by name: "centre", one of kTrackerKits, or a file (.json). @throws InputError also
/// for an unknown name.
Pose tracker_pose_from_name(const std::string& name);

}  // namespace prostm
