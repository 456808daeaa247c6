#include <fmt/format.h>

#include "common.hpp"
#include "options.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/core/require.hpp"
#include "prostm/study/analysis/pair_table.hpp"
#include "study/study.hpp"

namespace prostm::app {
namespace {

std::string interval_text(const Interval& of) {
  return fmt::format("{:.3f} to {:.3f}", of.low, of.high);
}

void print_abilities(std::FILE* out, const BradleyTerry& fit) {
  std::vector<std::string> names;
  for (const StimulusAbility& of : fit.stimuli) names.push_back(of.stimulus);
  const std::size_t width = width_of("stimulus", names);
  fmt::print(out, "  {:<{}} {:>11} {:>9} {:>8} {:>7} {:>18}\n", "stimulus", width, "comparisons",
             "preferred", "ability", "error", "interval");
  for (const StimulusAbility& of : fit.stimuli) {
    fmt::print(out, "  {:<{}} {:>11} {:>9g} {:>8.3f} {:>7.3f} {:>18}\n", of.stimulus, width,
               of.comparisons, of.preferred, of.ability, of.error, interval_text(of.interval));
  }
}

void print_differences(std::FILE* out, const BradleyTerry& fit) {
  std::vector<std::string> names;
  for (const AbilityDifference& of : fit.differences) names.push_back(of.second + " - " + of.first);
  const std::size_t width = width_of("difference", names);
  fmt::print(out, "\n  {:<{}} {:>11} {:>9} {:>8} {:>7} {:>18} {:>8} {:>7} {:>7}\n", "difference",
             width, "comparisons", "preferred", "ability", "error", "interval", "share %", "p",
             "Holm p");
  for (const AbilityDifference& of : fit.differences) {
    fmt::print(out, "  {:<{}} {:>11} {:>9g} {:>8.3f} {:>7.3f} {:>18} {:>8.1f} {:>7} {:>7}\n",
               of.second + " - " + of.first, width, of.comparisons, of.preferred, of.difference,
               of.error, interval_text(of.interval), 100.0 * of.share, p_text(of.p),
               p_text(of.holm_p));
  }
}

nlohmann::ordered_json pairs_json(const BradleyTerry& fit, Ties ties,
                                  const std::vector<std::string>& notes, const std::string& words) {
  nlohmann::ordered_json stimuli = nlohmann::ordered_json::array(),
                         differences = nlohmann::ordered_json::array();
  for (const StimulusAbility& of : fit.stimuli) {
    stimuli.push_back({{"stimulus", of.stimulus},
                       {"comparisons", of.comparisons},
                       {"preferred", of.preferred},
                       {"ability", of.ability},
                       {"error", of.error},
                       {"interval", {of.interval.low, of.interval.high}}});
  }
  for (const AbilityDifference& of : fit.differences) {
    differences.push_back({{"first", of.first},
                           {"second", of.second},
                           {"comparisons", of.comparisons},
                           {"preferred", of.preferred},
                           {"difference", of.difference},
                           {"error", of.error},
                           {"interval", {of.interval.low, of.interval.high}},
                           {"share", of.share},
                           {"p", of.p},
                           {"holm_p", of.holm_p}});
  }
  nlohmann::ordered_json json = {{"format", "prostm-analysis/1"},
                                 {"kind", "pairs"},
                                 {"exploratory", true},
                                 {"participants", fit.participants},
                                 {"comparisons", fit.comparisons},
                                 {"ties", name_of(ties)},
                                 {"tied", fit.ties},
                                 {"level", fit.level},
                                 {"stimuli", stimuli},
                                 {"differences", differences},
                                 {"misfit", nullptr}};
  if (fit.misfit) {
    json["misfit"] = {
        {"deviance", fit.misfit->statistic}, {"df", fit.misfit->df}, {"p", fit.misfit->p}};
  }
  json["notes"] = notes;
  json["words"] = words;
  return json;
}

/// @throws InputError: an option that does not apply to paired comparisons.
void require_options_of_pairs(const AnalyseOptionsGiven& options) {
  const auto refuse = [](bool given, const char* option) {
    if (given)
      throw InputError(
          fmt::format("{} does not apply to paired comparisons; leave it out", option));
  };
  const ReadingSettings& reading = options.reading;
  const AnalysisSettings& settings = options.settings;
  refuse(!options.figure.empty(), "--figure");
  refuse(!options.tidy.empty(), "--tidy");
  refuse(!reading.columns.empty(), "--columns");
  refuse(!reading.rename.empty(), "--rename");
  refuse(reading.prefix.has_value(), "--prefix");
  refuse(reading.merge_spellings, "--merge-spellings");
  refuse(reading.pool, "--pool");
  refuse(settings.equivalence.has_value(), "--equivalence");
  refuse(settings.guess.has_value(), "--guess");
  refuse(settings.lapse.has_value(), "--lapse");
  refuse(settings.fit_lapse, "--fit-lapse");
}

}  // namespace

int analyse_pairs(const AnalyseOptionsGiven& options) {
  require_options_of_pairs(options);
  require_between("level", options.settings.level, 0.5, 0.9999);
  const Ties ties = from_name<Ties>(options.ties.value_or("refuse"), "--ties");
  std::vector<std::string> notes;
  const std::vector<PairedComparison> comparisons = read_comparisons(options.answers, ties, notes);
  const BradleyTerry fit = fit_bradley_terry(comparisons, options.settings.level);
  const std::string words = in_words(fit);
  std::FILE* out = prose(options.json);
  fmt::print(out, "{} comparisons of {} stimuli", fit.comparisons, fit.stimuli.size());
  if (!fit.participants.empty()) fmt::print(out, " by {} participants", fit.participants.size());
  fmt::print(out, "\n\n");
  for (const std::string& note : notes) fmt::print(out, "{}\n", note);
  print_abilities(out, fit);
  print_differences(out, fit);
  fmt::print(out, "\n{}", wrapped(words));
  write_json(options.json, pairs_json(fit, ties, notes, words));
  say_written(out, options.json);
  return 0;
}

}  // namespace prostm::app
