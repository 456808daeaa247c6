#pragma once
/// What focus solvers cost and what they reach.

#include <vector>

#include "report.hpp"

namespace prostm::bench {

/// Times solutions for 1 to 32 focal points above the USX-like array, from positions to drives, one
/// core, beside TextbookGsPat in turns; and how many there are in a sample of 40 kHz.
void measure_speed(std::vector<Row>& rows);

/// Prints the errors of shares against the distance of the nearest other focal point, and the
/// levels, over `sets` random sets of 1 to 32 focal points with unequal targets, for every method.
void print_random_sets(int sets);

/// Prints what streams of moving focal points get: errors of shares, power, and how far the phases
/// of drives step from sample to sample, with and without the memory of the sample before.
void measure_streams(std::vector<Row>& rows);

/// Prints the radiation pressure that each of 1 to 8 focal points gets at full drive, over that of
/// one alone, and what rounding the phases of drives costs.
void print_power_and_rounding();

}  // namespace prostm::bench
