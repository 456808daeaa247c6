#include "prostm/study/analysis/pair_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "prostm/core/file/file.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/core/text/nearest_name.hpp"
#include "prostm/study/analysis/detail/cells.hpp"
#include "prostm/study/analysis/detail/csv.hpp"
#include "prostm/study/analysis/detail/table_columns.hpp"
#include "prostm/study/analysis/detail/text_encoding.hpp"
#include "prostm/study/session/spelling.hpp"

namespace prostm {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{64} << 20;
constexpr std::array<std::string_view, 3> kTables = {".csv", ".tsv", ".txt"};

std::string quoted(const std::string& name) {
  return '"' + shown_name(name) + '"';
}

/// Places of the columns in a header.
struct PairColumns {
  std::optional<std::size_t> a, b, preferred, participant;
  bool is_complete() const { return a && b && preferred; }
};

PairColumns columns_of(const std::vector<std::string>& header) {
  PairColumns out;
  for (std::size_t i = 0; i < header.size(); ++i) {
    const std::string key = study::spelling_key(header[i]);
    if (key == "a") out.a = i;
    if (key == "b") out.b = i;
    if (key == "preferred") out.preferred = i;
    if (key == "participant") out.participant = i;
  }
  return out;
}

class PairReader {
 public:
  PairReader(std::string_view text, const std::string& file, Ties ties)
      : file_(file), ties_(ties), csv_(text, file, study::separator_of(text, file, {})) {
    std::vector<std::string> header;
    if (csv_.next(header)) columns_ = columns_of(header);
    size_ = header.size();
  }
  const PairColumns& columns() const { return columns_; }

  std::vector<PairedComparison> read(std::vector<std::string>& notes) {
    if (!columns_.is_complete())
      csv_.fail("a table of paired comparisons needs the columns a, b and preferred");
    std::vector<PairedComparison> out;
    for (std::vector<std::string> row; csv_.next(row);) {
      if (auto of_row = comparison(row)) out.push_back(std::move(*of_row));
    }
    if (out.empty()) throw InputError(file_ + ": has a header but no comparison");
    if (missing_ > 0)
      notes.push_back(
          fmt::format("{}: {} rows without a preference are left out.", file_, missing_));
    if (omitted_ > 0) notes.push_back(fmt::format("{}: {} ties are left out.", file_, omitted_));
    return out;
  }

 private:
  std::string name(const std::vector<std::string>& row, std::size_t place, const char* what) {
    std::string out = study::trimmed(row[place]);
    if (study::is_missing_name(out))
      csv_.fail(fmt::format("there is no name in the column {}", what));
    return out;
  }

  std::optional<PairedComparison> comparison(const std::vector<std::string>& row) {
    if (row.size() != size_)
      csv_.fail(fmt::format("the row has {} values, and the header {}", row.size(), size_));
    PairedComparison out;
    out.a = name(row, *columns_.a, "a");
    out.b = name(row, *columns_.b, "b");
    if (columns_.participant) out.participant = name(row, *columns_.participant, "participant");
    const std::string preferred = study::trimmed(row[*columns_.preferred]);
    if (out.a == out.b) csv_.fail(fmt::format("a and b are both {}", quoted(out.a)));
    if (study::is_missing(preferred)) {
      ++missing_;
      return std::nullopt;
    }
    if (preferred == out.a) return out;
    out.preferred = PairedComparison::Preferred::B;
    if (preferred == out.b) return out;
    if (study::spelling_key(preferred) != "tie") {
      csv_.fail(fmt::format("preferred is {}, but must be {}, {} or tie", quoted(preferred),
                            quoted(out.a), quoted(out.b)));
    }
    return tie(std::move(out));
  }

  std::optional<PairedComparison> tie(PairedComparison of) {
    if (ties_ == Ties::Refuse) {
      csv_.fail(
          "this is a tie; add --ties half, which counts it as half a preference for each, or "
          "--ties omit");
    }
    of.preferred = PairedComparison::Preferred::Neither;
    if (ties_ == Ties::Half) return of;
    ++omitted_;
    return std::nullopt;
  }

  const std::string& file_;
  Ties ties_;
  study::CsvReader csv_;
  PairColumns columns_;
  std::size_t size_ = 0;
  int missing_ = 0, omitted_ = 0;
};

}  // namespace

std::vector<PairedComparison> comparisons_from_csv(std::string_view text, const std::string& file,
                                                   Ties ties, std::vector<std::string>& notes) {
  const study::DecodedText decoded = study::decode_text(text, file);
  return PairReader(decoded.text, file, ties).read(notes);
}

bool is_pair_table(std::string_view text, const std::string& file) {
  const bool is_table = std::any_of(kTables.begin(), kTables.end(), [&](std::string_view ending) {
    return file.ends_with(ending);
  });
  if (!is_table) return false;
  try {
    const study::DecodedText decoded = study::decode_text(text, file);
    return PairReader(decoded.text, file, Ties::Refuse).columns().is_complete();
  } catch (const InputError&) {
    return false;  // reading it as answers reports the problem
  }
}

bool are_pair_tables(std::span<const std::string> paths) {
  std::string pairs, others;
  for (const std::string& path : paths) {
    (is_pair_table(read_file(path, kMaxBytes), path) ? pairs : others) = path;
  }
  if (!pairs.empty() && !others.empty()) {
    throw InputError(fmt::format(
        "{} has paired comparisons and {} has not; analyse them separately", pairs, others));
  }
  return !pairs.empty();
}

std::vector<PairedComparison> read_comparisons(std::span<const std::string> paths, Ties ties,
                                               std::vector<std::string>& notes) {
  std::vector<PairedComparison> out;
  std::map<std::string, std::string> file_with;  // by content
  for (const std::string& path : paths) {
    const std::string text = read_file(path, kMaxBytes);
    const auto [found, is_new] = file_with.emplace(text, path);
    if (!is_new) {
      throw InputError(fmt::format("{} and {} have the same content; leave one of them out",
                                   found->second, path));
    }
    const auto more = comparisons_from_csv(text, path, ties, notes);
    out.insert(out.end(), more.begin(), more.end());
  }
  return out;
}

}  // namespace prostm
