/// NumPy's .npy, versions 1 to 3: a magic string, a header with a Python dictionary, and the
/// array's bytes (described in numpy/lib/format.py).
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <vector>

#include "prostm/core/file/file_kind.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/io/detail/raster_json.hpp"
#include "prostm/io/field/field_file.hpp"

namespace prostm {
namespace {

struct NpyHeader {
  std::string descr;
  bool fortran_order = false;
  std::vector<double> shape;  // as doubles, so that no product overflows
  std::size_t data_start = 0;
};

/// A number's type: kind 'f', 'i', 'u' or 'b', its bytes, and whether the high byte comes first.
struct NpyType {
  char kind = 0;
  std::size_t size = 0;
  bool big_endian = false;
};

[[noreturn]] void fail(const std::string& name, const std::string& problem) {
  throw InputError(name + ": " + problem);
}

/// Parses the header's dictionary, which contains only texts, booleans, integers and tuples of
/// them.
class HeaderParser {
 public:
  HeaderParser(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  void parse(NpyHeader& header) {
    bool descr = false, order = false, shape = false;
    expect('{');
    while (!accept('}')) {
      const std::string key = quoted();
      expect(':');
      if (key == "descr") {
        header.descr = quoted();
        descr = true;
      } else if (key == "fortran_order") {
        header.fortran_order = truth();
        order = true;
      } else if (key == "shape") {
        header.shape = tuple();
        shape = true;
      } else {
        broken();
      }
      if (!accept(',')) {
        expect('}');
        break;
      }
    }
    if (!descr || !order || !shape) broken();
  }

 private:
  [[noreturn]] void broken() const {
    fail(name_, "the NPY header is broken; save a 2-D array of numbers with numpy.save");
  }
  void skip_space() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\n')) ++at_;
  }
  bool accept(char c) {
    skip_space();
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  void expect(char c) {
    if (!accept(c)) broken();
  }
  std::string quoted() {
    skip_space();
    const char quote = at_ < text_.size() ? text_[at_] : '\0';
    if (quote != '\'' && quote != '"') {
      fail(name_, "holds a structured array; it must be a 2-D array of plain numbers");
    }
    const std::size_t end = text_.find(quote, at_ + 1);
    if (end == text_.npos) broken();
    const std::string result(text_.substr(at_ + 1, end - at_ - 1));
    at_ = end + 1;
    return result;
  }
  bool truth() {
    skip_space();
    for (const bool value : {true, false}) {
      const std::string_view word = value ? "True" : "False";
      if (text_.substr(at_, word.size()) == word) {
        at_ += word.size();
        return value;
      }
    }
    broken();
  }
  std::vector<double> tuple() {
    std::vector<double> values;
    expect('(');
    while (!accept(')')) {
      skip_space();
      const std::size_t start = at_;
      double value = 0.0;
      for (; at_ < text_.size() && text_[at_] >= '0' && text_[at_] <= '9'; ++at_) {
        value = 10.0 * value + (text_[at_] - '0');
      }
      if (at_ == start || at_ > start + 15) broken();
      accept('L');  // suffix of long integers in Python 2
      values.push_back(value);
      if (!accept(',')) {
        expect(')');
        break;
      }
    }
    return values;
  }

  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0;
};

NpyHeader read_header(std::string_view bytes, const std::string& name) {
  constexpr std::string_view kMagic("\x93NUMPY", 6);
  if (bytes.substr(0, kMagic.size()) != kMagic || bytes.size() < 12) {
    fail(name, is_not(bytes, "an NPY file") + "; save a 2-D array of numbers with numpy.save");
  }
  const auto byte = [&](std::size_t i) {
    return static_cast<std::size_t>(static_cast<unsigned char>(bytes[i]));
  };
  if (byte(6) < 1 || byte(6) > 3) {
    fail(name, fmt::format("is NPY version {}; it must be 1, 2 or 3", byte(6)));
  }
  const bool is_long = byte(6) >= 2;
  const std::size_t start = is_long ? 12 : 10;
  const std::size_t length =
      byte(8) | byte(9) << 8 | (is_long ? byte(10) << 16 | byte(11) << 24 : 0);
  if (bytes.size() - start < length) {
    fail(name, "the NPY header is cut off; the file is incomplete");
  }
  NpyHeader header;
  HeaderParser(bytes.substr(start, length), name).parse(header);
  header.data_start = start + length;
  return header;
}

NpyType read_type(const std::string& descr, const std::string& name) {
  constexpr std::string_view kTypes[] = {"f2", "f4", "f8", "i1", "i2", "i4",
                                         "i8", "u1", "u2", "u4", "u8", "b1"};
  const std::string_view order_codes = "<>|=";
  if (descr.size() == 3 && order_codes.find(descr[0]) != order_codes.npos) {
    for (const std::string_view type : kTypes) {
      if (descr.substr(1) == type) {
        const bool native_is_big = std::endian::native == std::endian::big;
        return {type[0], static_cast<std::size_t>(type[1] - '0'),
                descr[0] == '>' || (descr[0] == '=' && native_is_big)};
      }
    }
  }
  fail(name, fmt::format("holds numbers of type '{:.20}'; they must be float16, float32, float64, "
                         "integers or booleans: convert them with numpy's astype",
                         descr));
}

/// A float16: 1 bit for the sign, 5 for the exponent, 10 for the fraction.
double half_value(std::uint64_t bits) {
  const int exponent = static_cast<int>(bits >> 10 & 31U);
  const auto fraction = static_cast<double>(bits & 1023U);
  const double size = exponent == 31  ? std::numeric_limits<double>::infinity()
                      : exponent == 0 ? std::ldexp(fraction, -24)
                                      : std::ldexp(1024.0 + fraction, exponent - 25);
  return (bits & 0x8000U) != 0 ? -size : size;
}

/// One number; nothing for NaN, which is detected by its bits, since converting a signalling NaN
/// traps.
std::optional<double> decode(const char* bytes, const NpyType& type) {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < type.size; ++i) {
    const auto byte = static_cast<unsigned char>(bytes[type.big_endian ? i : type.size - 1 - i]);
    bits = bits << 8 | byte;
  }
  if (type.kind == 'f' && type.size == 2) {
    if ((bits & 0x7fffU) > 0x7c00U) return std::nullopt;
    return half_value(bits);
  }
  if (type.kind == 'f' && type.size == 4) {
    if ((bits & 0x7fffffffU) > 0x7f800000U) return std::nullopt;
    return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
  }
  if (type.kind == 'f') {
    if ((bits & 0x7fffffffffffffffU) > 0x7ff0000000000000U) return std::nullopt;
    return std::bit_cast<double>(bits);
  }
  if (type.kind == 'b') return bits != 0 ? 1.0 : 0.0;
  if (type.kind == 'u') return static_cast<double>(bits);
  const std::size_t unused = 64 - 8 * type.size;  // shifted out and back to extend the sign
  return static_cast<double>(static_cast<std::int64_t>(bits << unused) >> unused);
}

/// The frame of an array that is read as a field: its size, and the positions of its numbers.
struct Frame {
  double rows = 0, cols = 0;
  std::size_t first = 0, row_step = 0, col_step = 0;  // in numbers
};

/// Finds a frame. @throws InputError for an array without rows and columns, or a frame that does
/// not exist.
Frame frame_of(const NpyHeader& header, const std::string& name, std::optional<int> frame,
               const char* frame_option) {
  std::vector<double> shape = header.shape;
  while (shape.size() > 2 && shape.front() == 1) shape.erase(shape.begin());
  while (shape.size() > 2 && shape.back() == 1) shape.pop_back();
  if (shape.size() != 2 && shape.size() != 3) {
    fail(name, fmt::format("holds an array of {} dimensions; it must have 2, rows and columns, or "
                           "3, frames, rows and columns",
                           header.shape.size()));
  }
  const double frames = shape.size() == 3 ? shape[0] : 1;
  const double rows = shape[shape.size() - 2], cols = shape.back();
  // check the size before allocating
  check_raster_size(rows, cols, name);
  const int chosen = frame.value_or(0);
  if (frames == 1 && chosen != 0)
    fail(name, fmt::format("holds one field; leave out {}", frame_option));
  if (frames > 1 && !frame) {
    fail(name, fmt::format("holds {:.0f} frames of {} x {} cells; choose one with {}, 0 to {:.0f}",
                           frames, rows, cols, frame_option, frames - 1));
  }
  if (chosen < 0 || chosen >= frames) {
    fail(name,
         fmt::format("has no frame {}; it has {:.0f} frames, counted from 0", chosen, frames));
  }
  const auto f = static_cast<std::size_t>(frames), r = static_cast<std::size_t>(rows),
             c = static_cast<std::size_t>(cols), at = static_cast<std::size_t>(chosen);
  return header.fortran_order ? Frame{rows, cols, at, f, f * r}
                              : Frame{rows, cols, at * r * c, c, 1};
}

}  // namespace

TargetField field_from_npy(std::string_view bytes, const std::string& name, double cell_mm,
                           std::optional<int> frame, const char* frame_option) {
  TargetField field;
  field.cell = checked_cell(cell_mm, name, "the cell size");
  const NpyHeader header = read_header(bytes, name);
  const NpyType type = read_type(header.descr, name);
  const Frame at = frame_of(header, name, frame, frame_option);
  const std::string_view data = bytes.substr(header.data_start);
  double wanted = static_cast<double>(type.size);
  for (const double length : header.shape) wanted *= length;
  if (static_cast<double>(data.size()) != wanted) {
    fail(name, fmt::format("holds {} bytes of numbers; {} numbers of {} bytes must be {:.0f}",
                           data.size(), fmt::join(header.shape, " x "), type.size, wanted));
  }

  field.resize(static_cast<int>(at.rows), static_cast<int>(at.cols));
  for (int row = 0; row < field.rows; ++row) {
    for (int col = 0; col < field.cols; ++col) {
      const std::size_t stored = at.first + static_cast<std::size_t>(row) * at.row_step +
                                 static_cast<std::size_t>(col) * at.col_step;
      const std::optional<double> p = decode(data.data() + stored * type.size, type);
      if (!p) continue;
      field.skin[field.index(row, col)] = 1;
      field.pressure[field.index(row, col)] = *p;
    }
  }
  settle_pressures(field, name);
  return field;
}

}  // namespace prostm
