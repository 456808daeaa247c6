#include "prostm/emit/detail/envelope.hpp"

#include <cmath>
#include <stdexcept>

#include "prostm/core/units.hpp"

namespace prostm {

Waveform waveform_from_name(const std::string& name) {
  if (name == "raised-cosine") return Waveform::RaisedCosine;
  if (name == "sine-magnitude") return Waveform::SineMagnitude;
  throw std::invalid_argument("am_waveform = \"" + name +
                              "\" must be \"sine-magnitude\" or \"raised-cosine\"");
}

double envelope(Waveform waveform, double turns) {
  const double sine = std::sin(kPi * turns);
  return waveform == Waveform::RaisedCosine ? sine * sine : std::abs(sine);
}

}  // namespace prostm
