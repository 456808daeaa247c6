#include <fmt/format.h>

#include <algorithm>

#include "common.hpp"
#include "options.hpp"
#include "prostm/core/file/file.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/core/require.hpp"
#include "prostm/study/analysis/pair_table.hpp"
#include "study/study.hpp"
#include "study/study_plan.hpp"

namespace prostm::app {

std::string p_text(double p) {
  return p < 1e-4 ? std::string("<.0001") : fmt::format("{:.4f}", p);
}

std::string scene_name(const SceneResult& scene) {
  return scene.scene.empty() ? std::string("all scenes") : scene.scene;
}

std::size_t width_of(std::string_view heading, const std::vector<std::string>& names) {
  std::size_t width = heading.size();
  for (const std::string& name : names) width = std::max(width, name.size());
  return width;
}

std::string wrapped(const std::string& words) {
  constexpr std::size_t kWidth = 100;
  std::string out, line;
  for (std::size_t at = 0; at < words.size();) {
    const std::size_t end = std::min(words.find(' ', at), words.size());
    if (!line.empty() && line.size() + 1 + end - at > kWidth) out += line + '\n', line.clear();
    if (!line.empty()) line += ' ';
    line += words.substr(at, end - at);
    at = end + 1;
  }
  return out + line + '\n';
}

namespace {

std::size_t scene_width(const Analysis& analysis) {
  std::vector<std::string> names;
  for (const SceneResult& scene : analysis.scenes) names.push_back(scene_name(scene));
  return width_of("scene", names);
}

void print_methods(std::FILE* out, const Analysis& analysis) {
  std::vector<std::string> names;
  for (const MethodResult& m : analysis.scenes.front().methods) names.push_back(m.method);
  const std::size_t scenes = scene_width(analysis), methods = width_of("method", names);
  fmt::print(out, "  {:<{}}  {:<{}} {:>13} {:>6} {:>15} {:>8} {:>7} {:>7}  {}\n", "scene", scenes,
             "method", methods, "right", "%", "interval %", "chance p", "χ²/df", "p", "d′, c");
  for (const SceneResult& scene : analysis.scenes) {
    for (const MethodResult& m : scene.methods) {
      fmt::print(out, "  {:<{}}  {:<{}} {:>6}/{:<6} {:>6.1f} {:>6.1f} to {:>5.1f} {:>8}",
                 scene_name(scene), scenes, m.method, methods, m.correct.successes,
                 m.correct.trials, 100.0 * m.correct.value(), 100.0 * m.interval.low,
                 100.0 * m.interval.high, p_text(m.p_chance));
      fmt::print(out, " {:>7} {:>7}",
                 m.dispersion ? fmt::format("{:.1f}", m.dispersion->statistic / m.dispersion->df)
                              : std::string("-"),
                 m.dispersion ? p_text(m.dispersion->p) : std::string("-"));
      fmt::print(out, "  {}\n",
                 m.sensitivity
                     ? thousandths(m.sensitivity->d_prime) + ", " + thousandths(m.sensitivity->bias)
                     : std::string("-"));
    }
  }
}

void print_comparisons(std::FILE* out, const Analysis& analysis) {
  const bool within = analysis.groups == Groups::Within;
  std::vector<std::string> pairs;
  for (const Comparison& c : analysis.scenes.front().comparisons)
    pairs.push_back(c.first + ", " + c.second);
  const std::size_t scenes = scene_width(analysis), methods = width_of("methods", pairs);
  fmt::print(out, "\n  {:<{}}  {:<{}} {:>7} {:>7} {:>7} {:>11} {:>7} {:>22}\n", "scene", scenes,
             "methods", methods, "z", "p", "exact p", "permutation", "Holm p",
             within ? "paired t" : "Welch's t");
  for (const SceneResult& scene : analysis.scenes) {
    for (const Comparison& c : scene.comparisons) {
      fmt::print(out, "  {:<{}}  {:<{}} {:>7.3f} {:>7} {:>7} {:>11} {:>7} {:>22}\n",
                 scene_name(scene), scenes, c.first + ", " + c.second, methods,
                 c.pooled_z.statistic, p_text(c.pooled_z.p), p_text(c.fisher_p),
                 c.permutation ? p_text(c.permutation->p) : std::string("-"),
                 c.holm_p ? p_text(*c.holm_p) : std::string("-"),
                 c.t ? fmt::format("{:.2f} (df {:.1f}) {}", c.t->statistic, c.t->df, p_text(c.t->p))
                     : std::string("-"));
    }
  }
}

/// Prints the sizes of differences over participants, in percentage points and as effect sizes.
void print_sizes(std::FILE* out, const Analysis& analysis) {
  std::vector<std::string> pairs;
  for (const Comparison& c : analysis.scenes.front().comparisons)
    pairs.push_back(c.second + " - " + c.first);
  const std::size_t scenes = scene_width(analysis), methods = width_of("difference", pairs);
  const bool within = analysis.groups == Groups::Within;
  fmt::print(out, "\n  {:<{}}  {:<{}} {:>7} {:>15} {:>6} {:>15} {:>8}  {}\n", "scene", scenes,
             "difference", methods, "points", "interval", within ? "d_z" : "d", "interval", "BF",
             analysis.settings.equivalence ? "equal p" : "");
  for (const SceneResult& scene : analysis.scenes) {
    for (const Comparison& c : scene.comparisons) {
      if (!c.difference) continue;
      const auto interval = [](const Interval& x, double unit, int digits) {
        return fmt::format("{:.{}f} to {:.{}f}", unit * x.low, digits, unit * x.high, digits);
      };
      fmt::print(out, "  {:<{}}  {:<{}} {:>7.1f} {:>15} {:>6.2f} {:>15} {:>8}  {}\n",
                 scene_name(scene), scenes, c.second + " - " + c.first, methods,
                 100.0 * c.difference->value, interval(c.difference->interval, 100.0, 1),
                 c.effect->value, interval(c.effect->interval, 1.0, 2),
                 factor_in_words(*c.bayes_factor), c.equal ? p_text(c.equal->p()) : "");
    }
  }
}

/// Whether any comparison has a size over participants.
bool has_sizes(const Analysis& analysis) {
  const auto& all = analysis.scenes.front().comparisons;
  return std::any_of(all.begin(), all.end(), [](const Comparison& c) { return !!c.difference; });
}

nlohmann::ordered_json test_json(const std::optional<TestResult>& test) {
  if (!test) return nullptr;
  return {{"statistic", test->statistic}, {"df", test->df}, {"p", test->p}};
}

nlohmann::ordered_json method_json(const MethodResult& m) {
  nlohmann::ordered_json json = {{"method", m.method},
                                 {"correct", m.correct.successes},
                                 {"answers", m.correct.trials},
                                 {"interval", {m.interval.low, m.interval.high}},
                                 {"chance_p", m.p_chance},
                                 {"of_participants", m.of_participants},
                                 {"dispersion", test_json(m.dispersion)}};
  if (m.sensitivity) {
    json["d_prime"] = m.sensitivity->d_prime;
    json["bias"] = m.sensitivity->bias;
  }
  return json;
}

nlohmann::ordered_json comparison_json(const Comparison& c) {
  nlohmann::ordered_json json = {{"first", c.first},          {"second", c.second},
                                 {"z", c.pooled_z.statistic}, {"z_p", c.pooled_z.p},
                                 {"fisher_p", c.fisher_p},    {"permutation_p", nullptr}};
  if (c.permutation) {
    json["permutation_p"] = c.permutation->p;
    json["permutation_splits"] = c.permutation->splits;
    json["permutation_exact"] = c.permutation->exact;
  }
  json["t"] = test_json(c.t);
  for (const char* key : {"holm_p", "difference", "difference_interval", "effect_size",
                          "effect_size_interval", "bayes_factor"})
    json[key] = nullptr;
  if (c.holm_p) json["holm_p"] = *c.holm_p;
  if (c.difference) {
    json["difference"] = c.difference->value;
    json["difference_interval"] = {c.difference->interval.low, c.difference->interval.high};
    json["effect_size"] = c.effect->value;
    json["effect_size_interval"] = {c.effect->interval.low, c.effect->interval.high};
    json["bayes_factor"] = *c.bayes_factor;
  }
  if (c.equal) {
    json["equivalence"] = {{"bound", c.equal->bound},
                           {"p_above_low", c.equal->p_above_low},
                           {"p_below_high", c.equal->p_below_high},
                           {"p", c.equal->p()},
                           {"interval", {c.equal->interval.low, c.equal->interval.high}}};
  }
  return json;
}

nlohmann::ordered_json analysis_json(const Analysis& analysis,
                                     const std::vector<std::string>& notes,
                                     const std::string& words) {
  nlohmann::ordered_json scenes = nlohmann::ordered_json::array();
  for (const SceneResult& scene : analysis.scenes) {
    nlohmann::ordered_json methods = nlohmann::ordered_json::array(),
                           comparisons = nlohmann::ordered_json::array();
    for (const MethodResult& m : scene.methods) methods.push_back(method_json(m));
    for (const Comparison& c : scene.comparisons) comparisons.push_back(comparison_json(c));
    nlohmann::ordered_json& json = scenes.emplace_back();
    if (scene.scene.empty()) {
      json["scene"] = nullptr;
    } else {
      json["scene"] = scene.scene;
    }
    json["methods"] = methods;
    json["comparisons"] = comparisons;
  }
  nlohmann::ordered_json json = {
      {"format", "prostm-analysis/1"},
      {"kind", name_of(analysis.kind)},
      {"groups", analysis.groups == Groups::Within ? "within" : "between"},
      {"participants", analysis.participants},
      {"chance", analysis.settings.chance},
      {"level", analysis.settings.level},
      {"seed", analysis.settings.seed},
      {"scenes", scenes}};
  if (!analysis.thresholds.empty()) {
    json["guess"] = *analysis.settings.guess;
    json["lapse"] = nullptr;
    if (analysis.settings.lapse) json["lapse"] = *analysis.settings.lapse;
    json["thresholds"] = thresholds_json(analysis.thresholds, analysis.kind);
  }
  json["missing"] = missing_json(analysis.missing);
  json["left_out"] = analysis.left_out;
  json["notes"] = notes;
  json["words"] = words;
  return json;
}

void print_notes(std::FILE* out, const std::vector<std::string>& notes) {
  for (const std::string& note : notes) fmt::print(out, "{}\n", note);
  if (!notes.empty()) fmt::print(out, "\n");
}

void write_tidy(std::FILE* out, const std::string& path, const std::vector<Answer>& answers) {
  if (!path.empty()) write_file(path, tidy_csv(answers));
  say_written(out, path);
}

/// Prints the results of a plan, or that there is no plan.
void print_plan(std::FILE* out, const std::optional<Confirmed>& confirmed) {
  if (confirmed) {
    print_confirmed(out, *confirmed);
  } else {
    fmt::print(out, "Exploratory: without a plan (prostm study preregister)\n\n");
  }
}

/// Adds the results of a plan; all other results are exploratory.
void add_plan(const std::optional<Confirmed>& confirmed, nlohmann::ordered_json& json) {
  json["exploratory"] = true;
  json["confirmatory"] = nullptr;
  if (confirmed) json["confirmatory"] = confirmed_json(*confirmed);
}

int analyse_adjusted(const AnalyseOptionsGiven& options, const std::vector<Answer>& answers,
                     const std::vector<std::string>& notes,
                     const std::optional<Confirmed>& confirmed) {
  if (!options.figure.empty())
    throw InputError("--figure draws shares of answers, and these are adjustments; leave it out");
  if (options.settings.guess || options.settings.lapse || options.settings.fit_lapse)
    throw InputError("--guess and --lapse belong to thresholds, and these are adjustments");
  const double level = options.settings.level;
  require_between("level", level, 0.5, 0.9999);
  std::vector<Answer> answered = answers;
  std::erase_if(answered, [](const Answer& a) { return !a.answered; });
  const std::vector<AdjustedResult> results = adjusted_levels(answered, level);
  const std::vector<MissingAnswers> missing = missing_answers(answers);
  std::string words = in_words(missing, AnswerKind::Adjusted);
  if (!words.empty()) words += ' ';
  words += in_words(results, level);
  std::FILE* out = prose(options.json);
  print_plan(out, confirmed);
  print_notes(out, notes);
  print_missing(out, missing);
  print_adjusted(out, results);
  fmt::print(out, "\n{}", wrapped(words));
  write_tidy(out, options.tidy, answers);
  nlohmann::ordered_json json = adjusted_json(results, level, words);
  json["missing"] = missing_json(missing);
  json["notes"] = notes;
  add_plan(confirmed, json);
  write_json(options.json, json);
  say_written(out, options.json);
  return 0;
}

/// @param plan file of a plan; empty: none.
int analyse_answers(const AnalyseOptionsGiven& options, const std::string& plan) {
  if (options.ties)
    throw InputError(
        "--ties belongs to tables of paired comparisons (a, b, preferred); leave it out");
  std::vector<std::string> notes;
  const std::vector<Answer> answers = read_answers(options.answers, notes, options.reading);
  std::optional<Confirmed> confirmed;
  if (!plan.empty()) confirmed = confirm(plan, options.answers, answers, options.settings.seed);
  if (answers.front().kind == AnswerKind::Adjusted)
    return analyse_adjusted(options, answers, notes, confirmed);
  const Analysis analysis = [&] {
    const Progress progress("analysing");
    return analyse(answers, options.settings);
  }();
  const std::string words = in_words(analysis);
  std::FILE* out = prose(options.json);
  const std::size_t people = analysis.participants.size();
  if (people == 1) {
    fmt::print(out, "1 participant, {} method{}\n", analysis.scenes.front().methods.size(),
               analysis.scenes.front().methods.size() == 1 ? "" : "s");
  } else {
    fmt::print(
        out, "{} participants, {}\n", people,
        analysis.groups == Groups::Within ? "each with all methods" : "each with one method");
  }
  print_plan(out, confirmed);
  print_notes(out, notes);
  print_missing(out, analysis.missing);
  const bool has_right_answers = analysis.kind == AnswerKind::Right;
  if (has_right_answers) print_methods(out, analysis);
  if (has_right_answers && !analysis.scenes.front().comparisons.empty())
    print_comparisons(out, analysis);
  if (has_right_answers && has_sizes(analysis)) print_sizes(out, analysis);
  if (!analysis.thresholds.empty()) print_thresholds(out, analysis.thresholds, analysis.kind);
  fmt::print(out, "\n{}", wrapped(words));
  if (!options.figure.empty()) draw_analysis(analysis, options.figure);
  say_written(out, options.figure);
  write_tidy(out, options.tidy, answers);
  nlohmann::ordered_json json = analysis_json(analysis, notes, words);
  add_plan(confirmed, json);
  write_json(options.json, json);
  say_written(out, options.json);
  return 0;
}

}  // namespace

int analyse_command(const AnalyseOptionsGiven& options) {
  if (are_pair_tables(options.answers)) return analyse_pairs(options);
  return analyse_answers(options, "");
}

int planned_analyse_command(const PlannedAnalyseOptionsGiven& options) {
  return analyse_answers(options, options.plan);
}

}  // namespace prostm::app
