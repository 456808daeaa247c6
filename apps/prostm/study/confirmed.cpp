/// The results of a plan.
#include <fmt/format.h>

#include "common.hpp"
#include "prostm/core/file/file.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/study/extra/extra_answers.hpp"
#include "prostm/study/session/roster.hpp"
#include "study/study.hpp"
#include "study/study_plan.hpp"

namespace prostm::app {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{64} << 20;

/// Checks a participant's file, and returns what the rules of exclusion need.
SessionFacts check_file(const std::string& path, const StudyPlan& plan,
                        const std::string& plan_file) {
  if (!path.ends_with(".jsonl")) {
    throw InputError(path +
                     ": --plan needs participants' files (.jsonl), since a table does not contain "
                     "its protocol");
  }
  const std::string text = read_file(path, kMaxBytes);
  const std::optional<RosterEntry> entry = roster_entry(text, path);
  if (!entry) throw InputError(path + ", line 1 is not the first line of a participant's file");
  require_planned(entry->protocol, path + ", line 1", plan, plan_file);
  const std::vector<ResponseLine> lines = responses_from_text(text, path);
  for (const ResponseLine& line : lines) {
    const std::string utc = line.value("utc", "");
    if (utc.empty() || utc >= plan.created_utc) continue;
    throw InputError(fmt::format("{} was begun on {}, before {} was written on {}", path, utc,
                                 plan_file, plan.created_utc));
  }
  const ExtraAnswers extra = extra_answers(lines);
  return {entry->participant, entry->attendance == Attendance::Complete,
          extra.failed_practice.empty(), extra.wrong_share()};
}

std::string chance_or(const std::string& method) {
  return method.empty() ? "chance" : method;
}

std::string interval_text(const Interval& of) {
  return fmt::format("{:.3g} to {:.3g}", of.low, of.high);
}

nlohmann::ordered_json interval_json(const Interval& of) {
  return {of.low, of.high};
}

void print_result(std::FILE* out, const StudyPlan& plan, const PlannedResult& of,
                  std::size_t number) {
  fmt::print(out, "{}. {}: {} and {} in {}: ", number, name_of(plan.measure), of.of.first,
             chance_or(of.of.second), of.of.scene.empty() ? "all scenes" : of.of.scene);
  if (!of.test) {
    fmt::print(out, "no test is possible, with {} and {} participants\n", of.first.participants,
               of.second.participants);
    return;
  }
  fmt::print(out, "{} (corrected {})\n", of.significant ? "significant" : "not significant",
             p_in_words(of.corrected_p));
  const bool is_t = plan.test == PlannedTest::T;
  fmt::print(out, "   means {:.3g} and {:.3g} of {} and {} participants; {}{}\n", *of.first.mean,
             *of.second.mean, of.first.participants, of.second.participants,
             is_t ? fmt::format("t({:.1f}) = {:.2f}, ", of.test->df, of.test->statistic)
                  : std::string("permutation, "),
             p_in_words(of.test->p));
  fmt::print(out, "   difference {:.3g} ({:g} % interval {}), {} = {:.2f} ({}), Bayes factor {}\n",
             of.difference->value, 100.0 * (1.0 - plan.alpha),
             interval_text(of.difference->interval), of.groups == Groups::Within ? "d_z" : "d",
             of.effect->value, interval_text(of.effect->interval),
             factor_in_words(*of.bayes_factor));
  if (of.equal) {
    fmt::print(out, "   {} within ± {:g} ({})\n",
               of.equal->p() < plan.alpha ? "equivalent" : "not shown to be equivalent",
               of.equal->bound, p_in_words(of.equal->p()));
  }
}

nlohmann::ordered_json result_json(const PlannedResult& of) {
  const auto name = [](const std::string& text) {
    return text.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(text);
  };
  const auto mean = [](const PlannedGroup& group) {
    return group.mean ? nlohmann::ordered_json(*group.mean) : nlohmann::ordered_json(nullptr);
  };
  nlohmann::ordered_json json = {{"scene", name(of.of.scene)},
                                 {"first", of.of.first},
                                 {"second", name(of.of.second)},
                                 {"participants", {of.first.participants, of.second.participants}},
                                 {"means", {mean(of.first), mean(of.second)}},
                                 {"statistic", nullptr},
                                 {"df", nullptr},
                                 {"p", nullptr},
                                 {"corrected_p", of.corrected_p},
                                 {"significant", of.significant}};
  if (!of.test) return json;
  json["statistic"] = of.test->statistic;
  if (of.test->df > 0.0) json["df"] = of.test->df;
  json["p"] = of.test->p;
  json["difference"] = of.difference->value;
  json["difference_interval"] = interval_json(of.difference->interval);
  json["effect_size"] = of.effect->value;
  json["effect_size_interval"] = interval_json(of.effect->interval);
  json["bayes_factor"] = *of.bayes_factor;
  if (of.equal) {
    json["equivalence"] = {{"bound", of.equal->bound},
                           {"p", of.equal->p()},
                           {"interval", interval_json(of.equal->interval)}};
  }
  return json;
}

}  // namespace

Confirmed confirm(const std::string& plan_file, const std::vector<std::string>& files,
                  const std::vector<Answer>& answers, std::uint64_t seed) {
  Confirmed out;
  out.file = plan_file;
  out.plan = plan_from_text(read_file(plan_file, kMaxBytes), plan_file);
  std::vector<SessionFacts> sessions;
  for (const std::string& path : files) sessions.push_back(check_file(path, out.plan, plan_file));
  out.results = run_plan(out.plan, answers, sessions, seed);
  return out;
}

void print_confirmed(std::FILE* out, const Confirmed& of) {
  const StudyPlan& plan = of.plan;
  fmt::print(out, "Confirmatory: {}, written {}, SHA-256 {}\n", of.file, plan.created_utc,
             plan.sha256);
  fmt::print(out, "{} of {} planned participants; alpha {:g}, correction {}\n",
             of.results.participants, plan.participants, plan.alpha, name_of(plan.correction));
  for (const std::string& note : plan.notes) fmt::print(out, "Plan: {}\n", note);
  for (const std::string& sentence : of.results.left_out) fmt::print(out, "{}\n", sentence);
  for (std::size_t i = 0; i < of.results.results.size(); ++i)
    print_result(out, plan, of.results.results[i], i + 1);
  fmt::print(out, "\nExploratory: everything below was not planned, and uses all answers\n\n");
}

nlohmann::ordered_json confirmed_json(const Confirmed& of) {
  nlohmann::ordered_json results = nlohmann::ordered_json::array();
  for (const PlannedResult& result : of.results.results) results.push_back(result_json(result));
  return {{"plan", of.file},
          {"created_utc", of.plan.created_utc},
          {"sha256", of.plan.sha256},
          {"measure", name_of(of.plan.measure)},
          {"test", name_of(of.plan.test)},
          {"alpha", of.plan.alpha},
          {"correction", name_of(of.plan.correction)},
          {"planned_participants", of.plan.participants},
          {"participants", of.results.participants},
          {"notes", of.plan.notes},
          {"left_out", of.results.left_out},
          {"results", results}};
}

}  // namespace prostm::app
