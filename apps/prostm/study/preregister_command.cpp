#include <fmt/format.h>

#include <ctime>
#include <filesystem>

#include "common.hpp"
#include "prostm/core/file/file.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/core/require.hpp"
#include "prostm/study/plan/sha256.hpp"
#include "prostm/study/session/roster.hpp"
#include "prostm/study/session/study_sight.hpp"
#include "study/study_plan.hpp"
#include "study/study_protocol.hpp"

namespace prostm::app {
namespace {

/// @throws InputError: somebody has answered already.
void require_no_answers(const std::string& folder) {
  if (!std::filesystem::exists(folder)) return;
  for (const RosterEntry& entry : read_roster(response_files_in(folder))) {
    if (entry.rehearsal) continue;
    throw InputError(fmt::format(
        "{} has answers already, and a plan must be written before the first answer; give another "
        "folder with --answers if these are of another study",
        entry.file));
  }
}

void validate(const StudyPlan& plan) {
  require_between("alpha", plan.alpha, 0.0001, 0.5);
  require_between("chance", plan.chance, 0.01, 0.99);
  require_between("participants", plan.participants, 1, 9999);
  if (plan.equivalence) require_between("equivalence", *plan.equivalence, 1e-6, 1e6);
  const Exclusions& rules = plan.exclusions;
  if (rules.wrong_checks_above)
    require_between("exclude-wrong-checks", *rules.wrong_checks_above, 0.0, 1.0);
  if (rules.response_below) require_between("exclude-below", *rules.response_below, 0.0, 3600.0);
  if (rules.response_above) require_between("exclude-above", *rules.response_above, 0.0, 3600.0);
}

}  // namespace

int preregister_command(const PreregisterOptionsGiven& given) {
  require_no_answers(given.answers);
  if (std::filesystem::exists(given.out)) {
    throw InputError(given.out +
                     " exists; a plan is written once, so give another name or remove the file");
  }
  PipelineSettings base = study_settings(given.common);
  settle_hand(given.hand, given.hand_size, base);
  StudyPlan plan = given.plan;
  plan.test = from_name<PlannedTest>(given.test, "--test");
  plan.correction = from_name<Correction>(given.correction, "--correction");
  plan.created_utc = utc_text(static_cast<double>(std::time(nullptr)));
  std::vector<Protocol> protocols;
  for (const std::string& path : given.protocols) {
    protocols.push_back(live_protocol(path, base));
    plan.protocols.push_back({path, protocol_json(protocols.back())});
  }
  complete_plan(plan, protocols, given.each_scene);
  if (given.participants) plan.participants = *given.participants;
  validate(plan);
  const std::string text = plan_text(plan);
  write_file(given.out, text);
  fmt::print("{} planned comparisons of {} over {} participants, alpha {:g}, correction {}\n",
             plan.comparisons.size(), name_of(plan.measure), plan.participants, plan.alpha,
             name_of(plan.correction));
  fmt::print("SHA-256 of the plan: {}\n", sha256(text));
  say_written(stdout, given.out);
  return 0;
}

}  // namespace prostm::app
