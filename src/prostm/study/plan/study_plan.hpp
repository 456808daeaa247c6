#pragma once
/// The analysis plan of a study, written before the first answer.

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "prostm/core/text/names.hpp"
#include "prostm/study/protocol/protocol.hpp"

namespace prostm {

inline constexpr const char* kStudyPlanFormat = "prostm-study-plan/1";  ///< in the first line

/// The value of a participant that planned tests compare.
enum class Measure : std::uint8_t {
  Right,      ///< share of right answers
  Threshold,  ///< fitted to the participant's answers
  Level       ///< mean of adjusted levels
};
template <>
inline constexpr std::array<std::string_view, 3> kNames<Measure> = {"right", "threshold", "level"};

/// The planned test over participants.
enum class PlannedTest : std::uint8_t { T, Permutation };
template <>
inline constexpr std::array<std::string_view, 2> kNames<PlannedTest> = {"t", "permutation"};

enum class Correction : std::uint8_t { Holm, None };
template <>
inline constexpr std::array<std::string_view, 2> kNames<Correction> = {"holm", "none"};

/// Rules by which answers are left out of the planned tests.
struct Exclusions {
  bool incomplete = false;       ///< participants who did not finish their session
  bool overridden_gate = false;  ///< trials presented although the gate did not pass
  bool failed_practice = false;  ///< participants who did not reach the criterion of a practice
  /// participants by their share of wrong answers to catch and attention trials
  std::optional<double> wrong_checks_above;
  std::optional<double> response_below, response_above;  ///< trials by response time [s]
};

/// One planned comparison, of methods in a scene or in all scenes together.
struct PlannedComparison {
  std::string scene;          ///< empty: all scenes
  std::string first, second;  ///< methods; without `second`, `first` is compared with chance
};

/// A protocol of the plan, as participants' files have it.
struct PlannedProtocol {
  std::string file;
  nlohmann::ordered_json protocol;
};

struct StudyPlan {
  std::string created_utc;
  std::vector<PlannedProtocol> protocols;
  int participants = 0;  ///< planned
  Measure measure = Measure::Right;
  PlannedTest test = PlannedTest::T;
  double alpha = 0.05;
  double chance = 0.5;
  Correction correction = Correction::Holm;
  std::optional<double> equivalence;  ///< bound of two one-sided tests, in the measure's unit
  Exclusions exclusions;
  std::vector<std::string> notes;  ///< hypotheses and other decisions, in the researcher's words
  std::vector<PlannedComparison> comparisons;
  std::string sha256;  ///< of the file; set by plan_from_text()
};

/// Fills in measure, planned participants and comparisons from the protocols: each pair of methods
/// in all scenes together, or a single method with chance. @param each_scene compare in each scene,
/// too. @throws InputError: no protocol, protocols whose tasks or methods differ, or a single
/// method whose answers are not right or wrong.
void complete_plan(StudyPlan& plan, std::span<const Protocol> protocols, bool each_scene);

/// The plan as text: a JSON object on each line, which ends with a check of the text before it.
std::string plan_text(const StudyPlan& plan);
/// Reads a plan. @throws InputError with file and line: a line that was changed, moved or removed;
/// a missing or invalid value.
StudyPlan plan_from_text(std::string_view text, const std::string& file);

/// Checks that a protocol is one of the plan's. Threads, tracker and the simulated array's clock
/// are not compared.
/// @param where names the protocol in messages, "answers/participant-1.jsonl, line 1".
/// @throws InputError naming the settings that differ.
void require_planned(const nlohmann::ordered_json& protocol, const std::string& where,
                     const StudyPlan& plan, const std::string& plan_file);

}  // namespace prostm
