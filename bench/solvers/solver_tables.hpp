#pragma once
/// Cost and accuracy of the focus solvers.

#include <vector>

#include "report.hpp"

namespace prostm::bench {

/// Times solutions for 1 to 32 focal points above the USX-like array, from positions to drives, on
/// one core, in turn with TextbookGsPat; prints how many fit into one sample at 40 kHz.
void measure_speed(std::vector<Row>& rows);

/// Prints the errors of shares by distance to the nearest other focal point, and the power by
/// number of focal points, for every method over `sets` random sets of 1 to 32 points with unequal
/// targets.
void print_random_sets(int sets);

/// Prints the results for streams of moving focal points: errors of shares, power, and the steps of
/// the drives' phases from sample to sample, with and without a warm start from the last sample.
void measure_streams(std::vector<Row>& rows);

/// Prints the radiation pressure at each of 1 to 8 focal points at full drive, relative to that of
/// a single one, and the cost of rounding the drives' phases.
void print_power_and_rounding();

}  // namespace prostm::bench
