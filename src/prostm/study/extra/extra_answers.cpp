#include "prostm/study/extra/extra_answers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "prostm/study/extra/extra_trials.hpp"
#include "prostm/study/task/line_keys.hpp"

namespace prostm {

double ExtraAnswers::wrong_share() const {
  const int given = catches.given + attention.given;
  return given == 0 ? 0.0 : 1.0 - static_cast<double>(catches.right + attention.right) / given;
}

ExtraAnswers extra_answers(std::span<const ResponseLine> lines) {
  ExtraAnswers out;
  const auto count = [](const ResponseLine& line, ExtraAnswers::Count& of) {
    ++of.given;
    of.right += line.at(line::kRight).get<int>();
  };
  for (const ResponseLine& line : lines) {
    const std::string kind = line.value(line::kKind, "");
    if (kind == name_of(ExtraKind::Catch)) count(line, out.catches);
    if (kind == name_of(ExtraKind::Attention)) count(line, out.attention);
    if (kind != line::kPractised) continue;
    const std::string method = line.at(line::kMethod);
    std::erase(out.failed_practice, method);
    if (!line.at(line::kPassed).get<bool>()) out.failed_practice.push_back(method);
  }
  return out;
}

std::vector<std::string> sentences(const ExtraAnswers& answers, const std::string& participant) {
  std::vector<std::string> out;
  const auto tell = [&](const ExtraAnswers::Count& of, const char* name) {
    if (of.right == of.given) return;
    out.push_back(fmt::format("Participant {} answered {} of {} {} trials wrongly.", participant,
                              of.given - of.right, of.given, name));
  };
  tell(answers.catches, "catch");
  tell(answers.attention, "attention");
  if (!answers.failed_practice.empty()) {
    out.push_back(fmt::format("Participant {} did not reach the criterion of the practice with {}.",
                              participant, fmt::join(answers.failed_practice, ", ")));
  }
  return out;
}

}  // namespace prostm
