#pragma once
/// Plans of analyses: prostm study preregister, and prostm study analyse --plan.

#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "options.hpp"
#include "prostm/study/plan/planned_tests.hpp"
#include "prostm/study/plan/study_plan.hpp"

namespace prostm::app {

struct PreregisterOptionsGiven {
  CommonOptions common;
  std::vector<std::string> protocols;
  std::string out;
  std::string answers = "answers";  ///< folder of the response files
  std::string hand = "study";
  std::optional<double> hand_size;
  std::string test = "t", correction = "holm";
  bool each_scene = false;
  std::optional<int> participants;
  StudyPlan plan;
};
int preregister_command(const PreregisterOptionsGiven& options);

/// The options of prostm study analyse, with a plan.
struct PlannedAnalyseOptionsGiven : AnalyseOptionsGiven {
  std::string plan;  ///< file; empty: none
};
int planned_analyse_command(const PlannedAnalyseOptionsGiven& options);

/// A plan and its results.
struct Confirmed {
  std::string file;
  StudyPlan plan;
  ConfirmatoryResults results;
};

/// Reads a plan, checks that the answers are those of its protocols and came after it, and runs its
/// tests. @throws InputError: a changed plan, another protocol, earlier answers, or tables of
/// answers.
Confirmed confirm(const std::string& plan_file, const std::vector<std::string>& files,
                  const std::vector<Answer>& answers, std::uint64_t seed);

void print_confirmed(std::FILE* out, const Confirmed& of);
nlohmann::ordered_json confirmed_json(const Confirmed& of);

}  // namespace prostm::app
