#include <fmt/format.h>

#include <algorithm>

#include "prostm/study/analysis.hpp"

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
    if (analysis_.kind == AnswerKind::Felt) {
      say("Answers are for the level or not, and neither is wrong: yes, or the level's interval of "
          "two");
      say_thresholds();
      return text_;
    }
    for (const MethodResult& method : all.methods) say_method(method);
    for (const Comparison& of : all.comparisons) say_difference(of);
    for (std::size_t i = 1; i < analysis_.scenes.size(); ++i) say_scene(analysis_.scenes[i]);
    const std::size_t looks = analysis_.scenes.size() * all.comparisons.size();
    if (looks > 1)
      say(fmt::format("These are {} comparisons, and no p is corrected for their number", looks));
    for (const Comparison& of : all.comparisons) say_needed(of);
    if (!analysis_.thresholds.empty()) say_thresholds();
    return text_;
  }

 private:
  void say(const std::string& sentence) {
    text_ += text_.empty() ? "" : " ";
    text_ += sentence + '.';
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
      sentence += fmt::format(", which guessing would do too ({:g} %, {})", chance,
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
    say_dispersion();
    const bool within = analysis_.groups == Groups::Within;
    std::string sentence = fmt::format(
        "Over participants, the test that holds for other people, it is {} (permutation {}",
        verdict(of.permutation.p), p_in_words(of.permutation.p));
    if (of.t)
      sentence += fmt::format("; {} {}", within ? "paired t" : "Welch's t", p_in_words(of.t->p));
    say(sentence + ")");
    if (!is_significant(of.permutation.p)) {
      say(fmt::format(
          "So these data do not show that {} and {} differ for people in general; nor do "
          "they show that they do not",
          of.first, of.second));
    }
  }

  void say_dispersion() {
    std::string sentence;
    for (const MethodResult& method : analysis_.scenes.front().methods) {
      if (!method.dispersion || !is_significant(method.dispersion->p)) continue;
      const double ratio = method.dispersion->statistic / method.dispersion->df;
      sentence += sentence.empty()
                      ? fmt::format(
                            "They are not: participants differ {:.1f} times as much with {} "
                            "as independent answers would make them ({})",
                            ratio, method.method, p_in_words(method.dispersion->p))
                      : fmt::format(", and {:.1f} times as much with {} ({})", ratio, method.method,
                                    p_in_words(method.dispersion->p));
    }
    say(sentence.empty() ? "Trials of one participant are never quite independent" : sentence);
  }

  void say_scene(const SceneResult& scene) {
    for (const Comparison& of : scene.comparisons) {
      const auto share = [&](const std::string& name) {
        for (const MethodResult& method : scene.methods) {
          if (method.method == name) return 100.0 * method.correct.value();
        }
        return 0.0;
      };
      say(
          fmt::format("In {} alone ({:.1f} % with {}, {:.1f} % with {}) the difference is {} over "
                      "answers (z = {:.2f}, {}) and {} over participants ({})",
                      scene.scene, share(of.first), of.first, share(of.second), of.second,
                      verdict(of.pooled_z.p), of.pooled_z.statistic, p_in_words(of.pooled_z.p),
                      verdict(of.permutation.p), p_in_words(of.permutation.p)));
    }
  }

  void say_needed(const Comparison& of) {
    if (!of.d) return;
    const bool within = analysis_.groups == Groups::Within;
    if (!of.needed) {
      say(
          fmt::format("No number of participants below 10 000 would show a difference as small as "
                      "the one between {} and {} (d = {:.2f})",
                      of.first, of.second, *of.d));
      return;
    }
    say(
        fmt::format("To show a difference as large as the one between {} and {} (d = {:.2f}) in "
                    "{:g} of 100 studies, {} participants{} are needed; this one had {}",
                    of.first, of.second, *of.d, 100.0 * analysis_.settings.power, *of.needed,
                    within ? "" : " with each method", had()));
  }

  void say_thresholds() {
    if (analysis_.kind == AnswerKind::Right) {
      say("All of this is about shares of right answers, which compare methods only where all were "
          "asked at the same levels; thresholds hold for other levels too");
    }
    const std::vector<ThresholdResult>& all = analysis_.thresholds;
    for (std::size_t i = 0; i < all.size();) {
      std::size_t end = i + 1;  // of its participants
      while (end < all.size() && !all[end].participant.empty()) ++end;
      say_threshold(all[i], std::span(all).subspan(i + 1, end - i - 1));
      i = end;
    }
    say(
        fmt::format("A threshold is the level half-way between {} ({:g} %) and the most "
                    "({:g} %); intervals are as if answers were independent, and too narrow for "
                    "people in general where participants differ",
                    analysis_.kind == AnswerKind::Right ? "guessing" : "the least",
                    100.0 * *analysis_.settings.guess, 100.0 * (1.0 - *analysis_.settings.lapse)));
  }

  void say_threshold(const ThresholdResult& of, std::span<const ThresholdResult> participants) {
    std::string sentence = fmt::format("With {} in {}, ", of.method, of.scene);
    const auto text = [digits = level_digits(of.scores)](double level) {
      return fmt::format("{:.{}g}", level, digits);
    };
    if (!of.fit) {
      sentence += fmt::format("no threshold can be fitted: {}", in_words(of.no_fit));
    } else if (const auto& interval = of.fit->threshold) {
      sentence += fmt::format("the threshold is {} ({:g} % interval {} to {})",
                              text(of.fit->function.threshold), 100.0 * analysis_.settings.level,
                              text(interval->low), text(interval->high));
    } else {
      sentence += fmt::format("the threshold is {}, and the answers leave its interval open",
                              text(of.fit->function.threshold));
    }
    std::vector<double> own;
    for (const ThresholdResult& x : participants) {
      if (x.fit) own.push_back(x.fit->function.threshold);
    }
    sentence += fmt::format("; {} of {} single participants' answers have a fit", own.size(),
                            participants.size());
    if (!own.empty()) {
      const auto [low, high] = std::minmax_element(own.begin(), own.end());
      sentence += fmt::format(", with thresholds from {} to {}", text(*low), text(*high));
    }
    say(sentence);
  }

  std::string had() const {
    if (analysis_.groups == Groups::Within) return std::to_string(analysis_.participants.size());
    std::string out;
    for (const MethodResult& method : analysis_.scenes.front().methods) {
      out += out.empty() ? "" : " and ";
      out += std::to_string(method.of_participants.size());
    }
    return out;
  }

  const Analysis& analysis_;
  double alpha_;
  std::string text_;
};

}  // namespace

std::string p_in_words(double p) {
  return p < 0.001 ? std::string("p < 0.001") : fmt::format("p = {:.3f}", p);
}

std::string in_words(const Analysis& analysis) {
  return Words(analysis).text();
}

}  // namespace prostm
