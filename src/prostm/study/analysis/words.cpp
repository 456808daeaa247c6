#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "prostm/study/analysis/analysis.hpp"

namespace prostm {
namespace {

std::string share_text(const Proportion& x) {
  return fmt::format("{} of {} answers were right ({:.1f} %)", x.successes, x.trials,
                     100.0 * x.value());
}

/// Writes the sentences of an analysis, one after the other.
class Words {
 public:
  explicit Words(const Analysis& analysis)
      : analysis_(analysis), alpha_(1.0 - analysis.settings.level) {}

  std::string text() {
    const SceneResult& all = analysis_.scenes.front();
    say_missing();
    if (is_one_person()) {
      say("All answers are of one participant, so results about people in general are left out "
          "(tests over participants, dispersion)");
    }
    if (analysis_.kind == AnswerKind::Felt) {
      say("Answers are for the level (yes, or its interval of the two) or against it; neither is "
          "wrong");
      say_thresholds();
      return text_;
    }
    for (const MethodResult& method : all.methods) say_method(method);
    for (const Comparison& of : all.comparisons) {
      say_difference(of);
      say_size(of);
    }
    for (std::size_t i = 1; i < analysis_.scenes.size(); ++i) say_scene(analysis_.scenes[i]);
    const std::size_t looks = analysis_.scenes.size() * all.comparisons.size();
    if (looks > 1) say_looks(looks);
    if (!analysis_.thresholds.empty()) say_thresholds();
    return text_;
  }

 private:
  void say(const std::string& sentence) {
    text_ += text_.empty() ? "" : " ";
    text_ += sentence + '.';
  }

  bool is_one_person() const { return analysis_.participants.size() == 1; }

  void say_missing() {
    const std::string missing = in_words(analysis_.missing, analysis_.kind);
    text_ += missing;
    if (analysis_.left_out.empty()) return;
    say(fmt::format("Participants left out because they answered no trial of some scene: {}",
                    fmt::join(analysis_.left_out, ", ")));
  }

  bool is_significant(double p) const { return p < alpha_; }
  const char* verdict(double p) const {
    return is_significant(p) ? "significant" : "not significant";
  }

  void say_method(const MethodResult& method) {
    const double chance = 100.0 * analysis_.settings.chance;
    const bool above = method.correct.value() > analysis_.settings.chance;
    std::string sentence = fmt::format("With {} {}", method.method, share_text(method.correct));
    if (is_significant(method.p_chance)) {
      sentence += fmt::format(", which is {} the {:g} % of guessing ({})",
                              above ? "above" : "below", chance, p_in_words(method.p_chance));
    } else {
      sentence += fmt::format(", which is compatible with guessing ({:g} %, {})", chance,
                              p_in_words(method.p_chance));
    }
    say(sentence);
  }

  void say_difference(const Comparison& of) {
    say(
        fmt::format("If all answers were independent, the difference between {} and {} would be "
                    "{} (z = {:.2f}, {})",
                    of.first, of.second, verdict(of.pooled_z.p), of.pooled_z.statistic,
                    p_in_words(of.pooled_z.p)));
    if (is_one_person()) return;
    say_dispersion();
    if (!of.permutation) {
      say(fmt::format(
          "A test over participants needs two with each method, but {} or {} has only one, so "
          "differences between methods and between people cannot be separated",
          of.first, of.second));
      return;
    }
    const bool within = analysis_.groups == Groups::Within;
    std::string sentence = fmt::format(
        "Over participants, the test that generalises to other people, it is {} (permutation {}",
        verdict(of.permutation->p), p_in_words(of.permutation->p));
    if (of.t)
      sentence += fmt::format("; {} {}", within ? "paired t" : "Welch's t", p_in_words(of.t->p));
    say(sentence + ")");
    if (!is_significant(of.permutation->p) && !(of.equal && is_significant(of.equal->p()))) {
      say(fmt::format(
          "So these data show neither that {} and {} differ for people in general, nor that they "
          "are equal",
          of.first, of.second));
    }
  }

  void say_dispersion() {
    std::string sentence;
    for (const MethodResult& method : analysis_.scenes.front().methods) {
      if (!method.dispersion || !is_significant(method.dispersion->p)) continue;
      const double ratio = method.dispersion->statistic / method.dispersion->df;
      sentence +=
          sentence.empty()
              ? fmt::format(
                    "They are not independent: participants differ {:.1f} times as much with {} "
                    "as they would with independent answers ({})",
                    ratio, method.method, p_in_words(method.dispersion->p))
              : fmt::format(", and {:.1f} times as much with {} ({})", ratio, method.method,
                            p_in_words(method.dispersion->p));
    }
    say(sentence.empty() ? "Answers of one participant are never entirely independent" : sentence);
  }

