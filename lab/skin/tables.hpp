#pragma once
/// Tables of the experiments of prostm/experiments: each prints its table, appends its numbers to
/// `rows`, and draws a picture if `figure` names a file.

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
/// Gain by period and strength by speed of loops of 35 to 140 mm: the paper's open problems (iv)
/// and (v), answered by the model.
void compute_loops(const std::string& figure, std::vector<Row>& rows);
/// Measures the cost of a response.
void measure_response(std::vector<Row>& rows);

/// Returns a row with one value.
Row value_row(const std::string& name, const std::string& unit, double value);

}  // namespace prostm::bench
