#include "prostm/io/hand/detail/hand_lines.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "prostm/core/file/file_kind.hpp"
#include "prostm/core/input_error.hpp"

namespace prostm {

std::string_view next_line(std::string_view& text, std::size_t& line) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view found = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    ++line;
    if (found.find_first_not_of(" \t\r") != found.npos) return found;
  }
  return {};
}

bool is_json_or_lines(std::string_view text) {
  text = without_mark(text);
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first != text.npos && (text[first] == '{' || text[first] == '[');
}

bool has_value_a_line(std::string_view text) {
  std::size_t line = 0;
  const std::string_view first = next_line(text, line), second = next_line(text, line);
  if (second.empty()) return false;
  // the first line may be damaged; for a list on several lines it is the bracket
  return nlohmann::json::accept(first) ||
         (first.find('{') != first.npos && nlohmann::json::accept(second));
}

void refuse_as_hands(const std::string& name, const std::string& what) {
  throw InputError(name + " " + what +
                   "; a hand recording is hand-frames JSON Lines (.hands.jsonl) or a recording of "
                   "a Leap (.json), see docs/guides/hands.md");
}

}  // namespace prostm
