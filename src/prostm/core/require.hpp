#pragma once
/// Bounds of settings, and the shared error message for out-of-range values.

namespace prostm {

/// Returns when `value` is finite and low ≤ value ≤ high.
/// @param unit printed after the numbers, e.g. "m/s"; empty if dimensionless.
/// @throws std::invalid_argument "height = 1 m must be between 0.1 and 0.6 m".
void require_between(const char* name, double value, double low, double high,
                     const char* unit = "");
/// The same for whole numbers: "clusters = 0 must be between 1 and 50".
void require_between(const char* name, int value, int low, int high, const char* unit = "");

}  // namespace prostm
