#include <array>

#include "prostm/contact/skin_contact.hpp"

namespace prostm {

double steep_share(const ContactStats& s) {
  const std::int64_t all = s.skin_cells + s.steep_cells;
  return all > 0 ? static_cast<double>(s.steep_cells) / static_cast<double>(all) : 0.0;
}

namespace {

constexpr std::array<Quantity<ContactStats>, 6> kStats{{
    {.name = "skin_cells",
     .unit = "",
     .help = "Target cells with skin, over all updates.",
     .value = &ContactStats::skin_cells},
    {.name = "skin_area_cm2",
     .unit = "cm2",
     .help = "Area of this skin, weighted by the fade of its pressure, over all updates.",
     .value = &ContactStats::skin_area,
     .scale = 1e4},
    {.name = "steep_cells",
     .unit = "",
     .help = "Cells too steep for the array to press on.",
     .value = &ContactStats::steep_cells,
     .better = Better::Less},
    {.name = "steep_share",
     .unit = "",
     .help = "Share of the hands' skin that is too steep.",
     .value = &steep_share,
     .better = Better::Less},
    {.name = "joints",
     .unit = "",
     .help = "Joint positions of the hands, over all updates.",
     .value = &ContactStats::joints},
    {.name = "joints_outside",
     .unit = "",
     .help = "Joint positions outside the box.",
     .value = &ContactStats::joints_outside,
     .better = Better::Less},
}};

}  // namespace

template <>
std::span<const Quantity<ContactStats>> quantities<ContactStats>() {
  return kStats;
}

}  // namespace prostm
