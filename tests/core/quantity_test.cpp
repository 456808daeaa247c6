#include "prostm/core/quantity.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>

namespace prostm {
namespace {

struct Trip {
  double length = 0.0;  // [m]
  int stops = 0;
  std::int64_t bumps = 0;
  double fastest = 0.0;  // [m/s]
  double fuel = 1.0;     // remaining fraction, 0..1
};

double bumps_per_km(const Trip& trip) {
  return trip.length > 0.0 ? 1e3 * static_cast<double>(trip.bumps) / trip.length : 0.0;
}

const std::array<Quantity<Trip>, 6> kTrip{{
    {.name = "length_km", .unit = "km", .help = "", .value = &Trip::length, .scale = 1e-3},
    {.name = "stops", .unit = "", .help = "", .value = &Trip::stops},
    {.name = "bumps", .unit = "", .help = "", .value = &Trip::bumps},
    {.name = "bumps_per_km", .unit = "1/km", .help = "", .value = &bumps_per_km},
    {.name = "fastest", .unit = "m/s", .help = "", .value = &Trip::fastest, .merge = Merge::Most},
    {.name = "fuel", .unit = "", .help = "", .value = &Trip::fuel, .merge = Merge::Newest},
}};

}  // namespace

template <>
std::span<const Quantity<Trip>> quantities<Trip>() {
  return kTrip;
}

namespace {

TEST(Quantity, GivesNumbersInSiAndIntegersAsSuch) {
  const Trip trip{2500.0, 3, 10, 30.0, 0.5};
  EXPECT_EQ(value_of(kTrip[0], trip), 2500.0);
  EXPECT_EQ(value_of(kTrip[1], trip), 3.0);
  EXPECT_EQ(value_of(kTrip[3], trip), 4.0);
  for (const Quantity<Trip>& quantity : kTrip) {
    const bool whole = visit_value(
        quantity, trip, [](auto value) { return std::is_same_v<decltype(value), std::int64_t>; });
    EXPECT_EQ(whole,
              quantity.name == std::string("stops") || quantity.name == std::string("bumps"));
  }
}

TEST(Quantity, MergesEachNumberByItsRule) {
  Trip sum{1000.0, 1, 2, 40.0, 0.9};
  merge({500.0, 2, 5, 30.0, 0.7}, sum);
  EXPECT_EQ(sum.length, 1500.0);
  EXPECT_EQ(sum.stops, 3);
  EXPECT_EQ(sum.bumps, 7);
  EXPECT_EQ(sum.fastest, 40.0);
  EXPECT_EQ(sum.fuel, 0.7);
}

}  // namespace
}  // namespace prostm
