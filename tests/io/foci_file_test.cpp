#include "prostm/io/foci_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <nlohmann/json.hpp>

#include "prostm/acoustics/field/propagation.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/core/units.hpp"

namespace prostm {
namespace {

constexpr const char* kTwo = R"({"format": "prostm-foci/1", "foci": [
  {"position_mm": [20, -10, 200], "pressure_pa": 300},
  {"position_mm": [-20, 10, 180], "pressure_pa": 150}]})";

TEST(FociFile, ReadsPlacesAndPressures) {
  const FociFile foci = foci_from_json(kTwo, "two.json");
  ASSERT_EQ(foci.position.size(), 2u);
  EXPECT_EQ(foci.position[1], Vec3(-0.02, 0.01, 0.18));
  EXPECT_EQ(foci.pressure[0], 300.0);
}

TEST(FociFile, DrivesHoldAllThatReproducesThePressures) {
  const FociFile foci = foci_from_json(kTwo, "two.json");
  const TransducerArray array = autd3_array();
  const Propagation g = propagation_to(array, Medium{}, foci.position);
  const FocusSolution solution = solve_foci(g, Eigen::Vector2d(300.0, 150.0), {});
  const auto file = nlohmann::json::parse(drives_to_json(array, Medium{}, foci, solution));
  ASSERT_EQ(file["directivity"], "t4010a1");
  const double k = 2.0 * kPi / (1e-3 * file["wavelength_mm"].get<double>());
  for (std::size_t m = 0; m < 2; ++m) {
    std::complex<double> sum = 0.0;
    for (std::size_t n = 0; n < file["drives"].size(); ++n) {
      Vec3 way = foci.position[m];
      for (std::size_t i = 0; i < 3; ++i) {
        way[static_cast<Eigen::Index>(i)] -= 1e-3 * file["transducers_mm"][n][i].get<double>();
      }
      const double r = way.norm();
      sum += std::polar(file["drives"][n][0].get<double>() * file["amplitude_pa_m"].get<double>() /
                            r * directivity(Directivity::T4010A1, 0.0, way.z() / r) *
                            std::exp(-file["absorption_np_m"].get<double>() * r),
                        k * r + file["drives"][n][1].get<double>());
    }
    EXPECT_NEAR(std::abs(sum), file["reached_pa"][m].get<double>(), 1e-6);
  }
}

TEST(FociFile, RejectsInvalidFiles) {
  for (
      const char* text :
      {R"({"format": "prostm-foci/1", "foci": []})", R"({"format": "prostm-foci/1"})",
       R"({"format": "prostm-foci/1", "foci": [{"position_mm": [0, 0, 200]}]})",
       R"({"format": "prostm-foci/1", "foci": [{"position_mm": [0, 0], "pressure_pa": 1}]})",
       R"({"format": "prostm-foci/1", "foci": [{"position_mm": [0, 0, 200], "pressure_pa": -1}]})",
       R"({"format": "prostm-plan/1", "foci": [{"position_mm": [0, 0, 200], "pressure_pa": 1}]})"}) {
    EXPECT_THROW(foci_from_json(text, "f.json"), InputError) << text;
  }
}

}  // namespace
}  // namespace prostm
