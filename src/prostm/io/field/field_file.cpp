#include "prostm/io/field/field_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <numeric>

#include "prostm/core/file/file.hpp"
#include "prostm/core/file/file_kind.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/core/text/json.hpp"
#include "prostm/core/text/lower_case.hpp"
#include "prostm/io/detail/conversion_hint.hpp"
#include "prostm/io/detail/raster_json.hpp"
#include "prostm/io/recorder.hpp"

namespace prostm {
namespace {

// enough for arrays of many frames, and for incompressible pictures
constexpr std::size_t kMaxArrayBytes = std::size_t{1} << 30;
constexpr std::size_t kMaxPngBytes = std::size_t{16} << 20;

std::string lower_ending(const std::string& path) {
  return lower_case(std::filesystem::path(path).extension().string());
}

/// Checks the options. @throws InputError for an option that does not apply to this kind of file.
void check_options(const std::string& path, FieldKind kind, const FieldFileOptions& options) {
  const bool sized = kind == FieldKind::Json || kind == FieldKind::Recording;
  const bool given = options.cell_mm || options.width_mm;
  const FieldOptionNames& names = options.names;
  if (sized && given) {
    throw InputError(fmt::format("{} contains the size of a cell; leave out {} and {}", path,
                                 names.cell_mm, names.width_mm));
  }
  if (!sized && !given) {
    throw InputError(fmt::format(
        "{} does not contain the size of a cell; give it in mm with {}, or the width of "
        "the field with {}",
        path, names.cell_mm, names.width_mm));
  }
  if (options.cell_mm && options.width_mm) {
    throw InputError(fmt::format("{}: {} and {} exclude each other; leave one of them out", path,
                                 names.cell_mm, names.width_mm));
  }
  const bool has_frames =
      kind == FieldKind::Recording || kind == FieldKind::Npy || kind == FieldKind::Npz;
  if (options.frame.value_or(0) != 0 && !has_frames) {
    throw InputError(fmt::format("{} holds one field; leave out {}", path, names.frame));
  }
  if (!options.variable.empty() && kind != FieldKind::Npz) {
    throw InputError(fmt::format("{} is not an .npz file with named arrays; leave out {}", path,
                                 names.variable));
  }
  if (options.invert && kind != FieldKind::Png) {
    throw InputError(fmt::format("{} is not a picture; leave out {}", path, names.invert));
  }
}

TargetField array_field(std::string_view bytes, const std::string& path, FieldKind kind,
                        const FieldFileOptions& options) {
  constexpr double kUntilItsColumnsAreKnown = 1.0;
  const double cell_mm = options.cell_mm.value_or(kUntilItsColumnsAreKnown);
  if (kind == FieldKind::Npz) return field_from_npz(bytes, path, cell_mm, options);
  if (kind == FieldKind::Png) return field_from_png(bytes, path, cell_mm);
  return field_from_npy(bytes, path, cell_mm, options.frame, options.names.frame);
}

/// Reads an array or a picture, with the size given by the options.
TargetField sized_field(std::string_view bytes, const std::string& path, FieldKind kind,
                        const FieldFileOptions& options) {
  TargetField field = array_field(bytes, path, kind, options);
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

/// Throws an InputError that a frame has no hand, with the first frame that has one.
[[noreturn]] void refuse_frame(const RecordingReader& recording, const std::string& path,
                               const FieldFileOptions& options) {
  int first = 0;
  while (first < recording.frames() && recording.frame(first).patches.empty()) ++first;
  if (first == recording.frames()) throw InputError(path + " holds no hand in any frame");
  throw InputError(fmt::format(
      "{}: frame {} holds no hand; the first frame with a hand is {}, choose it with {}", path,
      options.frame.value_or(0), first, options.names.frame));
}

/// Returns the patch with the larger sum of pressures: for two hands, each is planned separately.
TargetField field_from_recording(const std::string& path, const FieldFileOptions& options) {
  const RecordingReader recording(path);
  TargetFrame frame = recording.frame(options.frame.value_or(0));
  if (frame.patches.empty()) refuse_frame(recording, path, options);
  const auto load = [](const TargetField& f) {
    return std::accumulate(f.pressure.begin(), f.pressure.end(), 0.0);
  };
  auto heaviest = std::max_element(
      frame.patches.begin(), frame.patches.end(),
      [&](const TargetField& a, const TargetField& b) { return load(a) < load(b); });
  return std::move(*heaviest);
}

/// The kind of the data on standard input. @throws InputError for an unsupported kind.
FieldKind kind_of_input(std::string_view bytes, const std::string& name) {
  const std::string_view kind = kind_by_content(bytes);
  if (kind == "JSON") return FieldKind::Json;
  if (kind == "an NPY file") return FieldKind::Npy;
  if (kind == "a zip archive") return FieldKind::Npz;
  if (kind == "a PNG picture") return FieldKind::Png;
  throw InputError(fmt::format("{} contains {}; a field there must be JSON, NPY, NPZ or PNG", name,
                               kind.empty() ? "no field" : kind));
}

}  // namespace

FieldKind field_kind(const std::string& path) {
  const std::string ending = lower_ending(path);
  if (ending == ".json") return FieldKind::Json;
  if (ending == ".npy") return FieldKind::Npy;
  if (ending == ".npz") return FieldKind::Npz;
  if (ending == ".png") return FieldKind::Png;
  if (ending == ".h5") return FieldKind::Recording;
  if (ending == ".jsonl") {
    throw InputError(fmt::format(
        "{0} is a recording of hands, not a field; make fields from it with "
        "prostm capture --hand {0} --out FILE.h5, or play it with prostm run --hand {0}",
        path));
  }
  const std::string hint = conversion_hint(ending);
  throw InputError(fmt::format(
      "{} is of an unknown kind; a field must be a .json, .npy, .npz, .png or .h5 file{}", path,
      hint.empty() ? "" : ": " + hint));
}

TargetField read_field(const std::string& path, const FieldFileOptions& options, FieldKind* kind) {
  const bool is_input = path == "-";
  const std::string name = is_input ? "standard input" : path;
  std::string bytes;
  if (is_input) bytes = read_file(path, kMaxArrayBytes);
  const FieldKind known = is_input ? kind_of_input(bytes, name) : field_kind(path);
  if (kind != nullptr) *kind = known;
  check_options(name, known, options);
  if (known == FieldKind::Recording) return field_from_recording(path, options);
  const std::size_t limit = known == FieldKind::Json  ? kMaxJsonBytes
                            : known == FieldKind::Png ? kMaxPngBytes
                                                      : kMaxArrayBytes;
  if (!is_input) bytes = read_file(path, limit);
  return known == FieldKind::Json ? field_from_json(bytes, name)
                                  : sized_field(bytes, name, known, options);
}

}  // namespace prostm
