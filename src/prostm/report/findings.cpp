#include "prostm/report/findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace prostm::report {
namespace {

using enum Agreement;

constexpr double kEqual = 0.005;  // difference of shapes below which they count as equal

/// "5.7 dB below the threshold of touch"
std::string level_words(double level) {
  return fmt::format("{:.1f} dB {} the threshold of touch", std::abs(level),
                     level < 0.0 ? "below" : "above");
}

std::string better_with(const Scores& of) {
  const auto [better, worse] = of.am > of.pro_stm
                                   ? std::pair(fmt::format("AM ({:.1f} %)", of.am),
                                               fmt::format("PRO-STM ({:.1f} %)", of.pro_stm))
                                   : std::pair(fmt::format("PRO-STM ({:.1f} %)", of.pro_stm),
                                               fmt::format("AM ({:.1f} %)", of.am));
  return fmt::format("better with {} than with {}", better, worse);
}

const std::string& title_of(const std::string& section, const std::vector<Part>& parts) {
  const auto part = std::ranges::find(parts, section, &Part::name);
  if (part == parts.end()) throw std::invalid_argument("no part is called " + section);
  return part->document.at("title").get_ref<const std::string&>();
}

}  // namespace

Finding reversal(const Scores& models, const Scores& people) {
  const bool same = (models.am > models.pro_stm) == (people.am > people.pro_stm);
  return {"models", same ? Agrees : Differs,
          fmt::format("Models of the skin do the paper's study {}. People did it {}: {}.",
                      better_with(models), better_with(people),
                      same ? "the same order" : "the reverse")};
}

Finding squares(int inside, int skins) {
  const bool agrees = 2 * inside > skins;
  return {"skin", agrees ? Agrees : Differs,
          fmt::format("Published: the skin vibrates most inside a square of 3 cm drawn at 8 to "
                      "10 m/s. The model of the skin has such a maximum {}, on {} of {} skins.",
                      agrees ? "too" : (inside == 0 ? "nowhere" : "rarely"), inside, skins)};
}

Finding circles(const std::vector<double>& peaks, Published published) {
  const auto farther = [&](double peak) {
    return std::max(peak - published.high, published.low - peak);
  };
  const double worst = *std::ranges::max_element(peaks, {}, farther);
  const Verdict verdict =
      compare(peaks.size() == 1 ? "A circle feels strongest at"
                                : "The circle that fits worst feels strongest at",
              worst, published, {1, " m/s"});
  return {"skin", verdict.agreement, verdict.text};
}

Finding one_circle(const std::string& scene, const Quality& circle, const Quality& paths) {
  const double louder = circle.felt_level - paths.felt_level;
  return {"methods", louder > 0.0 ? Differs : Agrees,
          fmt::format("One plain circle is felt {:.1f} dB {} than the paths of preset best at the "
                      "same drive ({}): {}, not {}. Its felt shape is {:.2f}, not {:.2f}.",
                      std::abs(louder), louder > 0.0 ? "stronger" : "weaker", scene,
                      level_words(circle.felt_level), level_words(paths.felt_level),
                      circle.felt_shape, paths.felt_shape)};
}

Finding felt_strength(const std::string& scene, double low, const std::string& words) {
  return {"methods", low > 0.0 ? Agrees : Differs,
          fmt::format("Felt strength of preset best at full drive ({}): {}.", scene, words)};
}

Finding promised_shape(const std::string& scene, const Quality& best) {
  const double lost = best.shape - best.felt_shape;
  return {"methods", lost > kEqual ? Differs : Agrees,
          fmt::format("Shape by Eq. (1) promises {} is felt: {:.2f} with preset best ({}), where "
                      "the felt shape is {:.2f}.",
                      lost > kEqual ? "more than" : "no more than", best.shape, scene,
                      best.felt_shape)};
}

Finding felt_shapes(const std::string& scene, const Quality& felt, const Quality& best,
                    const Quality& am) {
  const bool ahead = std::max(felt.felt_shape, best.felt_shape) > am.felt_shape;
  return {"methods", ahead ? Agrees : Differs,
          fmt::format("Felt shape ({}): {:.2f} with preset felt, {:.2f} with preset best, {:.2f} "
                      "with AM; {} ahead.",
                      scene, felt.felt_shape, best.felt_shape, am.felt_shape,
                      ahead ? "PRO-STM is" : "AM is")};
}

Finding shapes_by_eq1(const std::string& scene, double best, double paper) {
  const bool ahead = best > paper;
  return {"table-1", ahead ? Agrees : Differs,
          fmt::format("By Eq. (1) preset best {} the paper's algorithm ({}): shape {:.2f}, not "
                      "{:.2f}.",
                      ahead ? "beats" : "does not beat", scene, best, paper)};
}

Finding plan_times(const std::string& scene, double here, double paper) {
  return {
      "table-1", NotComparable,
      fmt::format("The paper's algorithm takes {:.1f} ms a plan here ({}, mean) and took {:.1f} "
                  "ms in the paper, on another machine with other fields.",
                  here, scene, paper)};
}

Finding latency(const KeptUp& run) {
  const bool kept_up = run.skipped == 0 && run.missed == 0;
  std::string text = fmt::format(
      "From a tracker's frame to its first sample pass {:.0f} ms (median; p99 {:.0f} "
      "ms) in real time; ",
      run.p50, run.p99);
  text += kept_up ? "no step of the smoke was skipped and no block of samples was missed."
                  : fmt::format(
                        "this machine did not keep up: {} of {} steps of the smoke were "
                        "skipped and {} blocks of samples missed, so the times leave out "
                        "the work that was skipped.",
                        run.skipped, run.steps + run.skipped, run.missed);
  return {"latency", kept_up ? Agrees : Differs, text};
}

Part findings_part(std::vector<Finding> findings, const std::vector<std::string>& notes,
                   const std::vector<Part>& parts) {
  std::ranges::stable_sort(findings, [](const Finding& a, const Finding& b) {
    return std::pair(a.section != "models", a.agreement) <
           std::pair(b.section != "models", b.agreement);
  });
  nlohmann::ordered_json blocks = nlohmann::ordered_json::array();
  for (const Finding& one : findings) {
    blocks.push_back({{"finding",
                       {{"agreement", to_string(one.agreement)},
                        {"text", one.text},
                        {"section", one.section},
                        {"link", title_of(one.section, parts)}}}});
  }
  for (const std::string& note : notes) blocks.push_back(open_block(text_block(note)));
  return {"findings",
          {{"format", "prostm-report-part/1"},
           {"part", "findings"},
           {"title", "Findings"},
           {"values", nlohmann::ordered_json::object()},
           {"blocks", nlohmann::ordered_json::array()},
           {"timing", blocks}}};
}

}  // namespace prostm::report
