#include <fmt/format.h>

#include <cmath>

#include "study/study.hpp"

namespace prostm::app {
namespace {

std::string name_of(const ThresholdResult& result) {
  return result.participant.empty() ? std::string("all") : result.participant;
}

Proportion correct_of(const ThresholdResult& result) {
  Proportion sum;
  for (const LevelScore& score : result.scores) {
    sum.successes += score.correct.successes;
    sum.trials += score.correct.trials;
  }
  return sum;
}

std::string interval_text(const std::optional<Interval>& interval, int digits) {
  const bool open = !interval || (std::isinf(interval->low) && std::isinf(interval->high));
  return open ? std::string("open") : bounds_text(*interval, digits);
}

/// An open end is null.
nlohmann::ordered_json interval_json(const std::optional<Interval>& interval) {
  if (!interval) return nullptr;
  const auto end = [](double x) {
    return std::isinf(x) ? nlohmann::ordered_json() : nlohmann::ordered_json(x);
  };
  return nlohmann::ordered_json::array({end(interval->low), end(interval->high)});
}

nlohmann::ordered_json misfit_json(const std::optional<Misfit>& misfit) {
  if (!misfit) return nullptr;
  return {{"deviance", misfit->deviance}, {"df", misfit->df}, {"p", misfit->p}};
}

nlohmann::ordered_json fit_json(const PsychometricFit& fit) {
  return {
      {"threshold", fit.function.threshold}, {"threshold_interval", interval_json(fit.threshold)},
      {"slope", fit.function.slope},         {"slope_interval", interval_json(fit.slope)},
      {"lapse", fit.function.lapse},         {"misfit", misfit_json(fit.misfit)},
      {"log_likelihood", fit.log_likelihood}};
}

}  // namespace

void print_thresholds(std::FILE* out, const std::vector<ThresholdResult>& thresholds,
                      AnswerKind kind) {
  std::vector<std::string> scenes, methods, participants;
  for (const ThresholdResult& of : thresholds) {
    scenes.push_back(of.scene);
    methods.push_back(of.method);
    participants.push_back(name_of(of));
  }
  const std::size_t scene = width_of("scene", scenes), method = width_of("method", methods),
                    participant = width_of("participant", participants);
  fmt::print(out, "\n  {:<{}}  {:<{}}  {:<{}} {:>6} {:>13} {:>10} {:>21} {:>10} {:>21}  {}\n",
             "scene", scene, "method", method, "participant", participant, "levels",
             kind == AnswerKind::Felt ? "for it" : "right", "threshold", "interval", "slope",
             "interval", "misfit p");
  for (const ThresholdResult& of : thresholds) {
    const Proportion correct = correct_of(of);
    fmt::print(out, "  {:<{}}  {:<{}}  {:<{}} {:>6} {:>6}/{:<6}", of.scene, scene, of.method,
               method, name_of(of), participant, of.scores.size(), correct.successes,
               correct.trials);
    if (of.fit) {
      constexpr int kSlopeDigits = 4;
      const int digits = level_digits(of.scores);
      fmt::print(out, " {:>10.{}g} {:>21} {:>10.{}g} {:>21}  {}\n", of.fit->function.threshold,
                 digits, interval_text(of.fit->threshold, digits), of.fit->function.slope,
                 kSlopeDigits, interval_text(of.fit->slope, kSlopeDigits),
                 of.fit->misfit ? p_text(of.fit->misfit->p) : std::string("-"));
    } else {
      const int digits = level_digits(of.scores);
      const std::string bounds =
          of.bounds ? fmt::format("{}, interval {}; ", bounds_text(of.bounds->best, digits),
                                  interval_text(of.bounds->interval, digits))
                    : std::string();
      fmt::print(out, "  no fit: {}{}\n", bounds, in_words(of.no_fit, kind));
    }
  }
}

nlohmann::ordered_json thresholds_json(const std::vector<ThresholdResult>& thresholds,
                                       AnswerKind kind) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const ThresholdResult& of : thresholds) {
    nlohmann::ordered_json levels = nlohmann::ordered_json::array();
    for (const LevelScore& score : of.scores) {
      levels.push_back({{"level", score.level},
                        {"correct", score.correct.successes},
                        {"answers", score.correct.trials}});
    }
    nlohmann::ordered_json& json = out.emplace_back();
    json["scene"] = of.scene;
    json["method"] = of.method;
    json["participant"] =
        of.participant.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(of.participant);
    json["levels"] = levels;
    json["fit"] = of.fit ? fit_json(*of.fit) : nlohmann::ordered_json();
    if (!of.fit) json["no_fit"] = in_words(of.no_fit, kind);
    if (of.bounds) {
      json["bounds"] = {{"threshold", interval_json(of.bounds->best)},
                        {"threshold_interval", interval_json(of.bounds->interval)}};
    }
  }
  return out;
}

}  // namespace prostm::app
