// Settings of a simulated array, and its info without making one.
#include "prostm/device/simulated/simulated_array.hpp"

namespace prostm {

namespace {

template <class Settings, class Visitor>
void list(Settings& s, Visitor& v) {
  v.field({"sample_rate", "Hz", 1e3, 1e6, "sample rate of the focal points"}, s.sample_rate);
  v.field({"block_samples", "", 1, 4096, "samples that are pulled at a time"}, s.block_samples);
  v.field({"max_foci", "", 1, 8, "largest number of focal points of a sample"}, s.max_foci);
  v.field({"queue_blocks", "", 1, 10, "blocks queued ahead while the machine is calm"},
          s.queue_blocks);
  v.field({"most_queue_blocks", "", 1, 10, "blocks queued ahead at the beginning, and at most"},
          s.most_queue_blocks);
  v.field({"history", "s", 0, 600, "time for which samples are kept for reading back"}, s.history);
  v.field({.name = "realtime", .help = "whether a clock pulls the samples"}, s.realtime);
  v.field({.name = "solver",
           .help = "from focal points to drives: weighted, gs-pat or "
                   "superposition"},
          s.solver);
  v.field({.name = "memoryless", .help = "whether transducers follow their drives at once"},
          s.memoryless);
}

}  // namespace

void SimulatedArraySettings::visit(SettingsReader& v) const {
  list(*this, v);
}
void SimulatedArraySettings::visit(SettingsWriter& v) {
  list(*this, v);
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
