#pragma once
/// Focal points in files (prostm-foci/1), and the drives of an array that produce them.

#include <string>
#include <string_view>
#include <vector>

#include "prostm/acoustics/array/array.hpp"
#include "prostm/acoustics/focus/focus_solver.hpp"

namespace prostm {

struct FociFile {
  std::vector<Vec3> position;    ///< in D [m]
  std::vector<double> pressure;  ///< wanted acoustic pressure [Pa, rms]
};

/// Reads focal points. @throws InputError: not JSON, a missing or out-of-bounds value; no focal
/// point, or more than kMaxTransducers.
FociFile foci_from_json(std::string_view text, const std::string& file);
/// Reads a file of focal points. @throws InputError also if it cannot be read.
FociFile read_foci(const std::string& path);

/// prostm-drives/1: the drives in the array's order, the pressures that they reach, and everything
/// needed to recompute p = Σ amplitude · drive · D(θ)/r · e^{i(kr + phase) − αr}.
std::string drives_to_json(const TransducerArray& array, const Medium& medium, const FociFile& foci,
                           const FocusSolution& solution);

}  // namespace prostm
