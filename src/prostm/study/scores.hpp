#pragma once
/// Participants' answers, as files hold them.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "prostm/core/names.hpp"

namespace prostm {

/// The meaning of an answer.
enum class AnswerKind : std::uint8_t {
  Right,    ///< it was right or wrong
  Felt,     ///< it was for the level or not: yes, or its interval, and neither is wrong
  Adjusted  ///< the level was tuned until it felt like another stimulus
};
template <>
inline constexpr std::array<std::string_view, 3> kNames<AnswerKind> = {"right", "felt", "adjusted"};

/// One answer of one participant.
struct Answer {
  std::string participant, method;
  std::string scene;                 ///< the stimulus
  bool correct = false;              ///< of kind Felt: for the level
  std::string question = {};         ///< the scene that was asked for; empty where it is not known
  bool yes = false;                  ///< the answer to it
  std::string trial = {};            ///< empty where it is not known
  std::optional<double> level = {};  ///< of the stimulus, where it was varied
  AnswerKind kind = AnswerKind::Right;

  bool operator==(const Answer&) const = default;
};

/// Reads answers from CSV (RFC 4180, UTF-8): a header with the columns participant, method, scene
/// and correct (0 or 1); where question (a scene) and answer (0 or 1) are there too, they must
/// agree with correct, where trial is, a participant has each of its numbers once, and where level
/// is, each row has a number there. All rows of kind, where it is, name the same one of AnswerKind.
/// Other columns are not read. @throws InputError with line and
/// column: a column or value that is missing or wrong, a row cut off.
std::vector<Answer> answers_from_csv(std::string_view text, const std::string& file);

/// Reads the scores of the paper's Fig. 4, {"fig4": {"trials_per_participant": n, "AM_1plume":
/// [right answers of each participant], …}}, as answers without questions: half of the trials had
/// one plume, half four. @throws InputError: what is missing, out of bounds or contradictory.
std::vector<Answer> answers_from_paper(std::string_view text, const std::string& file);

/// Reads the answers in a participant's file (response_file.hpp). @param notes gets a sentence
/// where not all trials were answered. @throws InputError: what responses_from_text() throws; no
/// first line of a study, a trial without its values.
std::vector<Answer> answers_from_responses(std::string_view text, const std::string& file,
                                           std::vector<std::string>& notes);

/// Reads one table (.csv) or the paper's scores (.json), or files of participants (.jsonl), by the
/// endings of their names. @throws InputError also when a file cannot be read, and for a
/// participant in two of them.
std::vector<Answer> read_answers(std::span<const std::string> paths,
                                 std::vector<std::string>& notes);

/// Returns answers as CSV (RFC 4180) for other programs, a row for each: the columns participant,
/// method, scene, trial, question, answer, correct, level and kind, those that are known.
/// answers_from_csv() reads the same answers from it. @pre all answers know the same columns.
std::string tidy_csv(std::span<const Answer> answers);

}  // namespace prostm
