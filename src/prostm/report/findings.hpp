#pragma once
/// The findings with which a report opens: sentences about its numbers, which follow from them.

#include <string>
#include <vector>

#include "prostm/report/part.hpp"
#include "prostm/report/verdict.hpp"

namespace prostm::report {

struct Finding {
  std::string section;  ///< name of the part that has the numbers
  /// Differs: it contradicts people, publications, or what one would wish.
  Agreement agreement = Agreement::NotComparable;
  std::string text;
};

/// Shares of right answers [%].
struct Scores {
  double am = 0.0, pro_stm = 0.0;
};
/// Whether models are better with the same method as people.
Finding reversal(const Scores& models, const Scores& people);

/// The published maximum of vibration inside squares of 3 cm.
/// @param inside number of skins that have it, of `skins`.
Finding squares(int inside, int skins);

/// Speeds at which circles are strongest [m/s], of several circles. @pre `peaks` is not empty
Finding circles(const std::vector<double>& peaks, Published published);

/// A rendering in the project's terms for quality.
struct Quality {
  double shape = 0.0;       ///< shape by Eq. (1)
  double felt_shape = 0.0;  ///< S_8.5 of the percept
  double felt_level = 0.0;  ///< felt strength [dB above the threshold of touch]
};
/// Compares the paths of a plan with one plain circle.
Finding one_circle(const std::string& scene, const Quality& circle, const Quality& paths);
/// Whether a plan is felt. @param low lower end of its interval of 95 % [dB above the threshold of
/// touch]. @param words those of sensation_words()
Finding felt_strength(const std::string& scene, double low, const std::string& words);
/// Whether the shape by Eq. (1) promises more than is felt.
Finding promised_shape(const std::string& scene, const Quality& best);
/// Whether paths are felt in a better shape than AM.
Finding felt_shapes(const std::string& scene, const Quality& felt, const Quality& best,
                    const Quality& am);
/// Whether preset best has a better shape by Eq. (1) than the paper's own algorithm.
Finding shapes_by_eq1(const std::string& scene, double best, double paper);

/// Mean times of a plan with preset paper, and with the paper's program on its machine [ms].
Finding plan_times(const std::string& scene, double here, double paper);

/// A run in real time. @param p50, p99 from a tracker's frame to sound [ms].
struct KeptUp {
  double p50 = 0.0, p99 = 0.0;
  int steps = 0, skipped = 0;  ///< of the smoke
  int missed = 0;              ///< blocks of samples
};
Finding latency(const KeptUp& run);

/// The part "findings": the reversal first, then those that differ, those without a comparison and
/// those that agree; then a sentence for each of `notes`. Each links to its section, whose title is
/// taken from `parts`. @throws std::invalid_argument: no part has the name of a section
Part findings_part(std::vector<Finding> findings, const std::vector<std::string>& notes,
                   const std::vector<Part>& parts);

}  // namespace prostm::report
