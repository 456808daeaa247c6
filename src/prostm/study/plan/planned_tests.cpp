#include "prostm/study/plan/planned_tests.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

#include "prostm/core/input_error.hpp"
#include "prostm/study/analysis/analysis.hpp"
#include "prostm/study/analysis/thresholds.hpp"

namespace prostm {
namespace {

/// Each participant's value, by name.
using Values = std::map<std::string, double>;

/// Leaves out what the plan's rules exclude, and describes it.
class Excluder {
 public:
  explicit Excluder(const Exclusions& rules) : rules_(rules) {}

  std::vector<Answer> keep(std::span<const Answer> trials, std::span<const SessionFacts> sessions) {
    std::vector<Answer> out;
    for (const SessionFacts& session : sessions) judge(session);
    for (const Answer& a : trials) {
      if (!a.answered || is_excluded(a)) continue;
      out.push_back(a);
    }
    return out;
  }
  std::vector<std::string> sentences() const {
    std::vector<std::string> out;
    for (const auto& [reason, people] : people_)
      out.push_back(fmt::format("{}, left out: {}.", reason, fmt::join(people, ", ")));
    if (rules_.overridden_gate)
      out.push_back(fmt::format("Trials left out because the gate did not pass: {}.", gate_));
    if (rules_.response_below || rules_.response_above)
      out.push_back(fmt::format("Trials left out by response time: {}.", time_));
    return out;
  }

 private:
  void judge(const SessionFacts& of) {
    if (rules_.incomplete && !of.finished) leave_out(of, "Sessions not finished");
    if (rules_.failed_practice && !of.passed_practice)
      leave_out(of, "Practice without its criterion");
    if (rules_.wrong_checks_above && of.wrong_checks > *rules_.wrong_checks_above) {
      leave_out(of, fmt::format("More than {:g} % of catch and attention trials wrong",
                                100.0 * *rules_.wrong_checks_above));
    }
  }
  void leave_out(const SessionFacts& of, const std::string& reason) {
    people_[reason].insert(of.participant);
    excluded_.insert(of.participant);
  }

  bool is_excluded(const Answer& a) {
    if (excluded_.contains(a.participant)) return true;
    if (rules_.overridden_gate && a.gate == "anyway") return ++gate_, true;
    const bool fast =
        rules_.response_below && a.response_s && *a.response_s < *rules_.response_below;
    const bool slow =
        rules_.response_above && a.response_s && *a.response_s > *rules_.response_above;
    if (fast || slow) return ++time_, true;
    return false;
  }

  const Exclusions& rules_;
  std::map<std::string, std::set<std::string>> people_;  // by the reason
  std::set<std::string> excluded_;
  int gate_ = 0, time_ = 0;
};

/// Means over the participants' answers.
template <class Value>
Values means(std::span<const Answer> answers, const std::string& method, const std::string& scene,
             const Value& value) {
  std::map<std::string, std::pair<double, int>> sums;
  for (const Answer& a : answers) {
    if (a.method != method || (!scene.empty() && a.scene != scene)) continue;
    auto& [sum, count] = sums[a.participant];
    sum += value(a);
    ++count;
  }
  Values out;
  for (const auto& [participant, of] : sums) out[participant] = of.first / of.second;
  return out;
}

class Runner {
 public:
  Runner(const StudyPlan& plan, std::vector<Answer> answers, std::uint64_t seed)
      : plan_(plan), answers_(std::move(answers)), seed_(seed) {
    if (plan.measure == Measure::Threshold) fit(seed);
    // groups of the first protocol; all have the same methods
    const auto& study = plan.protocols.front().protocol.at("study");
    within_ = study.at("methods").get<std::string>() == name_of(MethodsOf::Within);
  }

  std::vector<PlannedResult> run() {
    std::vector<PlannedResult> out;
    for (const PlannedComparison& of : plan_.comparisons) out.push_back(result(of));
    std::vector<double> p;
    for (const PlannedResult& of : out) p.push_back(of.test ? of.test->p : 1.0);
    const std::vector<double> corrected = plan_.correction == Correction::Holm ? holm(p) : p;
    for (std::size_t i = 0; i < out.size(); ++i) {
      out[i].corrected_p = corrected[i];
      out[i].significant = corrected[i] < plan_.alpha;
    }
    return out;
  }
  const std::set<std::string>& without_fit() const { return without_fit_; }
  const std::set<std::string>& without_pair() const { return without_pair_; }

