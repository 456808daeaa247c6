#include "prostm/acoustics/focus/array_output.hpp"

#include <algorithm>

namespace prostm {

ArrayOutput::ArrayOutput(const TransducerArray& array, const Medium& medium,
                         const ArrayOutputSettings& settings)
    : solver_(array, medium, settings.solver),
      transducers_(settings.transducer, array.position.size()),
      drives_(array.position.size()) {}

void ArrayOutput::step(std::span<const LiveFocus> foci) noexcept {
  solver_.solve(foci);
  for (std::size_t n = 0; n < drives_.size(); ++n) drives_[n] = solver_.drive().at(0, n);
  transducers_.step(drives_);
}

void ArrayOutput::reset() {
  solver_.reset();
  transducers_.reset();
  std::fill(drives_.begin(), drives_.end(), 0.0);
}

}  // namespace prostm
