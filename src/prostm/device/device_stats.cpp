#include <array>

#include "prostm/device/device.hpp"

namespace prostm {
namespace {

constexpr std::array<Quantity<DeviceStats>, 7> kStats{{
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
     .help = "Dropouts: block periods in which the queue was empty.",
     .value = &DeviceStats::missed_blocks,
     .better = Better::Less},
    // Causes of missed blocks: soak tests count only numbers that are better when less, so that
    // each block counts once
    {.name = "lost_links",
     .unit = "",
     .help = "Times that the link to the array was lost.",
     .value = &DeviceStats::lost_links},
    {.name = "lost_blocks",
     .unit = "",
     .help = "Of missed_blocks, those while the link was lost.",
     .value = &DeviceStats::lost_blocks},
    {.name = "slow_blocks",
     .unit = "",
     .help = "Of missed_blocks, those caused by a slow link.",
     .value = &DeviceStats::slow_blocks},
    {.name = "queue_blocks",
     .unit = "",
     .help = "Current depth of the queue.",
     .value = &DeviceStats::queue_blocks,
     .merge = Merge::Newest},
}};

}  // namespace

template <>
std::span<const Quantity<DeviceStats>> quantities<DeviceStats>() {
  return kStats;
}

}  // namespace prostm
