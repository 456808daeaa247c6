#include "prostm/study/analysis/analysis.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "prostm/core/input_error.hpp"
#include "prostm/core/require.hpp"
#include "prostm/core/text/nearest_name.hpp"

namespace prostm {
namespace {

/// Names in order of first appearance.
template <class Name>
std::vector<std::string> names_of(std::span<const Answer> answers, const Name& name) {
  std::vector<std::string> out;
  for (const Answer& a : answers) {
    if (std::find(out.begin(), out.end(), name(a)) == out.end()) out.push_back(name(a));
  }
  return out;
}

std::string quoted(const std::string& name) {
  return '"' + shown_name(name) + '"';
}

/// Each participant's score, by name.
using Scores = std::map<std::string, Proportion>;

/// @param scene empty: all scenes.
bool belongs(const Answer& a, const std::string& method, const std::string& scene) {
  return a.method == method && (scene.empty() || a.scene == scene);
}

Scores scores_of(std::span<const Answer> answers, const std::string& method,
                 const std::string& scene) {
  Scores out;
  for (const Answer& a : answers) {
    if (!belongs(a, method, scene)) continue;
    Proportion& score = out[a.participant];
    ++score.trials;
    score.successes += a.correct ? 1 : 0;
  }
  return out;
}

std::optional<Sensitivity> sensitivity_of(std::span<const Answer> answers,
                                          const std::string& method, const std::string& scene) {
  Proportion hits, false_alarms;
  for (const Answer& a : answers) {
    if (!belongs(a, method, scene)) continue;
    if (a.question.empty()) return std::nullopt;
    Proportion& of = a.question == a.scene ? hits : false_alarms;
    ++of.trials;
    of.successes += a.yes ? 1 : 0;
  }
  if (hits.trials == 0 || false_alarms.trials == 0) return std::nullopt;
  return sensitivity(hits, false_alarms);
}

MethodResult method_result(std::span<const Answer> answers, const std::string& method,
                           const std::string& scene, const AnalysisSettings& settings) {
  MethodResult out;
  out.method = method;
  std::vector<Proportion> scores;
  for (const auto& [participant, score] : scores_of(answers, method, scene)) {
    scores.push_back(score);
    out.of_participants.push_back(score.value());
    out.correct.successes += score.successes;
    out.correct.trials += score.trials;
  }
  out.interval = wilson_interval(out.correct, settings.level);
  out.p_chance = binomial_p(out.correct, settings.chance);
  out.dispersion = dispersion(scores);
  out.sensitivity = sensitivity_of(answers, method, scene);
  return out;
}

Comparison compare(const MethodResult& a, const MethodResult& b, Groups groups,
                   const AnalysisSettings& settings) {
  Comparison out;
  out.first = a.method;
  out.second = b.method;
  out.pooled_z = two_proportions_z(a.correct, b.correct);
  out.fisher_p = fisher_exact_p(a.correct, b.correct);
  const std::span<const double> x = a.of_participants, y = b.of_participants;
  const bool within = groups == Groups::Within;
  if (x.size() < 2 || y.size() < 2) return out;
  out.permutation =
      within ? paired_permutation(x, y, settings.seed) : permutation(x, y, settings.seed);
  out.t = within ? paired_t(x, y) : welch_t(x, y);
  const TwoSamples samples{x, y, groups};
  out.difference = mean_difference(samples, settings.level);
  out.effect = standardised_difference(samples, settings.level);
  out.bayes_factor = bayes_factor(samples);
  if (settings.equivalence)
    out.equal = equivalence(samples, *settings.equivalence, 1.0 - settings.level);
  return out;
}

/// Corrects p over participants for the number of comparisons in all scenes.
void correct(std::vector<SceneResult>& scenes) {
  std::vector<Comparison*> family;
  std::vector<double> p;
  for (SceneResult& scene : scenes) {
    for (Comparison& of : scene.comparisons) {
      if (!of.permutation) continue;
      family.push_back(&of);
      p.push_back(of.permutation->p);
    }
  }
  const std::vector<double> corrected = holm(p);
  for (std::size_t i = 0; i < family.size(); ++i) family[i]->holm_p = corrected[i];
}

/// Checks that every participant has every scene; otherwise shares over all scenes would confound
/// difficulty with participants.
void require_scenes(std::span<const Answer> answers, const std::vector<std::string>& methods,
                    const std::vector<std::string>& scenes) {
  for (const std::string& method : methods) {
    const Scores all = scores_of(answers, method, {});
    for (const std::string& scene : scenes) {
      const Scores some = scores_of(answers, method, scene);
      for (const auto& [participant, score] : all) {
        if (some.contains(participant)) continue;
        throw InputError("participant " + quoted(participant) + " has answers with method " +
                         quoted(method) + ", but none to the scene " + quoted(scene));
      }
    }
  }
}

/// @throws InputError: some participants have several methods, others not all.
Groups groups_of(std::span<const Answer> answers, const std::vector<std::string>& methods) {
  std::map<std::string, std::size_t> count;
  for (const std::string& method : methods) {
    for (const auto& [participant, score] : scores_of(answers, method, {})) ++count[participant];
  }
  const std::size_t had = count.begin()->second;
  for (const auto& [participant, methods_had] : count) {
    if (methods_had == had && (had == 1 || had == methods.size())) continue;
    throw InputError("participant " + quoted(participant) + " has " + std::to_string(methods_had) +
                     " of " + std::to_string(methods.size()) +
                     " methods: each must have all of them, or each only one");
  }
  return had == 1 ? Groups::Between : Groups::Within;
}

/// Fits thresholds where answers have levels, and writes guess and lapse into the settings.
std::vector<ThresholdResult> thresholds_of(std::span<const Answer> answers,
                                           AnalysisSettings& settings) {
  const auto with_level =
      std::count_if(answers.begin(), answers.end(), [](const Answer& a) { return !!a.level; });
  if (with_level == 0) {
    if (!settings.guess && !settings.lapse) return {};
    throw InputError("guess and lapse need answers with levels, and there is no level");
  }
  if (with_level != std::ssize(answers))
    throw InputError("some answers have a level and others do not: all must have one, or none");
  const bool is_felt = answers.front().kind == AnswerKind::Felt;
  if (settings.fit_lapse && settings.lapse)
    throw InputError("lapse cannot be both given and fitted; leave one of them out");
  settings.guess = settings.guess.value_or(is_felt ? 0.0 : settings.chance);
  constexpr double kMostGuess = 0.9, kMostWithFittedLapse = 0.75;
  require_between("guess", *settings.guess, 0.0,
                  settings.fit_lapse ? kMostWithFittedLapse : kMostGuess);
  if (!settings.fit_lapse) {
    settings.lapse = settings.lapse.value_or(kLapse);
    require_between("lapse", *settings.lapse, 0.0, 0.5);
    require_between("guess + lapse", *settings.guess + *settings.lapse, 0.0, 0.95);
  }
  return fit_thresholds(answers, {*settings.guess, settings.lapse, settings.level, settings.seed});
}

/// Participants who answered none of their trials of a method in a scene.
std::vector<std::string> without_answers(std::span<const Answer> trials) {
  std::map<std::tuple<std::string, std::string, std::string>, int> answered;
  for (const Answer& a : trials) answered[{a.participant, a.method, a.scene}] += a.answered ? 1 : 0;
  std::vector<std::string> out;
  for (const auto& [of, count] : answered) {
    const std::string& participant = std::get<0>(of);
    if (count == 0 && (out.empty() || out.back() != participant)) out.push_back(participant);
  }
  return out;
}

/// The trials to analyse: those with an answer, of participants who are not left out.
std::vector<Answer> answered(std::span<const Answer> trials,
                             const std::vector<std::string>& left_out) {
  std::vector<Answer> out;
  for (const Answer& a : trials) {
    const bool stays = !std::binary_search(left_out.begin(), left_out.end(), a.participant);
    if (a.answered && stays) out.push_back(a);
  }
  return out;
}

}  // namespace

std::vector<MissingAnswers> missing_answers(std::span<const Answer> trials) {
  std::vector<MissingAnswers> out;
  std::vector<std::set<std::string>> who;
  std::vector<int> right;
  for (const Answer& a : trials) {
    const auto found = std::find_if(out.begin(), out.end(), [&](const MissingAnswers& of) {
      return of.method == a.method && of.scene == a.scene;
    });
    const auto place = static_cast<std::size_t>(found - out.begin());
    if (found == out.end()) {
      MissingAnswers& of = out.emplace_back();
      of.method = a.method;
      of.scene = a.scene;
      who.emplace_back();
      right.push_back(0);
    }
    ++out[place].trials;
    out[place].missing += a.answered ? 0 : 1;
    right[place] += a.answered && a.correct ? 1 : 0;
    if (!a.answered) who[place].insert(a.participant);
  }
  const auto is_whole = [](const MissingAnswers& of) { return of.missing == 0; };
  if (std::all_of(out.begin(), out.end(), is_whole)) return {};
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i].participants = static_cast<int>(who[i].size());
    const double all = out[i].trials;
    out[i].if_answered = {right[i] / all, (right[i] + out[i].missing) / all};
  }
  return out;
}

