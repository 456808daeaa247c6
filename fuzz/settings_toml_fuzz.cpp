/// Settings: any text sets fields of every type, or gives an InputError.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "prostm/core/input_error.hpp"
#include "prostm/io/settings_file.hpp"
#include "prostm/plan/planner.hpp"
#include "prostm/track/hand_source.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace prostm;
  PlanSettings plan;
  ScriptedHandSettings hand;
  const std::vector<SettingsGroup> groups = {group_of("plan", plan),
                                             group_of("scripted_hand", hand)};
  try {
    settings_from_toml({reinterpret_cast<const char*>(data), size}, "fuzz.toml", groups);
    if (!std::isfinite(plan.sigma)) std::abort();
    static_cast<void>(settings_to_json(groups).size());
  } catch (const InputError&) {
    // the required answer to bad input
  }
  return 0;
}
