#pragma once
/// Live runs: plans that replace one another every 40 ms, and their percept.

#include <string>
#include <vector>

#include "felt/ways.hpp"
#include "prostm/acoustics/array/array.hpp"
#include "prostm/emit/emitter.hpp"
#include "prostm/target/target_field.hpp"
#include "report.hpp"

namespace prostm::bench {

inline constexpr int kLiveCells = 54;  ///< cells along each edge of a live run's raster
inline constexpr int kLivePlans = 25;  ///< plans of a live run of a second

/// The targets of a live run, all on one raster.
struct LiveSequence {
  std::string name;
  std::vector<TargetField> targets;
};

/// Returns five generated, moving sequences of a second. @param is_still whether every target is
/// the first one. @param most number of them; 0: all.
std::vector<LiveSequence> live_sequences(bool is_still, int most = 0);

/// The scores of one way on one sequence: S_8.5 of the map √e on the nominal skin.
struct LiveScores {
  double alone = 0.0;      ///< plans for one target alone, repeated endlessly; mean of several
  double loop = 0.0;       ///< the same for plans of the live run
  double live = 0.0;       ///< the whole run after it has settled, against the mean target
  double window = 0.0;     ///< mean over its windows of 40 ms, each against its own target
  double intensity = 0.0;  ///< √E of the run [m]
  double faded = 0.0;      ///< share of samples in a fade
  double changes = 0.0;    ///< changes of the number of focal points, per second
  double hasty = 0.0;      ///< of these, the ones that count_hasty() counts, per second
};

/// Counts changes of the number of focal points that follow another within a second, without a
/// change of the number of the target's regions after that one: connected cells with at least a
/// quarter of the largest pressure. @param interval time between plans [s]. @param points of each
/// plan. @param targets as many.
int count_hasty(const std::vector<std::size_t>& points, const std::vector<TargetField>& targets,
                double interval);

/// A set of sequences, scored in several ways: [way][sequence]. Ways are compared with the first.
struct LiveSet {
  std::string name;
  std::vector<std::string> ways, sequences;
  std::vector<std::vector<LiveScores>> scores;
};

/// Scores ways, several runs at once. Steps the skin first, which takes some 10 s.
/// @param switch_at when plans take over. @param threads ≥ 1. @throws InputError as Judge::judge()
/// does.
LiveSet score_live(const std::string& name, const TransducerArray& array,
                   const std::vector<LiveSequence>& sequences, const std::vector<Way>& ways,
                   SwitchAt switch_at, int threads);

/// Prints a table with a line for each way. @param each whether to add one for each sequence.
void print_live(const LiveSet& set, bool each);
/// Adds the distributions of lack, live and as loops, for every way.
void add_live_rows(const LiveSet& set, std::vector<Row>& rows);

}  // namespace prostm::bench
