#pragma once
/// Published experiments with focal points on skin, computed with the skin model of docs/design.md,
/// section 10. Each prints its tables, appends its figures to `rows`, and draws a picture on
/// request. docs/experiments has a page on each.

#include <string>
#include <vector>

#include "report.hpp"

namespace prostm::bench {

/// Perceived intensity of circles against speed, compared with Frier et al. 2018.
void compute_circles(const std::string& figure, std::vector<Row>& rows);
/// Squares of 1 and 3 cm, compared with Reardon et al. 2023.
void compute_squares(const std::string& figure, std::vector<Row>& rows);
/// A focal point on a straight line, compared with Reardon et al. 2019.
void compute_regimes(const std::string& figure, std::vector<Row>& rows);
/// Two modulated foci side by side, compared with Howard et al. 2023.
void compute_gap(const std::string& figure, std::vector<Row>& rows);
/// Measures the cost of a response.
void measure_response(std::vector<Row>& rows);

/// Returns a row with one value.
Row value_row(const std::string& name, const std::string& unit, double value);

/// Returns the x of a curve's maximum over equally spaced x, by a parabola through the highest
/// value and its neighbours; at an end, that end. @pre as many y as x, at least 3.
double peak_place(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace prostm::bench
