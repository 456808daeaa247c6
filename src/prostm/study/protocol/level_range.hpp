#pragma once
/// The bounds of the levels of a study.

namespace prostm {

/// Bounds of the levels that a procedure may choose, on its scale.
struct LevelRange {
  double low = 0.0, high = 1.0;
};

}  // namespace prostm
