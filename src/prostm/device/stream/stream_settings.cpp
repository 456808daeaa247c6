#include "prostm/device/stream/stream_settings.hpp"

#include <algorithm>
#include <cmath>

namespace prostm {
namespace {

template <class Settings, class Visitor>
void list(Settings& s, Visitor& v) {
  v.field({"block_samples", "", 1, 400, "samples that are sent at a time"}, s.block_samples);
  v.field({"lead_time", "s", 0.001, 0.2,
           "time from sending a block to playing it, for the delays of a network"},
          s.lead_time);
  v.field({"max_foci", "", 1, 8, "largest number of focal points of a sample"}, s.max_foci);
}

}  // namespace

int StreamSettings::queue_blocks() const {
  const double blocks = lead_time * kSampleRate / block_samples;
  return std::max(1, static_cast<int>(std::ceil(blocks - 1e-6)));
}

void StreamSettings::visit(SettingsReader& v) const {
  list(*this, v);
}
void StreamSettings::visit(SettingsWriter& v) {
  list(*this, v);
}

}  // namespace prostm
