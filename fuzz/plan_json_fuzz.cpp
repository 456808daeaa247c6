/// prostm-plan/1: any text is a plan that survives a round trip, or an InputError.
#include <cstdint>
#include <cstdlib>

#include "prostm/core/input_error.hpp"
#include "prostm/io/plan_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace prostm;
  try {
    const PlanFile file = plan_from_json({reinterpret_cast<const char*>(data), size}, "fuzz.json");
    validate(file.raster);
    PlanFileExtras extras;
    extras.method = file.method;
    const PlanFile back =
        plan_from_json(plan_to_json(file.plan, file.raster, extras, {}), "back.json");
    if (back.plan.paths.size() != file.plan.paths.size()) std::abort();
    if (back.plan.foci.size() != file.plan.foci.size()) std::abort();
  } catch (const InputError&) {
    // the required answer to bad input
  }
  return 0;
}
