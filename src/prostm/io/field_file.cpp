#include "prostm/io/field_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <numeric>

#include "prostm/core/file.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/core/json.hpp"
#include "prostm/core/lower_case.hpp"
#include "prostm/io/detail/raster_json.hpp"
#include "prostm/io/recorder.hpp"

namespace prostm {
namespace {

// a raster of numpy's largest numbers, and a picture that cannot be compressed, with room to spare
constexpr std::size_t kMaxNpyBytes = 8 * kMaxFieldCells + (std::size_t{1} << 20);
constexpr std::size_t kMaxPngBytes = std::size_t{16} << 20;

std::string lower_ending(const std::string& path) {
  return lower_case(std::filesystem::path(path).extension().string());
}

/// @throws InputError for an option that does not belong to this kind of file.
void check_options(const std::string& path, FieldKind kind, const FieldFileOptions& options) {
  const bool sized = kind == FieldKind::Json || kind == FieldKind::Recording;
  const bool given = options.cell_mm || options.width_mm;
  const FieldOptionNames& names = options.names;
  if (sized && given) {
    throw InputError(fmt::format("{} says itself how large a cell is; leave out {} and {}", path,
                                 names.cell_mm, names.width_mm));
  }
  if (!sized && !given) {
    throw InputError(
        fmt::format("{} does not say how large a cell is; give it in mm with {}, or the width of "
                    "the field with {}",
                    path, names.cell_mm, names.width_mm));
  }
  if (options.cell_mm && options.width_mm) {
    throw InputError(fmt::format("{}: {} and {} exclude each other; leave one of them out", path,
                                 names.cell_mm, names.width_mm));
  }
  if (options.frame != 0 && kind != FieldKind::Recording) {
    throw InputError(fmt::format("{} holds one field; leave out {}", path, names.frame));
  }
  if (options.invert && kind != FieldKind::Png) {
    throw InputError(fmt::format("{} is no picture; leave out {}", path, names.invert));
  }
}

/// An array or a picture with the size that the options give it.
TargetField sized_field(const std::string& path, FieldKind kind, const FieldFileOptions& options) {
  constexpr double kUntilItsColumnsAreKnown = 1.0;
  const double cell_mm = options.cell_mm.value_or(kUntilItsColumnsAreKnown);
  TargetField field = kind == FieldKind::Npy
                          ? field_from_npy(read_file(path, kMaxNpyBytes), path, cell_mm)
                          : field_from_png(read_file(path, kMaxPngBytes), path, cell_mm);
  if (options.width_mm) {
    field.cell = checked_cell(*options.width_mm / field.cols, path,
                              fmt::format("{} {} over {} columns", options.names.width_mm,
                                          *options.width_mm, field.cols));
  }
  for (std::size_t i = 0; options.invert && i < field.size(); ++i) {
    if (field.skin[i] != 0) field.pressure[i] = 1.0 - field.pressure[i];
  }
  return field;
}

/// @throws InputError that a frame holds no hand, with the first that does.
[[noreturn]] void refuse_frame(const RecordingReader& recording, const std::string& path,
                               const FieldFileOptions& options) {
  int first = 0;
  while (first < recording.frames() && recording.frame(first).patches.empty()) ++first;
  if (first == recording.frames()) throw InputError(path + " holds no hand in any frame");
  throw InputError(fmt::format(
      "{}: frame {} holds no hand; the first frame with a hand is {}, choose it with {}", path,
      options.frame, first, options.names.frame));
}

/// The patch with the larger sum of pressures: a frame of two hands is planned hand by hand.
TargetField field_from_recording(const std::string& path, const FieldFileOptions& options) {
  const RecordingReader recording(path);
  TargetFrame frame = recording.frame(options.frame);
  if (frame.patches.empty()) refuse_frame(recording, path, options);
  const auto load = [](const TargetField& f) {
    return std::accumulate(f.pressure.begin(), f.pressure.end(), 0.0);
  };
  auto heaviest = std::max_element(
      frame.patches.begin(), frame.patches.end(),
      [&](const TargetField& a, const TargetField& b) { return load(a) < load(b); });
  return std::move(*heaviest);
}

}  // namespace

FieldKind field_kind(const std::string& path) {
  const std::string ending = lower_ending(path);
  if (ending == ".json") return FieldKind::Json;
  if (ending == ".npy") return FieldKind::Npy;
  if (ending == ".png") return FieldKind::Png;
  if (ending == ".h5") return FieldKind::Recording;
  if (ending == ".jsonl") {
    throw InputError(fmt::format(
        "{0} is a recording of hands, not a field; make fields of it with "
        "prostm capture --hand {0} --out FILE.h5, or play it with prostm run --hand {0}",
        path));
  }
  throw InputError(path + " is of no known kind; a field must be a .json, .npy, .png or .h5 file");
}

TargetField read_field(const std::string& path, const FieldFileOptions& options) {
  const FieldKind kind = field_kind(path);
  check_options(path, kind, options);
  if (kind == FieldKind::Json) return field_from_json(read_file(path, kMaxJsonBytes), path);
  if (kind == FieldKind::Recording) return field_from_recording(path, options);
  return sized_field(path, kind, options);
}

}  // namespace prostm
