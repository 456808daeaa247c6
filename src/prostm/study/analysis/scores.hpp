#pragma once
/// Participants' answers, as files hold them.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "prostm/core/text/names.hpp"

namespace prostm {

/// The meaning of an answer.
enum class AnswerKind : std::uint8_t {
  Right,    ///< it was right or wrong
  Felt,     ///< it was for the level or not: yes, or its interval, and neither is wrong
  Adjusted  ///< the level was tuned until it felt like another stimulus
};
template <>
inline constexpr std::array<std::string_view, 3> kNames<AnswerKind> = {"right", "felt", "adjusted"};

/// The run that an answer is from; each part is empty where it is not known.
struct RunFacts {
  std::string protocol;  ///< checksum of all of it
  std::string version, device, array, hand;

  bool operator==(const RunFacts&) const = default;
};

/// One trial of one participant, with the answer unless that is missing.
struct Answer {
  std::string participant, method;
  std::string scene;                 ///< the stimulus
  bool correct = false;              ///< of kind Felt: for the level
  std::string question = {};         ///< the scene that was asked for; empty where it is not known
  bool yes = false;                  ///< the answer to it
  std::string trial = {};            ///< empty where it is not known
  std::optional<double> level = {};  ///< of the stimulus, where it was varied
  AnswerKind kind = AnswerKind::Right;
  bool answered =
      true;  ///< false: no answer was given, and correct, question and yes are not known
  std::optional<double> response_s = {};  ///< time to the answer [s], where it is known
  std::string stimulus = {};              ///< checksum of its settings, where it is known
  std::string gate =
      {};  ///< of the stimulus: "pass", "fail", "anyway"; empty where it was not asked
  RunFacts run = {};

  bool operator==(const Answer&) const = default;
};

/// A prefix of participants' names, so that two people with one name are told apart.
enum class IdPrefix : std::uint8_t {
  None,    ///< a name that is in several files is of one person
  Folder,  ///< the file's folder
  File     ///< the file's name, with its folder where that is needed
};
template <>
inline constexpr std::array<std::string_view, 3> kNames<IdPrefix> = {"none", "folder", "file"};

/// How files of answers are read.
struct ReadingSettings {
  std::string columns;              ///< of tables: "correct=key_resp.corr,method:=am"
  std::vector<std::string> rename;  ///< "participant:OLD=NEW", also method: and scene:
  std::optional<IdPrefix> prefix;   ///< nothing: a name in several files is refused
  bool merge_spellings = false;     ///< names that differ in spelling alone are one
  bool pool = false;                ///< answers to different stimuli are taken together
};

/// Reads answers from a table: a header with the columns participant, method, scene and correct,
/// separated by commas, semicolons, tabs or "|", in UTF-8, UTF-16 or Windows-1252. Where question
/// (a scene) and answer are there too, they must agree with correct; where level is, each row has a
/// number there. All rows of kind, where it is, name the same one of AnswerKind. A row whose
/// correct, answer or response is missing is a trial without an answer; one without a method and a
/// scene is not a trial. Other columns are not read (docs/study/study-files.md).
/// @param columns "correct=key_resp.corr,method:=am": names of the table's own columns, and values
/// for all rows. @param notes if given, gets sentences about what was left out or merged.
/// @throws InputError with line and column: a column or value that is missing or wrong, a row cut
/// off or copied.
std::vector<Answer> answers_from_csv(std::string_view text, const std::string& file,
                                     const std::string& columns = {},
                                     std::vector<std::string>* notes = nullptr);

/// Reads the scores of the paper's Fig. 4, {"fig4": {"trials_per_participant": n, "AM_1plume":
/// [right answers of each participant], …}}, as answers without questions: half of the trials had
/// one plume, half four. @throws InputError: what is missing, out of bounds or contradictory.
std::vector<Answer> answers_from_paper(std::string_view text, const std::string& file);

/// Reads the answers in a participant's file (response_file.hpp). @param notes gets a sentence
/// where not all trials were answered. @throws InputError: what responses_from_text() throws; no
/// first line of a study, a trial without its values.
std::vector<Answer> answers_from_responses(std::string_view text, const std::string& file,
                                           std::vector<std::string>& notes);

/// Reads tables (.csv, .tsv, .txt), files of participants (.jsonl), or the paper's scores (.json,
/// alone), by the endings of their names. @throws InputError also when a file cannot be read or is
/// given twice, for a participant in two files, names that differ in spelling alone, and different
/// stimuli under one name, unless settings allow them.
std::vector<Answer> read_answers(std::span<const std::string> paths,
                                 std::vector<std::string>& notes,
                                 const ReadingSettings& settings = {});

/// Returns answers as CSV (RFC 4180, UTF-8) for other programs, a row for each trial: the columns
/// of docs/study/study-files.md, those that are known of any answer. A trial without an answer has
/// empty cells there. answers_from_csv() reads the same answers from it.
std::string tidy_csv(std::span<const Answer> answers);

}  // namespace prostm
