#include "prostm/acoustics/skin/detail/fft2.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "prostm/core/random.hpp"
#include "prostm/core/units.hpp"

namespace prostm {
namespace {

using Complex = std::complex<double>;

std::vector<Complex> random_raster(int rows, int cols) {
  Random random(static_cast<std::uint64_t>(rows * 100 + cols));
  std::vector<Complex> raster(static_cast<std::size_t>(rows * cols));
  for (Complex& x : raster) x = {random.normal(), random.normal()};
  return raster;
}

/// Returns the sum of fft2.hpp, term by term.
Complex transformed(const std::vector<Complex>& raster, int rows, int cols, int u, int v) {
  Complex sum = 0.0;
  for (int j = 0; j < rows; ++j) {
    for (int m = 0; m < cols; ++m) {
      const double turns = static_cast<double>(u * j) / rows + static_cast<double>(v * m) / cols;
      sum += raster[static_cast<std::size_t>(j * cols + m)] * std::polar(1.0, -2.0 * kPi * turns);
    }
  }
  return sum;
}

TEST(Fft2, MatchesTheSumAndItsInverseForEveryShapeEvenOneRowOrColumn) {
  for (const auto& [rows, cols] :
       {std::pair{1, 1}, {1, 2}, {2, 1}, {1, 20}, {20, 1}, {3, 4}, {5, 9}}) {
    const std::vector<Complex> raster = random_raster(rows, cols);
    std::vector<Complex> out = raster;
    Fft2 fft(rows, cols);
    fft.forward(out, rows);
    for (int u = 0; u < rows; ++u) {
      for (int v = 0; v < cols; ++v) {
        EXPECT_LT(std::abs(out[static_cast<std::size_t>(u * cols + v)] -
                           transformed(raster, rows, cols, u, v)),
                  1e-12)
            << rows << " x " << cols;
      }
    }
    fft.inverse(out, rows);
    for (std::size_t i = 0; i < raster.size(); ++i) EXPECT_LT(std::abs(out[i] - raster[i]), 1e-12);
  }
}

}  // namespace
}  // namespace prostm
