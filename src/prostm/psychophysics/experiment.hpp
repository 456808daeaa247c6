#pragma once
/// Published experiments as data: stimuli, task, results. The format is described in
/// docs/experiments/published.md.

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "prostm/core/text/names.hpp"
#include "prostm/psychophysics/presented_stimulus.hpp"

namespace prostm {

/// The quantity of a cell's value: what participants did, or what was measured.
enum class ExperimentTask : std::uint8_t {
  ForceThreshold,  ///< force at the threshold of detection [mN]
  ThresholdRatio,  ///< threshold of the first stimulus over the second's [dB]
  Stronger,        ///< share of answers that the first stimulus is stronger than the second
  StrengthRatio,   ///< strength of the first stimulus over the second's [dB]
  StrongestSpeed,  ///< abscissa at which a stimulus is strongest
  StrengthLinear,  ///< correlation of strength with the abscissa
  TwoPoints,       ///< share of answers "two" for two focal points at a gap [mm]
  Gap,             ///< gap of two focal points at a share of answers "two" [mm]
  GapRatio,        ///< that gap over the gap at another frequency
  Locate,          ///< mean distance of the felt place from the focal point [mm]
  Identify,        ///< share of an answer for a stimulus, or of right answers for all
  Direction,       ///< share of right answers on the direction of a sweep
  Curvature,       ///< Weber fraction of an arc's curvature
  OneOrFour,       ///< a quantity of the paper's study, which the caller of Laboratory simulates
};
template <>
inline constexpr std::array<std::string_view, 14> kNames<ExperimentTask> = {
    "force-threshold", "threshold-ratio", "stronger",  "strength-ratio", "strongest-speed",
    "strength-linear", "two-points",      "gap",       "gap-ratio",      "locate",
    "identify",        "direction",       "curvature", "one-or-four"};

/// Quantities of the paper's study: shares of right answers with a method in a scene and in both;
/// χ²/df of participants; the difference of shares, PRO-STM minus AM.
inline constexpr std::array<std::string_view, 9> kStudyQuantities = {
    "am one-plume",      "am four-plumes",      "am",
    "pro-stm one-plume", "pro-stm four-plumes", "pro-stm",
    "am spread",         "pro-stm spread",      "difference"};

/// How a published number is known.
enum class Source : std::uint8_t {
  Text,       ///< read in the paper's text or abstract
  Figure,     ///< read from a figure of the paper
  Secondary,  ///< quoted by another source, named in the experiment's note
};
template <>
inline constexpr std::array<std::string_view, 3> kNames<Source> = {"text", "figure", "secondary"};

/// Whether parameters are fitted to an experiment, or it is predicted.
enum class ExperimentSet : std::uint8_t { Fit, HeldOut };
template <>
inline constexpr std::array<std::string_view, 2> kNames<ExperimentSet> = {"fit", "held-out"};

/// One published number, and the stimuli that it belongs to.
struct Cell {
  std::string name;
  ExperimentTask task = ExperimentTask::ForceThreshold;
  std::vector<std::string> stimuli;  ///< names of the experiment's stimuli
  std::vector<double> abscissae;     ///< of the stimuli, for the tasks that have one
  std::string presented, answer;  ///< Identify: a stimulus, and the one named; empty: right answers
  std::string quantity;           ///< OneOrFour: one of kStudyQuantities
  double share = 0.0;             ///< Gap, GapRatio: share of answers "two"
  std::vector<double> frequencies;  ///< TwoPoints, Gap, GapRatio: of the modulation [Hz]
  double gap = 0.0;                 ///< TwoPoints [m]
  std::optional<double> value;      ///< published; nothing: only bounds
  double low = -std::numeric_limits<double>::infinity();  ///< agreement, (X15)
  double high = std::numeric_limits<double>::infinity();
  int trials = 0;  ///< answers behind `value`, which is a share; 0: not a count
  Source source = Source::Text;
};

struct Experiment {
  std::string id;
  std::string title, paper, doi, place;  ///< place: where in the paper
  std::string paper_id;                  ///< the same for experiments of one paper
  ExperimentSet set = ExperimentSet::Fit;
  std::string participants;  ///< number and trials, in words
  std::string note;          ///< what is assumed, what is not known
  double height = 0.2;       ///< of the skin above the array [m]
  std::map<std::string, PresentedStimulus> stimuli;
  std::map<std::string, std::string> keys;  ///< of Feeler::feel(), by stimulus
  std::vector<Cell> cells;
  int least = 0;     ///< (X15): cells within bounds that count as agreement
  double rms = 0.0;  ///< (X15): rms error that counts as agreement, instead; 0: none
};

/// @param file names the document in messages. @throws InputError for content that is not as
/// described.
Experiment parse_experiment(const std::string& text, const std::string& file);

/// Returns the published experiments of data/experiments, ordered by name.
const std::vector<Experiment>& published_experiments();

}  // namespace prostm
