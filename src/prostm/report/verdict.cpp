#include "prostm/report/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace prostm::report {
namespace {

std::string interval_words(Published published, const Shown& shown) {
  const auto number = [&](double value) { return fmt::format("{:.{}f}", value, shown.digits); };
  if (std::isinf(published.high))
    return fmt::format("above {}{}", number(published.low), shown.unit);
  if (std::isinf(published.low))
    return fmt::format("below {}{}", number(published.high), shown.unit);
  if (published.low == published.high) return number(published.low) + shown.unit;
  return fmt::format("{} to {}{}", number(published.low), number(published.high), shown.unit);
}

}  // namespace

std::string to_string(Agreement agreement) {
  switch (agreement) {
    case Agreement::Differs:
      return "differs";
    case Agreement::NotComparable:
      return "not comparable";
    case Agreement::Agrees:
      return "agrees";
  }
  return "";
}

Verdict compare(const std::string& statement, double value, Published published,
                const Shown& shown) {
  const double scale = std::pow(10.0, shown.digits);
  const auto rounded = [&](double x) { return std::round(scale * x) / scale; };
  const double above = rounded(value) - rounded(published.high);
  const double below = rounded(published.low) - rounded(value);
  std::string text = fmt::format("{} {:.{}f}{}; published: {}", statement, value, shown.digits,
                                 shown.unit, interval_words(published, shown));
  if (above <= 0.0 && below <= 0.0) return {Agreement::Agrees, text + "."};
  text += fmt::format(", so it is {:.{}f}{} too {}.", std::max(above, below), shown.digits,
                      shown.unit, above > 0.0 ? "high" : "low");
  return {Agreement::Differs, text};
}

Verdict not_comparable(const std::string& why) {
  return {Agreement::NotComparable, why};
}

void add_verdicts(nlohmann::ordered_json& blocks, std::vector<Verdict> verdicts) {
  std::ranges::stable_sort(verdicts, {}, &Verdict::agreement);
  for (const Verdict& verdict : verdicts) {
    blocks.push_back(
        {{"verdict", {{"agreement", to_string(verdict.agreement)}, {"text", verdict.text}}}});
  }
}

}  // namespace prostm::report
