#pragma once
/// The Gaussian blur of (Q5). Private to score.

#include <vector>

#include "prostm/core/worker_pool.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm {

/// Gaussian means over the skin of one target: the blur of a field on skin over the blur of the
/// skin itself, which is computed once.
class SkinBlur {
 public:
  /// @param pool runs the work in parallel if not null; must outlive this.
  explicit SkinBlur(const TargetField& target, WorkerPool* pool = nullptr);
  /// The blurred field, 0 off the skin. @pre field has rows·cols values of the target.
  std::vector<double> of(const std::vector<double>& field) const;

 private:
  std::size_t reach() const;  // half-width of the kernel, in cells
  std::vector<double> blur(const std::vector<double>& in) const;
  std::vector<double> columns(const std::vector<double>& in, std::size_t first,
                              std::size_t end) const;
  void sums_about(std::size_t first, std::size_t end, const double* strip, std::size_t low,
                  double* to) const;

  std::size_t rows_, cols_;
  std::vector<double> taps_;        // kernel along an axis, padded with zeros at both ends
  std::vector<double> skin_, sum_;  // 1 on skin; its blur
  WorkerPool* pool_;
};

}  // namespace prostm