  /// Describes which comparisons are significant after the correction for their number.
  void say_looks(std::size_t looks) {
    const std::string start = fmt::format(
        "These are {} comparisons, and p values in the text are not corrected for their number",
        looks);
    std::vector<std::string> shown;
    bool any = false;
    for (const SceneResult& scene : analysis_.scenes) {
      for (const Comparison& of : scene.comparisons) {
        any = any || of.holm_p;
        if (!of.holm_p || !is_significant(*of.holm_p)) continue;
        shown.push_back(fmt::format("{} and {} in {} ({})", of.first, of.second,
                                    scene.scene.empty() ? "all scenes" : scene.scene,
                                    p_in_words(*of.holm_p)));
      }
    }
    if (!any) return say(start);
    say(start + (shown.empty() ? std::string("; after Holm's correction none is significant")
                               : fmt::format("; after Holm's correction these are significant: {}",
                                             fmt::join(shown, ", "))));
  }

  void say_scene(const SceneResult& scene) {
    for (const Comparison& of : scene.comparisons) {
      const auto share = [&](const std::string& name) {
        for (const MethodResult& method : scene.methods) {
          if (method.method == name) return 100.0 * method.correct.value();
        }
        return 0.0;
      };
      std::string sentence = fmt::format(
          "In {} alone ({:.1f} % with {}, {:.1f} % with {}) the difference is {} over answers (z = "
          "{:.2f}, {})",
          scene.scene, share(of.first), of.first, share(of.second), of.second,
          verdict(of.pooled_z.p), of.pooled_z.statistic, p_in_words(of.pooled_z.p));
      if (of.permutation) {
        sentence += fmt::format(" and {} over participants ({})", verdict(of.permutation->p),
                                p_in_words(of.permutation->p));
      }
      say(sentence);
    }
  }

  /// Describes the size of a difference over participants.
  void say_size(const Comparison& of) {
    if (!of.difference) return;
    const double percent = 100.0 * analysis_.settings.level;
    say(
        fmt::format("{} minus {} is {:.1f} percentage points ({:g} % interval {:.1f} to {:.1f}), "
                    "{} = {:.2f} ({:.2f} to {:.2f})",
                    of.second, of.first, 100.0 * of.difference->value, percent,
                    100.0 * of.difference->interval.low, 100.0 * of.difference->interval.high,
                    analysis_.groups == Groups::Within ? "d_z" : "d", of.effect->value,
                    of.effect->interval.low, of.effect->interval.high));
    const double factor = *of.bayes_factor;
    say(fmt::format("The data are {} times as likely {} a difference as {} (Bayes factor {})",
                    factor_in_words(std::max(factor, 1.0 / factor)),
                    factor >= 1.0 ? "with" : "without", factor >= 1.0 ? "without" : "with",
                    factor_in_words(factor)));
    if (of.equal) say_equivalence(*of.equal);
  }

  void say_equivalence(const Equivalence& of) {
    say(fmt::format(
        "The difference is {}within ± {:g} percentage points (two one-sided t tests, "
        "{}; {:g} % interval {:.1f} to {:.1f})",
        is_significant(of.p()) ? "" : "not shown to be ", 100.0 * of.bound, p_in_words(of.p()),
        100.0 * (1.0 - 2.0 * alpha_), 100.0 * of.interval.low, 100.0 * of.interval.high));
  }

  void say_thresholds() {
    if (analysis_.kind == AnswerKind::Right) {
      say("Shares of right answers compare methods only if all were presented at the same levels; "
          "thresholds do not depend on the levels");
    }
    const std::vector<ThresholdResult>& all = analysis_.thresholds;
    for (std::size_t i = 0; i < all.size();) {
      std::size_t end = i + 1;  // end of its participants
      while (end < all.size() && !all[end].participant.empty()) ++end;
      say_threshold(all[i], std::span(all).subspan(i + 1, end - i - 1));
      i = end;
    }
    const std::string lapse =
        analysis_.settings.lapse
            ? fmt::format("{:g} %", 100.0 * (1.0 - *analysis_.settings.lapse))
            : fmt::format("1 minus the lapse rate, which is fitted from 0 to {:g} %",
                          100.0 * kMostLapse);
    say(
        fmt::format("A threshold is the level half-way between {} ({:g} %) and the maximum ({}); "
                    "intervals assume independent answers{}",
                    analysis_.kind == AnswerKind::Right ? "guessing" : "the minimum",
                    100.0 * *analysis_.settings.guess, lapse,
                    is_one_person() ? ""
                                    : ", and are too narrow for people in general if participants "
                                      "differ"));
  }

