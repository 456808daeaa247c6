#pragma once
/// Reads and writes files of participants' answers.

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "prostm/study/analysis/answer.hpp"
#include "prostm/study/analysis/reading_settings.hpp"
#include "prostm/study/task/tasks.hpp"

namespace prostm {

/// Reads answers from a table: a header with the columns participant, method, scene and correct,
/// separated by commas, semicolons, tabs or "|", in UTF-8, UTF-16 or Windows-1252. If there are
/// columns question (a scene) and answer, they must agree with correct. If there is a column level,
/// every row needs a number; if kind, all rows must have the same AnswerKind. A row whose correct,
/// answer or response is missing is a trial without an answer; one without method and scene is not
/// a trial. Other columns are kept as Answer::other (docs/study/study-files.md).
/// @param columns "correct=key_resp.corr,method:=am": the table's own column names, and values for
/// all rows. @param notes if given, receives sentences about skipped rows and merged names.
/// @throws InputError with line and column: a missing or invalid column or value, a truncated or
/// copied row.
std::vector<Answer> answers_from_csv(std::string_view text, const std::string& file,
                                     const std::string& columns = {},
                                     std::vector<std::string>* notes = nullptr);

/// Reads the scores of the paper's Fig. 4, {"fig4": {"trials_per_participant": n, "AM_1plume":
/// [right answers of each participant], …}}, as answers without questions: half of the trials had
/// one plume, half four. @throws InputError: missing, out-of-bounds or contradictory values.
std::vector<Answer> answers_from_paper(std::string_view text, const std::string& file);

/// Reads the answers in a participant's file (response_file.hpp). @param notes receives a sentence
/// if not all trials were answered. @param tasks the known tasks. @throws InputError: as
/// responses_from_text(); a first line that is not a study's, an unknown task, a trial with missing
/// values.
std::vector<Answer> answers_from_responses(std::string_view text, const std::string& file,
                                           std::vector<std::string>& notes,
                                           Tasks tasks = study_tasks());

/// Reads tables (.csv, .tsv, .txt), files of participants (.jsonl), or the paper's scores (.json,
/// alone), by file extension. @throws InputError as above, and for a file that cannot be read or is
/// given twice; unless settings allow them, also for a participant in two files, names that differ
/// only in spelling, and different stimuli under one name.
std::vector<Answer> read_answers(std::span<const std::string> paths,
                                 std::vector<std::string>& notes,
                                 const ReadingSettings& settings = {}, Tasks tasks = study_tasks());

/// Returns answers as CSV (RFC 4180, UTF-8) for other programs, one row per trial, with those
/// columns of docs/study/study-files.md that are known for any answer, and then those of
/// Answer::other, in order of first appearance. Cells of a trial without an answer are empty.
/// answers_from_csv() restores the same answers.
std::string tidy_csv(std::span<const Answer> answers);

}  // namespace prostm
