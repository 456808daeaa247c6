#include "prostm/emit/detail/envelope.hpp"

#include <cmath>

#include "prostm/core/units.hpp"

namespace prostm {

double envelope(Waveform waveform, double turns) {
  const double sine = std::sin(kPi * turns);
  return waveform == Waveform::RaisedCosine ? sine * sine : std::abs(sine);
}

}  // namespace prostm
