#pragma once
/// Participants' answers, as files hold them.

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "prostm/study/analysis/answer.hpp"
#include "prostm/study/analysis/reading_settings.hpp"
#include "prostm/study/task/tasks.hpp"

namespace prostm {

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
/// where not all trials were answered. @param tasks those whose names are known. @throws
/// InputError: what responses_from_text() throws; no first line of a study, a task that is not
/// known, a trial without its values.
std::vector<Answer> answers_from_responses(std::string_view text, const std::string& file,
                                           std::vector<std::string>& notes,
                                           Tasks tasks = study_tasks());

/// Reads tables (.csv, .tsv, .txt), files of participants (.jsonl), or the paper's scores (.json,
/// alone), by the endings of their names. @throws InputError also when a file cannot be read or is
/// given twice, for a participant in two files, names that differ in spelling alone, and different
/// stimuli under one name, unless settings allow them.
std::vector<Answer> read_answers(std::span<const std::string> paths,
                                 std::vector<std::string>& notes,
                                 const ReadingSettings& settings = {}, Tasks tasks = study_tasks());

/// Returns answers as CSV (RFC 4180, UTF-8) for other programs, a row for each trial: the columns
/// of docs/study/study-files.md, those that are known of any answer. A trial without an answer has
/// empty cells there. answers_from_csv() reads the same answers from it.
std::string tidy_csv(std::span<const Answer> answers);

}  // namespace prostm
