#include "prostm/study/live/presented.hpp"

#include <algorithm>
#include <string>

namespace prostm {

PipelineSettings settings_for(const Protocol& protocol, const StudyWanted& wanted) {
  PipelineSettings settings =
      wanted.standard ? protocol.standard->settings
                      : protocol.methods[static_cast<std::size_t>(wanted.method)].settings;
  if (wanted.level) set_level(settings, protocol.level.setting, *wanted.level);
  settings.scene = wanted.scene < 0 ? std::string("still-air")
                                    : protocol.scenes[static_cast<std::size_t>(wanted.scene)].name;
  return settings;
}

std::optional<StudyPlayed> played_of(const PlanSnapshot& plan) {
  if (!plan.planned || !plan.settings) return std::nullopt;
  StudyPlayed out;
  if (!plan.plan.foci.empty()) {
    out.period = am_period(plan.settings->emit, plan.emission_rate) / plan.emission_rate;
    return out;
  }
  for (const PlayedPath& path : plan.played.paths) {
    out.speed += path.speed / static_cast<double>(plan.played.paths.size());
    out.period = std::max(out.period, path.period);
  }
  out.changed = plan.played.changed_paths();
  return out;
}

}  // namespace prostm
