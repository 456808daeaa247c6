#include <array>

#include "prostm/device/device.hpp"

namespace prostm {
namespace {

constexpr std::array<Quantity<DeviceStats>, 4> kStats{{
    {.name = "blocks",
     .unit = "",
     .help = "Blocks of samples that the device was given.",
     .value = &DeviceStats::blocks},
    {.name = "late_blocks",
     .unit = "",
     .help = "Blocks filled after their deadline.",
     .value = &DeviceStats::late_blocks,
     .better = Better::Less},
    {.name = "missed_blocks",
     .unit = "",
     .help = "Block times at which the queue had run dry.",
     .value = &DeviceStats::missed_blocks,
     .better = Better::Less},
    {.name = "queue_blocks",
     .unit = "",
     .help = "Depth of the queue now.",
     .value = &DeviceStats::queue_blocks,
     .merge = Merge::Newest},
}};

}  // namespace

template <>
std::span<const Quantity<DeviceStats>> quantities<DeviceStats>() {
  return kStats;
}

}  // namespace prostm
