#pragma once
// The pressure field of the examples: a strong and a weak bump on 120 x 120 mm of flat skin.
#include <cmath>
#include <prostm/target/target_field.hpp>

inline prostm::TargetField two_bumps() {
  prostm::TargetField field;
  field.cell = 0.005;                         // [m]
  field.origin = prostm::Vec2(-0.06, -0.06);  // the array's centre is below the skin's
  field.resize(24, 24);
  for (std::size_t i = 0; i < field.size(); ++i) {
    const prostm::Vec2 x = field.position(i);
    field.skin[i] = 1;
    field.pressure[i] = std::exp(-(x - prostm::Vec2(-0.02, 0.0)).squaredNorm() / 4e-4) +
                        0.5 * std::exp(-(x - prostm::Vec2(0.03, 0.02)).squaredNorm() / 2e-4);
  }
  return field;
}
