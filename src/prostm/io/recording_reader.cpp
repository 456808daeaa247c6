/// The layout is described in docs/recordings.md.
#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "prostm/core/file.hpp"
#include "prostm/core/file_kind.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/io/detail/hdf5.hpp"
#include "prostm/io/recorder.hpp"

namespace prostm {

struct RecordingReader::Impl {
  std::string path;
  h5::Id file;
  std::vector<double> time, cell, origin, pose;
  std::vector<std::int64_t> first_patch, offset;
  std::vector<std::int32_t> patches, rows, cols;

  [[noreturn]] void broken() const {
    throw InputError(path + " is broken or cut off; it must be a recording of prostm");
  }
  template <class T>
  void read(const char* name, hid_t type, const std::vector<hsize_t>& shape, std::size_t row_values,
            std::size_t count, std::vector<T>& out) const {
    out.resize(count * row_values);
    if (!h5::read_rows(file.get(), name, type, shape, 0, count, out.data())) broken();
  }
  void read_index();
  TargetField read_patch(std::size_t i) const;
  void read_weights(hsize_t first, TargetField& field) const;
  bool has_weights = false;  // any patch
};

void RecordingReader::Impl::read_index() {
  constexpr long long kMaxFrames = 10'000'000;  // more than two days
  const auto rows_of = [&](const char* name) {
    const long long n = h5::row_count(file.get(), name);
    if (n < 0 || n > kMaxFrames) broken();
    return static_cast<std::size_t>(n);
  };
  const std::size_t frames = rows_of("/frame/time"), all = rows_of("/target/frame");
  read("/frame/time", H5T_NATIVE_DOUBLE, {}, 1, frames, time);
  read("/frame/first_patch", H5T_NATIVE_INT64, {}, 1, frames, first_patch);
  read("/frame/patches", H5T_NATIVE_INT32, {}, 1, frames, patches);
  read("/target/rows", H5T_NATIVE_INT32, {}, 1, all, rows);
  read("/target/cols", H5T_NATIVE_INT32, {}, 1, all, cols);
  read("/target/offset", H5T_NATIVE_INT64, {}, 1, all, offset);
  read("/target/cell", H5T_NATIVE_DOUBLE, {}, 1, all, cell);
  read("/target/origin", H5T_NATIVE_DOUBLE, {2}, 2, all, origin);
  read("/target/pose", H5T_NATIVE_DOUBLE, {4, 4}, 16, all, pose);
  has_weights = H5Lexists(file.get(), "/target/weight", H5P_DEFAULT) > 0;

  // frames refer to patches that are there
  for (std::size_t i = 0; i < frames; ++i) {
    if (patches[i] < 0 || patches[i] > kMaxPatches || first_patch[i] < 0 ||
        first_patch[i] > static_cast<std::int64_t>(all) - patches[i]) {
      broken();
    }
  }
}

TargetField RecordingReader::Impl::read_patch(std::size_t i) const {
  const std::int64_t cells = std::int64_t{rows[i]} * cols[i];
  if (rows[i] < 1 || cols[i] < 1 || cells > static_cast<std::int64_t>(kMaxFieldCells) ||
      offset[i] < 0) {
    broken();
  }
  TargetField field;
  field.resize(rows[i], cols[i]);
  field.cell = cell[i];
  field.origin = Vec2(origin[2 * i], origin[2 * i + 1]);
  for (int row = 0; row < 4; ++row) {
    for (int col = 0; col < 4; ++col) {
      field.X_DP(row, col) = pose[16 * i + static_cast<std::size_t>(4 * row + col)];
    }
  }

  // rasters stand one after another
  const auto first = static_cast<hsize_t>(offset[i]), count = static_cast<hsize_t>(cells);
  if (!h5::read_rows(file.get(), "/target/pressure", H5T_NATIVE_DOUBLE, {}, first, count,
                     field.pressure.data()) ||
      !h5::read_rows(file.get(), "/target/height", H5T_NATIVE_DOUBLE, {}, first, count,
                     field.height.data())) {
    broken();
  }
  for (std::size_t k = 0; k < field.size(); ++k) {
    field.skin[k] = std::isnan(field.pressure[k]) ? 0 : 1;
    if (field.skin[k] == 0) field.pressure[k] = 0.0;
  }
  if (has_weights) read_weights(first, field);
  return field;
}

/// A patch whose skin has NaN throughout has no weights. @param first cell of the patch.
void RecordingReader::Impl::read_weights(hsize_t first, TargetField& field) const {
  field.weight.resize(field.size());
  if (!h5::read_rows(file.get(), "/target/weight", H5T_NATIVE_DOUBLE, {}, first, field.size(),
                     field.weight.data())) {
    broken();
  }
  bool any = false;
  for (std::size_t k = 0; k < field.size(); ++k) {
    if (field.skin[k] == 0) field.weight[k] = 0.0;
    any = any || (field.skin[k] != 0 && !std::isnan(field.weight[k]));
  }
  if (!any) field.weight.clear();
}

RecordingReader::RecordingReader(const std::string& path) : impl_(std::make_unique<Impl>()) {
  check_readable(path);
  const h5::Quiet quiet;
  impl_->path = path;
  const h5::Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fclose_degree(access.get(), H5F_CLOSE_STRONG);
  impl_->file = h5::Id(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.get()), H5Fclose);
  if (!impl_->file.valid()) {
    throw InputError(path + " " + is_not(read_head(path), "an HDF5 file") +
                     ", or is cut off; it must be a recording of prostm (.h5)");
  }
  const std::string format = h5::read_text(impl_->file.get(), "format");
  if (format != "prostm-recording/1") {
    throw InputError(
        fmt::format("{}: its attribute \"format\" is \"{:.40}\"; it must be \"prostm-recording/1\"",
                    path, format));
  }
  impl_->read_index();
}

RecordingReader::~RecordingReader() = default;

int RecordingReader::frames() const {
  return static_cast<int>(impl_->time.size());
}

std::string RecordingReader::scene() const {
  const h5::Quiet quiet;
  return h5::read_text(impl_->file.get(), "scene");
}

TargetFrame RecordingReader::frame(int i) const {
  if (i < 0 || i >= frames()) {
    throw InputError(fmt::format("{} has no frame {}; it has {} frames, counted from 0",
                                 impl_->path, i, frames()));
  }
  const h5::Quiet quiet;
  const auto at = static_cast<std::size_t>(i);
  TargetFrame frame;
  frame.time = impl_->time[at];
  for (std::int32_t k = 0; k < impl_->patches[at]; ++k) {
    frame.patches.push_back(
        impl_->read_patch(static_cast<std::size_t>(impl_->first_patch[at] + k)));
    try {
      validate(frame.patches.back());
    } catch (const std::invalid_argument& e) {
      throw InputError(fmt::format("{}, frame {}: {}", impl_->path, i, e.what()));
    }
  }
  return frame;
}

}  // namespace prostm
