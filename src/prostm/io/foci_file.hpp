#pragma once
/// Focal points in files, prostm-foci/1, and what an array is driven with to make them.

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

/// @throws InputError with a sentence: what is not JSON, missing, or out of bounds; no focal point,
/// or more than kMaxTransducers.
FociFile foci_from_json(std::string_view text, const std::string& file);
/// The same from a file. @throws InputError also when it cannot be read.
FociFile read_foci(const std::string& path);

/// prostm-drives/1: the drives in the array's order, what they reach, and all that is needed to
/// compute p = Σ amplitude · drive · D(θ)/r · e^{i(kr + phase) − αr} again.
std::string drives_to_json(const TransducerArray& array, const Medium& medium, const FociFile& foci,
                           const FocusSolution& solution);

}  // namespace prostm
