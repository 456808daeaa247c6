#include <fmt/format.h>

#include "common.hpp"
#include "options.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/core/require.hpp"
#include "prostm/study/analysis/study_power.hpp"
#include "prostm/study/protocol/protocol.hpp"

namespace prostm::app {
namespace {

constexpr int kMostParticipants = 2000;
constexpr std::array kTargets = {0.8, 0.9};

/// Returns the design of the options. @throws InputError: options that contradict each other.
StudyDesign design_of(const PowerOptionsGiven& options) {
  StudyDesign design = options.design;
  const bool within = from_name<MethodsOf>(options.methods, "--methods") == MethodsOf::Within;
  design.groups = within ? Groups::Within : Groups::Between;
  if (!design.d && !(options.first && options.second)) {
    throw InputError(
        "give the assumed shares, --first 0.6 --second 0.75, or an effect size, --d 0.5");
  }
  if (design.d && (options.trials || options.correlation || options.alike)) {
    throw InputError(
        "--trials, --correlation and --alike belong to assumed shares; with --d leave them out");
  }
  if (options.alike && !within)
    throw InputError("--alike belongs to --methods within; leave it out");
  design.shares.first = options.first.value_or(design.shares.first);
  design.shares.second = options.second.value_or(design.shares.second);
  design.shares.trials = options.trials.value_or(design.shares.trials);
  design.shares.correlation = options.correlation.value_or(design.shares.correlation);
  design.shares.alike = options.alike.value_or(design.shares.alike);
  validate(design);
  return design;
}

std::string people_text(const StudyDesign& design, int n) {
  return fmt::format("{} participants{}", n,
                     design.groups == Groups::Within ? "" : " with each method");
}

void print_design(std::FILE* out, const StudyDesign& design) {
  const bool within = design.groups == Groups::Within;
  fmt::print(out, "{} t test over participants, two-sided, alpha {:g}; each participant has {}\n",
             within ? "paired" : "Welch's", design.alpha, within ? "both methods" : "one method");
  if (design.d) {
    fmt::print(out, "assumed effect size {} = {:g}\n", within ? "d_z" : "d", *design.d);
    return;
  }
  const AssumedShares& of = design.shares;
  fmt::print(out, "assumed: {:g} and {:g} % right in {} trials with each method, correlation {:g}",
             100.0 * of.first, 100.0 * of.second, of.trials, of.correlation);
  fmt::print(out, "{}\n", within ? fmt::format(", alike {:g}", of.alike) : "");
}

nlohmann::ordered_json design_json(const StudyDesign& design) {
  nlohmann::ordered_json json = {
      {"methods",
       name_of(design.groups == Groups::Within ? MethodsOf::Within : MethodsOf::Between)},
      {"test", design.groups == Groups::Within ? "paired t" : "Welch's t"},
      {"alpha", design.alpha}};
  if (design.d) {
    json["d"] = *design.d;
    return json;
  }
  json["shares"] = {design.shares.first, design.shares.second};
  json["trials"] = design.shares.trials;
  json["correlation"] = design.shares.correlation;
  if (design.groups == Groups::Within) json["alike"] = design.shares.alike;
  return json;
}

/// Prints the power of a number of participants. @return the same as JSON.
nlohmann::ordered_json power_of(std::FILE* out, const StudyDesign& design,
                                SimulatedStudies& studies, int participants) {
  const Proportion power = studies.power(participants);
  const Interval interval = wilson_interval(power);
  fmt::print(out, "power of {}: {:.1f} % (Monte Carlo 95 % interval {:.1f} to {:.1f} %)\n",
             people_text(design, participants), 100.0 * power.value(), 100.0 * interval.low,
             100.0 * interval.high);
  return {{"participants", participants},
          {"significant", power.successes},
          {"studies", power.trials},
          {"power", power.value()},
          {"interval", {interval.low, interval.high}}};
}

}  // namespace

int power_command(const PowerOptionsGiven& options) {
  const StudyDesign design = design_of(options);
  require_between("studies", options.studies, 100, 100'000);
  if (options.participants) require_between("participants", *options.participants, 2, 10'000);
  std::FILE* out = prose(options.json);
  SimulatedStudies studies(design, options.studies, options.seed);
  nlohmann::ordered_json json = {{"format", "prostm-study-power/1"},
                                 {"design", design_json(design)},
                                 {"studies", options.studies},
                                 {"seed", options.seed},
                                 {"power", nullptr},
                                 {"needed", nlohmann::ordered_json::array()}};
  print_design(out, design);
  const Progress progress("simulating");
  if (options.participants) json["power"] = power_of(out, design, studies, *options.participants);
  for (const double target : kTargets) {
    const std::optional<int> needed = studies.needed(target, kMostParticipants);
    auto& entry = json["needed"].emplace_back(
        nlohmann::ordered_json{{"power", target}, {"participants", nullptr}});
    if (!needed) {
      fmt::print(out, "{:g} % power needs more than {}\n", 100.0 * target,
                 people_text(design, kMostParticipants));
      continue;
    }
    entry["participants"] = *needed;
    fmt::print(out, "{:g} % power needs {}\n", 100.0 * target, people_text(design, *needed));
  }
  write_json(options.json, json);
  say_written(out, options.json);
  return 0;
}

}  // namespace prostm::app
