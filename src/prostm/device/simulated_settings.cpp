// What a simulated array is told, and what it says of itself before it is made.
#include "prostm/device/simulated_array.hpp"

namespace prostm {

void SimulatedArraySettings::visit(SettingsVisitor& v) {
  v.field("sample_rate", sample_rate);
  v.field("block_samples", block_samples);
  v.field("max_foci", max_foci);
  v.field("queue_blocks", queue_blocks);
  v.field("most_queue_blocks", most_queue_blocks);
  v.field("history", history);
  v.field("realtime", realtime);
  v.field("solver", solver);
  v.field("memoryless", memoryless);
}

DeviceInfo SimulatedArray::info_of(const SimulatedArraySettings& settings,
                                   const TransducerArray& array) {
  return {.name = "simulated " + array.name,
          .sample_rate = settings.sample_rate,
          .block_samples = settings.block_samples,
          .max_foci = settings.max_foci,
          .intensity_per_focus = true,
          .streams = true,
          .loads_segments = true,
          .keeps_time = settings.realtime};
}

}  // namespace prostm
