#include "prostm/study/analysis/detail/identities.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include "prostm/core/input_error.hpp"
#include "prostm/core/text/nearest_name.hpp"
#include "prostm/study/session/spelling.hpp"

namespace prostm::study {
namespace {

/// A kind of names in answers.
struct NameKind {
  const char* name;
  std::vector<std::string Answer::*> members;
};
const std::vector<NameKind>& name_kinds() {
  static const std::vector<NameKind> kinds = {{"participant", {&Answer::participant}},
                                              {"method", {&Answer::method}},
                                              {"scene", {&Answer::scene, &Answer::question}}};
  return kinds;
}

/// Names in order of first appearance, without unknown names.
std::vector<std::string> names_of(std::span<const Answer> answers, const NameKind& kind) {
  std::vector<std::string> out;
  std::set<std::string_view> known;
  for (const Answer& a : answers) {
    for (const auto member : kind.members) {
      if (!(a.*member).empty() && known.insert(a.*member).second) out.push_back(a.*member);
    }
  }
  return out;
}

void replace(std::vector<Answer>& answers, const NameKind& kind,
             const std::map<std::string, std::string>& names) {
  for (Answer& a : answers) {
    for (const auto member : kind.members) {
      const auto found = names.find(a.*member);
      if (found != names.end()) a.*member = found->second;
    }
  }
}

using Parts = std::vector<std::string>;

Parts parts_of(const std::string& path, IdPrefix prefix) {
  const std::filesystem::path full = std::filesystem::absolute(path).lexically_normal();
  Parts out;
  for (const auto& part : full.parent_path()) out.push_back(part.string());
  if (prefix == IdPrefix::File) out.push_back(full.stem().string());
  return out;
}

/// Removes the last part as long as all share it and each keeps at least one part.
void strip_common_ends(std::vector<Parts>& all) {
  const auto goes = [&](const Parts& parts) {
    return parts.size() > 1 && parts.back() == all.front().back();
  };
  while (std::all_of(all.begin(), all.end(), goes)) {
    for (Parts& parts : all) parts.pop_back();
  }
}

void reverse(std::vector<Parts>& all) {
  for (Parts& parts : all) std::reverse(parts.begin(), parts.end());
}

}  // namespace

std::vector<std::string> distinct_parts(std::span<const std::string> paths, IdPrefix prefix) {
  std::vector<Parts> all;
  for (const std::string& path : paths) all.push_back(parts_of(path, prefix));
  reverse(all);
  strip_common_ends(all);  // beginnings
  reverse(all);
  strip_common_ends(all);
  std::vector<std::string> out;
  for (const Parts& parts : all) out.push_back(fmt::format("{}", fmt::join(parts, "/")));
  return out;
}

void rename(std::vector<Answer>& answers, std::span<const std::string> renames) {
  for (const std::string& text : renames) {
    const std::size_t colon = text.find(':'), equals = text.rfind('=');
    const auto kind =
        std::find_if(name_kinds().begin(), name_kinds().end(), [&](const NameKind& of) {
          return text.substr(0, std::min(colon, text.size())) == of.name;
        });
    if (kind == name_kinds().end() || equals == std::string::npos || equals < colon ||
        trimmed(text.substr(equals + 1)).empty()) {
      throw InputError("--rename " + shown_name(text) +
                       ": give participant:OLD=NEW, method:OLD=NEW or scene:OLD=NEW");
    }
    const std::string from = trimmed(text.substr(colon + 1, equals - colon - 1));
    const auto known = names_of(answers, *kind);
    if (std::find(known.begin(), known.end(), from) == known.end()) {
      throw InputError(fmt::format("--rename {}: there is no {} \"{}\"{}", shown_name(text),
                                   kind->name, shown_name(from), did_you_mean(from, known)));
    }
    replace(answers, *kind, {{from, trimmed(text.substr(equals + 1))}});
  }
}

void settle_spellings(std::vector<Answer>& answers, bool merge, std::vector<std::string>& notes) {
  for (const NameKind& kind : name_kinds()) {
    std::map<std::string, std::string> first_of, others;  // by key; by name
    std::string pairs;
    for (const std::string& name : names_of(answers, kind)) {
      const auto [found, is_new] = first_of.emplace(spelling_key(name), name);
      if (is_new) continue;
      others[name] = found->second;
      constexpr std::size_t kMostShown = 3;
      if (others.size() <= kMostShown) {
        pairs += fmt::format("{}\"{}\" and \"{}\"", pairs.empty() ? "" : ", ",
                             shown_name(found->second), shown_name(name));
      }
    }
    if (others.empty()) continue;
    const std::string what =
        fmt::format("{}s {}{}", kind.name, pairs, others.size() > 3 ? " and others" : "");
    if (!merge) {
      const auto& [name, first] = *others.begin();
      throw InputError(fmt::format(
          "{} differ only in spelling; if each pair is one {}, add --merge-spellings; if not, "
          "rename one of them, e.g. --rename \"{}:{}={}-b\"",
          what, kind.name, kind.name, name, name));
    }
    notes.push_back(
        fmt::format("The {} differ only in spelling; each pair is treated as one.", what));
    replace(answers, kind, others);
  }
}

}  // namespace prostm::study
