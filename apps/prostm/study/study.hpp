#pragma once
/// The parts of prostm study analyse: tables, JSON and pictures of an analysis.

#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "options.hpp"
#include "prostm/study/analysis/adjusted.hpp"
#include "prostm/study/analysis/analysis.hpp"

namespace prostm::app {

/// Formats a p value for a table.
std::string p_text(double p);
/// Returns the scene's name, or "all scenes".
std::string scene_name(const SceneResult& scene);
/// Returns the width of a column of names, at least that of its heading.
std::size_t width_of(std::string_view heading, const std::vector<std::string>& names);

/// Breaks words into lines.
std::string wrapped(const std::string& words);

/// Analyses tables of paired comparisons. @return the exit status. @throws InputError for options
/// that do not apply to them, and for bad tables.
int analyse_pairs(const AnalyseOptionsGiven& options);

/// Prints the trials without an answer by method and scene; nothing if there are no such trials.
void print_missing(std::FILE* out, const std::vector<MissingAnswers>& missing);
nlohmann::ordered_json missing_json(const std::vector<MissingAnswers>& missing);

/// @param kind of the answers.
void print_thresholds(std::FILE* out, const std::vector<ThresholdResult>& thresholds,
                      AnswerKind kind);
nlohmann::ordered_json thresholds_json(const std::vector<ThresholdResult>& thresholds,
                                       AnswerKind kind);

void print_adjusted(std::FILE* out, const std::vector<AdjustedResult>& results);
nlohmann::ordered_json adjusted_json(const std::vector<AdjustedResult>& results, double level,
                                     const std::string& words);

/// Draws shares of right answers as the paper's Fig. 4, or psychometric functions where answers
/// have levels. @throws InputError when the file cannot be written.
void draw_analysis(const Analysis& analysis, const std::string& path);

}  // namespace prostm::app
