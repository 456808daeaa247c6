#pragma once
/// The Gaussian blur of (Q5). Private to score.

#include <vector>

#include "prostm/target/target_field.hpp"

namespace prostm {

/// Gaussian means over the skin of one target: the blur of a field on skin over the blur of the
/// skin itself, which is computed once.
class SkinBlur {
 public:
  explicit SkinBlur(const TargetField& target);
  /// The blurred field, 0 off the skin. @pre field has rows·cols values of the target.
  std::vector<double> of(const std::vector<double>& field) const;

 private:
  std::vector<double> blur(const std::vector<double>& in) const;

  std::size_t rows_, cols_;
  std::vector<double> kernel_;      // from the middle outwards
  std::vector<double> skin_, sum_;  // 1 on skin; the blur of that
};

}  // namespace prostm