 private:
  void fit(std::uint64_t seed) {
    const bool is_felt = answers_.front().kind == AnswerKind::Felt;
    const PsychometricSettings settings = {is_felt ? 0.0 : plan_.chance, kLapse, 1.0 - plan_.alpha,
                                           seed};
    thresholds_ = fit_thresholds(answers_, settings);
  }

  Values values(const std::string& method, const std::string& scene) {
    if (plan_.measure == Measure::Right)
      return means(answers_, method, scene, [](const Answer& a) { return a.correct ? 1.0 : 0.0; });
    if (plan_.measure == Measure::Level)
      return means(answers_, method, scene, [](const Answer& a) { return *a.level; });
    Values out;
    for (const ThresholdResult& of : thresholds_) {
      if (of.method != method || of.scene != scene || of.participant.empty()) continue;
      if (of.fit) {
        out[of.participant] = of.fit->function.threshold;
      } else {
        without_fit_.insert(of.participant);
      }
    }
    return out;
  }

  PlannedResult result(const PlannedComparison& of) {
    PlannedResult out;
    out.of = of;
    Values first = values(of.first, of.scene), second;
    const bool with_chance = of.second.empty();
    if (with_chance) {
      for (const auto& [participant, value] : first) second[participant] = plan_.chance;
      std::swap(first, second);  // differences are from chance
    } else {
      second = values(of.second, of.scene);
    }
    out.groups = within_ || with_chance ? Groups::Within : Groups::Between;
    if (out.groups == Groups::Within) keep_pairs(first, second);
    std::vector<double> a, b;
    for (const auto& [participant, value] : first) a.push_back(value);
    for (const auto& [participant, value] : second) b.push_back(value);
    out.first = group(with_chance ? b : a);
    out.second = group(with_chance ? a : b);
    if (!a.empty() && !b.empty()) compare({a, b, out.groups}, out);
    return out;
  }

  static PlannedGroup group(const std::vector<double>& of) {
    PlannedGroup out;
    out.participants = static_cast<int>(of.size());
    double sum = 0.0;
    for (const double x : of) sum += x;
    if (!of.empty()) out.mean = sum / static_cast<double>(of.size());
    return out;
  }

  /// Leaves out participants with one of the two values.
  void keep_pairs(Values& a, Values& b) {
    const auto drop = [&](Values& from, const Values& other) {
      std::erase_if(from, [&](const auto& of) {
        if (other.contains(of.first)) return false;
        without_pair_.insert(of.first);
        return true;
      });
    };
    drop(a, b);
    drop(b, a);
  }

  void compare(const TwoSamples& of, PlannedResult& out) const {
    const bool within = of.groups == Groups::Within;
    out.difference = mean_difference(of, 1.0 - plan_.alpha);
    out.effect = standardised_difference(of, 1.0 - plan_.alpha);
    out.bayes_factor = bayes_factor(of);
    if (plan_.equivalence) out.equal = equivalence(of, *plan_.equivalence, plan_.alpha);
    if (plan_.test == PlannedTest::T) {
      out.test = within ? paired_t(of.a, of.b) : welch_t(of.a, of.b);
    } else if (out.difference) {
      const Permutation found =
          within ? paired_permutation(of.a, of.b, seed_) : permutation(of.a, of.b, seed_);
      out.test = TestResult{out.difference->value, 0.0, found.p};
    }
  }

  const StudyPlan& plan_;
  std::vector<Answer> answers_;
  std::uint64_t seed_;
  bool within_ = false;
  std::vector<ThresholdResult> thresholds_;
  std::set<std::string> without_fit_, without_pair_;
};

}  // namespace

ConfirmatoryResults run_plan(const StudyPlan& plan, std::span<const Answer> trials,
                             std::span<const SessionFacts> sessions, std::uint64_t seed) {
  Excluder excluder(plan.exclusions);
  std::vector<Answer> answers = excluder.keep(trials, sessions);
  if (answers.empty()) throw InputError("the plan's exclusions leave no answer");
  std::set<std::string> people;
  for (const Answer& a : answers) people.insert(a.participant);
  ConfirmatoryResults out;
  out.participants = static_cast<int>(people.size());
  out.left_out = excluder.sentences();
  Runner runner(plan, std::move(answers), seed);
  out.results = runner.run();
  if (!runner.without_fit().empty()) {
    out.left_out.push_back(fmt::format("Participants without a threshold of their own: {}.",
                                       fmt::join(runner.without_fit(), ", ")));
  }
  if (!runner.without_pair().empty()) {
    out.left_out.push_back(
        fmt::format("Participants without values of both methods, left out of the pairs: {}.",
                    fmt::join(runner.without_pair(), ", ")));
  }
  return out;
}

}  // namespace prostm
