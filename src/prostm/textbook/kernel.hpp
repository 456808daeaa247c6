#pragma once
/// The textbook planner's computation, on plain arrays. This header and its sources contain no
/// Eigen types: they are compiled once per instruction set, and Eigen's types may then be aligned
/// differently than in the rest of the program. Lengths in mm from the centre of cell (0, 0).

#include <cstdint>
#include <vector>

namespace prostm::textbook {

struct Field {
  int rows = 0, cols = 0;
  double cell = 0.0;                    ///< [mm]
  const double* pressure = nullptr;     ///< rows·cols
  const unsigned char* skin = nullptr;  ///< rows·cols
};

struct Settings {
  int paths = 4, clusters = 50, samples = 20;
  double max_length = 140.0, sigma = 8.6;                                  ///< [mm]
  double pressure = 3.0, length = 3.0, intersection = 1.0, bending = 0.3;  ///< weights
  double weak_pressure = 0.01;
  int lloyd_iterations = 100, refine_iterations = 200;
  std::uint64_t seed = 1;
};

struct Path {
  std::vector<double> x, y, pressure;  ///< the pressure is p* at each point, without γ
};

struct Result {
  std::vector<Path> paths;  ///< empty if there is no pressure on skin
  double init = 0, kmeans = 0, tour = 0, split = 0, resample = 0, refine = 0, total = 0;  ///< [s]
  int clusters = 0, leaves = 0, lloyd_iterations = 0, refine_iterations = 0, cost_evaluations = 0;
  double cost = 0;
};

/// Plans the paths of a field. @pre the field's pressures are finite and not negative.
Result run(const Field& field, const Settings& settings);

}  // namespace prostm::textbook
