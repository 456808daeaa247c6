#pragma once
/// The AM baseline as measured in [B-1] of docs/design/references.md, compared with PRO-STM.

#include <string>
#include <vector>

#include "planner/sequences.hpp"
#include "report.hpp"

namespace prostm::bench {

/// Measures the updates per second and the quality of AM on sequences of targets, and prints them
/// with the paper's rate of about 250. @param frames number of scored frames per sequence.
void measure_am(const std::vector<Sequence>& sequences, int frames, std::vector<Row>& rows);

/// Prints the mean RMSE of the model by σ and N beside the figures of Table I of [B-1].
void measure_am_table(const std::vector<Sequence>& sequences, int frames, std::vector<Row>& rows);

/// Draws, for the field with the largest Σ p* of each sequence: the target, PRO-STM by presets
/// paper-valid and best, and AM, like the paper's Fig. 3. Prints RMSE and correlation with the
/// paper's caution.
void draw_am_picture(const std::vector<Sequence>& sequences, const std::string& path);

}  // namespace prostm::bench
