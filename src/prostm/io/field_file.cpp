#include "prostm/io/field_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <numeric>

#include "prostm/core/file.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/core/json.hpp"
#include "prostm/io/recorder.hpp"

namespace prostm {
namespace {

// a raster of numpy's largest numbers, and a picture that cannot be compressed, with room to spare
constexpr std::size_t kMaxNpyBytes = 8 * kMaxFieldCells + (std::size_t{1} << 20);
constexpr std::size_t kMaxPngBytes = std::size_t{16} << 20;

std::string lower_ending(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

double needed_cell(const std::string& path, const FieldFileOptions& options) {
  if (!options.cell_mm) {
    throw InputError(path + " does not say how large a cell is; give it in mm with --cell-mm");
  }
  return *options.cell_mm;
}

/// The patch with the larger sum of pressures: a frame of two hands is planned hand by hand.
TargetField field_from_recording(const std::string& path, int frame_index) {
  TargetFrame frame = RecordingReader(path).frame(frame_index);
  if (frame.patches.empty()) {
    throw InputError(
        fmt::format("{}: frame {} holds no hand; choose another with --frame", path, frame_index));
  }
  const auto load = [](const TargetField& f) {
    return std::accumulate(f.pressure.begin(), f.pressure.end(), 0.0);
  };
  auto heaviest = std::max_element(
      frame.patches.begin(), frame.patches.end(),
      [&](const TargetField& a, const TargetField& b) { return load(a) < load(b); });
  return std::move(*heaviest);
}

}  // namespace

TargetField read_field(const std::string& path, const FieldFileOptions& options) {
  const std::string ending = lower_ending(path);
  if (options.cell_mm && (ending == ".json" || ending == ".h5")) {
    throw InputError(path + " says itself how large a cell is; leave out --cell-mm");
  }
  if (options.frame != 0 && ending != ".h5") {
    throw InputError(path + " holds one field; leave out --frame");
  }
  if (ending == ".json") return field_from_json(read_file(path, kMaxJsonBytes), path);
  if (ending == ".npy") {
    return field_from_npy(read_file(path, kMaxNpyBytes), path, needed_cell(path, options));
  }
  if (ending == ".png") {
    return field_from_png(read_file(path, kMaxPngBytes), path, needed_cell(path, options));
  }
  if (ending == ".h5") return field_from_recording(path, options.frame);
  throw InputError(path + " is of no known kind; a field must be a .json, .npy, .png or .h5 file");
}

}  // namespace prostm