Analysis analyse(std::span<const Answer> trials, const AnalysisSettings& settings) {
  require_between("chance", settings.chance, 0.01, 0.99);
  require_between("level", settings.level, 0.5, 0.9999);
  if (settings.equivalence) require_between("equivalence", *settings.equivalence, 0.001, 1.0);
  Analysis out;
  out.missing = missing_answers(trials);
  if (!out.missing.empty()) out.left_out = without_answers(trials);
  std::vector<Answer> kept;  // used only if trials are left out
  if (!out.missing.empty()) kept = answered(trials, out.left_out);
  const std::span<const Answer> answers =
      out.missing.empty() ? trials : std::span<const Answer>(kept);
  if (answers.empty()) throw InputError("there is no answer");
  const auto methods = names_of(answers, [](const Answer& a) { return a.method; });
  const auto scenes = names_of(answers, [](const Answer& a) { return a.scene; });
  out.settings = settings;
  out.kind = answers.front().kind;
  if (std::any_of(answers.begin(), answers.end(),
                  [&](const Answer& a) { return a.kind != out.kind; })) {
    throw InputError(
        "answers are of several kinds, from studies with different tasks; analyse each "
        "study separately");
  }
  out.groups = groups_of(answers, methods);
  out.participants = names_of(answers, [](const Answer& a) { return a.participant; });
  require_scenes(answers, methods, scenes);
  std::vector<std::string> parts = {""};
  if (scenes.size() > 1) parts.insert(parts.end(), scenes.begin(), scenes.end());
  for (const std::string& scene : parts) {
    SceneResult& result = out.scenes.emplace_back();
    result.scene = scene;
    for (const std::string& method : methods)
      result.methods.push_back(method_result(answers, method, scene, settings));
    for (std::size_t b = 1; b < methods.size(); ++b) {
      for (std::size_t a = 0; a < b; ++a) {
        result.comparisons.push_back(
            compare(result.methods[a], result.methods[b], out.groups, settings));
      }
    }
  }
  correct(out.scenes);
  out.thresholds = thresholds_of(answers, out.settings);
  return out;
}

}  // namespace prostm