  /// Describes a fitted threshold, or its bounds.
  std::string threshold_text(const ThresholdResult& of) const {
    const int digits = level_digits(of.scores);
    const double percent = 100.0 * analysis_.settings.level;
    const auto is_open = [](const Interval& x) { return std::isinf(x.low) && std::isinf(x.high); };
    const std::string why = in_words(of.no_fit, analysis_.kind);
    if (of.fit) {
      const std::string found =
          fmt::format("the threshold is {:.{}g}", of.fit->function.threshold, digits);
      if (!of.fit->threshold) return found + ", and its interval is unbounded";
      return fmt::format("{} ({:g} % interval {})", found, percent,
                         bounds_text(*of.fit->threshold, digits));
    }
    if (!of.bounds) return "no threshold can be fitted: " + why;
    const std::string best = bounds_text(of.bounds->best, digits);
    if (is_open(of.bounds->interval)) {
      return fmt::format("{}; the best threshold is {}, and its interval is unbounded", why, best);
    }
    const bool between = of.no_fit == NoFit::Step;
    return fmt::format(
        "{}, so the answers bound the threshold but not the slope: it is {}{} ({:g} % interval of "
        "the likelihood over all slopes: {})",
        why, between ? "best from " : "", best, percent, bounds_text(of.bounds->interval, digits));
  }

  void say_threshold(const ThresholdResult& of, std::span<const ThresholdResult> participants) {
    std::string sentence =
        fmt::format("With {} in {}, {}", of.method, of.scene, threshold_text(of));
    if (participants.size() > 1) {
      const auto fitted = std::count_if(participants.begin(), participants.end(),
                                        [](const ThresholdResult& x) { return !!x.fit; });
      const auto bounded = std::count_if(participants.begin(), participants.end(),
                                         [](const ThresholdResult& x) { return !!x.bounds; });
      sentence += fmt::format("; {} of {} participants have a fit of their own", fitted,
                              participants.size());
      if (bounded > 0) sentence += fmt::format(", {} only bounds", bounded);
      sentence += thresholds_text(of, participants);
    }
    say(sentence);
    if (of.fit && of.fit->misfit && is_significant(of.fit->misfit->p)) say_misfit(of);
  }

  /// Describes the range of the participants' own thresholds.
  static std::string thresholds_text(const ThresholdResult& all,
                                     std::span<const ThresholdResult> participants) {
    std::vector<double> own;
    for (const ThresholdResult& x : participants) {
      if (x.fit) own.push_back(x.fit->function.threshold);
    }
    if (own.empty()) return {};
    const auto [low, high] = std::minmax_element(own.begin(), own.end());
    const int digits = level_digits(all.scores);
    return fmt::format(", with thresholds from {:.{}g} to {:.{}g}", *low, digits, *high, digits);
  }

  void say_misfit(const ThresholdResult& of) {
    const Misfit& misfit = *of.fit->misfit;
    std::string why = is_one_person()
                          ? "this person lapses more often than assumed, or changes with time"
                          : "participants differ, or lapse more often than assumed";
    say(
        fmt::format("This function does not fit the answers (deviance {:.1f} with {} degrees of "
                    "freedom, {}), so its threshold and interval may be wrong; perhaps {}{}",
                    misfit.deviance, misfit.df, p_in_words(misfit.p), why,
                    analysis_.settings.lapse ? " (--fit-lapse)" : ""));
  }

  const Analysis& analysis_;
  double alpha_;
  std::string text_;
};

}  // namespace

std::string factor_in_words(double factor) {
  constexpr double kOverwhelming = 1e6;  // beyond that only rounding and assumptions matter
  if (factor > kOverwhelming) return "above 10^6";
  if (factor < 1.0 / kOverwhelming) return "below 10^-6";
  const bool is_far = factor >= 1000.0 || factor < 0.001;
  return fmt::format("{:.{}g}", factor, is_far ? 2 : 3);
}

std::string p_in_words(double p) {
  return p < 0.001 ? std::string("p < 0.001") : fmt::format("p = {:.3f}", p);
}

std::string in_words(std::span<const MissingAnswers> missing, AnswerKind kind) {
  if (missing.empty()) return {};
  std::string out;
  for (const MissingAnswers& of : missing) {
    if (of.missing == 0) continue;
    out += fmt::format("{}with {} in {} {} of {} trials ({:.1f} %, of {} participant{}",
                       out.empty() ? "" : ", ", of.method, of.scene, of.missing, of.trials,
                       100.0 * of.missing / of.trials, of.participants,
                       of.participants == 1 ? "" : "s");
    if (kind == AnswerKind::Right) {
      out += fmt::format("; {:.1f} % right if all of them were wrong, {:.1f} % if all were right",
                         100.0 * of.if_answered.low, 100.0 * of.if_answered.high);
    }
    out += ')';
  }
  return "Trials without an answer are left out: " + out +
         ". Shares are biased if wrong answers are missing more often than right ones.";
}

std::string in_words(const Analysis& analysis) {
  return Words(analysis).text();
}

}  // namespace prostm
