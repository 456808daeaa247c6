#pragma once
/// Path refinement of the textbook planner: the costs of Eqs. (2)–(5) and steepest descent with
/// backtracking.

#include <vector>

#include "textbook/kernel.hpp"

namespace prostm::textbook {

/// p*/max p* of the skin, interpolated by Catmull-Rom bicubics; zero elsewhere. Kept with a border
/// of zeros.
class Bicubic {
 public:
  Bicubic(const Field& field, double maximum);
  double value(double x, double y) const;
  /// Value, and its gradient [1/mm] in gx, gy.
  double value(double x, double y, double& gx, double& gy) const;

 private:
  static constexpr int kBorder = 3;
  const double* corner(double u, double v, double& s, double& t) const;

  int rows_, cols_, stride_;
  double cell_;
  std::vector<double> value_;
};

/// Steepest descent on the weighted sum of the four costs; x, y hold the samples of all paths, one
/// path after the other.
class Descent {
 public:
  Descent(const Bicubic& raster, const Settings& settings) : raster_(raster), s_(settings) {}
  void run(std::vector<double>& x, std::vector<double>& y, Result& result);

 private:
  using Coordinates = std::vector<double>;
  double cost(const Coordinates& x, const Coordinates& y) const;
  void gradient(const Coordinates& x, const Coordinates& y, Coordinates& gx, Coordinates& gy) const;

  const Bicubic& raster_;
  Settings s_;
};

}  // namespace prostm::textbook
