#pragma once
/// The AM baseline as [B-1] of docs/design.md measured it, and beside PRO-STM.

#include <string>
#include <vector>

#include "planner/sequences.hpp"
#include "report.hpp"

namespace prostm::bench {

/// Updates a second and quality of AM on sequences of targets, beside the paper's about 250.
/// @param frames of each sequence.
void measure_am(const std::vector<Sequence>& sequences, int frames, std::vector<Row>& rows);

/// Mean RMSE of the model by σ and N, as in Table I of [B-1], whose figures stand beside it.
void measure_am_table(const std::vector<Sequence>& sequences, int frames, std::vector<Row>& rows);

/// One field of each sequence, that of the largest Σ p*: target, PRO-STM by presets paper-valid and
/// best, and AM, in kind the paper's Fig. 3. Prints RMSE and correlation with the paper's caution.
void draw_am_picture(const std::vector<Sequence>& sequences, const std::string& path);

}  // namespace prostm::bench
