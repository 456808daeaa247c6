#include "prostm/io/widths_file.hpp"

#include <gtest/gtest.h>

#include <array>

#include "prostm/core/units.hpp"

namespace prostm {
namespace {

TEST(WidthsFile, IsInMillimetresWithTheDigitsOfMetres) {
  const std::array entries{FocusWidthEntry{0.15, 0.03, kPi / 4.0, {0.0111, 0.00857, 1234.5}}};
  EXPECT_EQ(widths_to_json("usx", entries),
            R"({
  "format": "prostm-widths/1",
  "array": "usx",
  "widths": [
    {
      "height_mm": 150.0,
      "offset_mm": 30.0,
      "tilt_deg": 45.0,
      "sigma_along_mm": 11.1,
      "sigma_across_mm": 8.57,
      "pressure_pa": 1234.5
    }
  ]
}
)");
}

}  // namespace
}  // namespace prostm
