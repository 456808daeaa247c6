/// The layout is described in docs/guides/recordings.md.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <numeric>
#include <stdexcept>
#include <string_view>
#include <variant>
#include <vector>

#include "prostm/core/file/file.hpp"
#include "prostm/core/file/file_kind.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/io/detail/hdf5.hpp"
#include "prostm/io/detail/hdf5_filters.hpp"
#include "prostm/io/detail/recording_layout.hpp"
#include "prostm/io/recorder.hpp"
#include "prostm/target/rounding.hpp"

namespace prostm {
namespace {

bool is_number(double x) {
  return std::isfinite(x) && x >= 0.0;
}

/// Whether a path is valid on one of `patches` patches.
bool is_path(const FocalPath& path, int patches) {
  return !path.points.empty() && path.patch >= 0 && path.patch < patches && path.speed > 0.0 &&
         is_number(path.speed) && is_number(path.length) && is_number(path.period) &&
         std::all_of(path.points.begin(), path.points.end(),
                     [](const Vec2& x) { return x.allFinite(); }) &&
         std::all_of(path.pressure.begin(), path.pressure.end(), is_number);
}

bool asks_for_locks() {
  const char* value = std::getenv("HDF5_USE_FILE_LOCKING");
  return value != nullptr && std::string_view(value) != "FALSE" && std::string_view(value) != "0";
}

bool is_focus(const FocalPoint& focus, int patches) {
  return focus.patch >= 0 && focus.patch < patches && focus.position.allFinite() &&
         is_number(focus.pressure) && is_phase(focus.phase);
}

}  // namespace

struct RecordingReader::Impl {
  std::string path;
  h5::Id file;
  std::vector<double> time, cell, origin, pose;
  std::vector<std::int64_t> first_patch, frame_of_patch, offset;
  std::vector<std::int32_t> patches, rows, cols;

  [[noreturn]] void broken() const {
    if (const std::string filter = h5::missing_filter(file.get()); !filter.empty()) {
      throw InputError(fmt::format(
          "{}: {}, which libhdf5 cannot read here; write the dataset again without it or with "
          "gzip, in Python: group.create_dataset(name, data=old[()], compression=\"gzip\")",
          path, filter));
    }
    throw InputError(path + " is damaged or truncated; it must be a recording of prostm");
  }
  template <class T>
  void read(const char* name, hid_t type, const std::vector<hsize_t>& shape, std::size_t row_values,
            std::size_t count, std::vector<T>& out) const {
    out.resize(count * row_values);
    if (!h5::read_rows(file.get(), name, type, shape, 0, count, out.data())) broken();
  }
  /// Returns one row of a dataset of a group, with the shape listed in the layout's columns.
  /// @param what the data that cannot be read without it.
  template <class T>
  std::vector<T> row(const char* group, const char* what, const std::vector<h5::Column>& columns,
                     const std::string& name, std::size_t i) const;
  template <class T>
  std::vector<T> plan_row(const std::string& name, std::size_t i) const {
    return row<T>("/plan/", "its plans", recording::plan_columns(), name, i);
  }
  template <class T>
  std::vector<T> gate_row(const std::string& name, std::size_t i) const {
    return row<T>("/gate/", "the verdicts of its gate", recording::gate_columns(), name, i);
  }
  /// Whether the plans have a table that is missing in recordings of earlier versions.
  bool has_plan_table(const char* name) const {
    return H5Lexists(file.get(), ("/plan/" + std::string(name)).c_str(), H5P_DEFAULT) > 0;
  }
  std::size_t checked(int i) const;
  void read_index();
  bool is_mutual() const;
  bool has_all_patches() const;
  void check_references() const;
  TargetField read_patch(std::size_t i) const;
  std::vector<double> read_optional(const char* name, hsize_t first,
                                    const TargetField& field) const;
  void read_paths(std::size_t i, std::size_t count, Plan& plan) const;
  void read_foci(std::size_t i, std::size_t count, Plan& plan) const;
  PlanStats read_stats(std::size_t i) const;
  FieldShape read_shape(std::size_t i) const;
};

template <class T>
std::vector<T> RecordingReader::Impl::row(const char* group, const char* what,
                                          const std::vector<h5::Column>& columns,
                                          const std::string& name, std::size_t i) const {
  const auto column = std::find_if(columns.begin(), columns.end(),
                                   [&](const h5::Column& c) { return name == c.name; });
  std::vector<T> values(std::accumulate(column->shape.begin(), column->shape.end(), std::size_t{1},
                                        std::multiplies<>()));
  const std::string dataset = group + name;
  if (H5Lexists(file.get(), dataset.c_str(), H5P_DEFAULT) == 0) {
    throw InputError(fmt::format(
        "{} has no dataset {}, so {} cannot be read: an earlier version recorded it, or another "
        "program changed it",
        path, dataset, what));
  }
  if (!h5::read_rows(file.get(), dataset.c_str(), column->type, column->shape, i, 1, values.data()))
    broken();
  return values;
}

/// Returns the index of a frame. @throws InputError if it does not exist.
std::size_t RecordingReader::Impl::checked(int i) const {
  if (i >= 0 && static_cast<std::size_t>(i) < time.size()) return static_cast<std::size_t>(i);
  throw InputError(
      fmt::format("{} has no frame {}; it has {} frames, counted from 0", path, i, time.size()));
}

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
  read("/target/frame", H5T_NATIVE_INT64, {}, 1, all, frame_of_patch);
  read("/target/rows", H5T_NATIVE_INT32, {}, 1, all, rows);
  read("/target/cols", H5T_NATIVE_INT32, {}, 1, all, cols);
  read("/target/offset", H5T_NATIVE_INT64, {}, 1, all, offset);
  read("/target/cell", H5T_NATIVE_DOUBLE, {}, 1, all, cell);
  read("/target/origin", H5T_NATIVE_DOUBLE, {2}, 2, all, origin);
  read("/target/pose", H5T_NATIVE_DOUBLE, {4, 4}, 16, all, pose);

  check_references();
}

/// Whether each frame's patches are in the tables and refer back to that frame.
bool RecordingReader::Impl::is_mutual() const {
  for (std::size_t i = 0; i < time.size(); ++i) {
    for (std::int32_t k = 0; k < patches[i]; ++k) {
      const auto at = static_cast<std::size_t>(first_patch[i] + k);
      if (frame_of_patch[at] != static_cast<std::int64_t>(i)) return false;
    }
  }
  return true;
}

/// Whether the patches include those of the recording from the first on, so that indices into the
/// tables are unchanged.
bool RecordingReader::Impl::has_all_patches() const {
  std::int64_t end = 0;
  for (std::size_t k = 0; k < offset.size(); ++k) {
    if (offset[k] != end) return false;
    end += std::int64_t{rows[k]} * cols[k];
  }
  return true;
}

/// Checks the references between frames and patches. Programs that cut frames out of a recording
/// leave the references unchanged: these stay valid if all patches are kept.
void RecordingReader::Impl::check_references() const {
  const auto all = static_cast<std::int64_t>(offset.size());
  const long long cells = h5::row_count(file.get(), "/target/pressure");
  bool inside = true;
  for (std::size_t i = 0; i < time.size(); ++i) {
    if (patches[i] < 0 || patches[i] > kMaxPatches || first_patch[i] < 0) broken();
    inside = inside && first_patch[i] <= all - patches[i];
  }
  for (std::size_t k = 0; k < offset.size(); ++k) {
    inside = inside && offset[k] <= cells - std::int64_t{rows[k]} * cols[k];
  }
  for (const char* table : {"/hand/id", "/plan/paths", "/gate/passed"}) {
    const long long count = h5::row_count(file.get(), table);
    inside = inside && (count < 0 || count == static_cast<long long>(time.size()));
  }
  if (inside && (is_mutual() || has_all_patches())) return;
  throw InputError(
      path +
      ": its tables are inconsistent, probably because another program cut frames out; "
      "cut /frame, /hand, /plan and /gate alike and keep /target whole "
      "(docs/guides/recordings.md)");
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

  // rasters are stored one after another
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
  field.weight = read_optional("/target/weight", first, field);
  field.smoke = read_optional("/target/smoke", first, field);
  field.movement = read_optional("/target/movement", first, field);
  return field;
}

/// Reads optional values, one per cell; empty if the recording has none, or the patch is NaN on all
/// its skin. @param first the first cell of the patch.
std::vector<double> RecordingReader::Impl::read_optional(const char* name, hsize_t first,
                                                         const TargetField& field) const {
  if (H5Lexists(file.get(), name, H5P_DEFAULT) <= 0) return {};
  std::vector<double> values(field.size());
  if (!h5::read_rows(file.get(), name, H5T_NATIVE_DOUBLE, {}, first, field.size(), values.data())) {
    broken();
  }
  bool any = false;
  for (std::size_t k = 0; k < field.size(); ++k) {
    if (field.skin[k] == 0) values[k] = 0.0;
    any = any || (field.skin[k] != 0 && !std::isnan(values[k]));
  }
  return any ? values : std::vector<double>();
}

void RecordingReader::Impl::read_paths(std::size_t i, std::size_t count, Plan& plan) const {
  const auto samples = plan_row<std::int32_t>("samples", i);
  const auto patch = plan_row<std::int32_t>("patch", i);
  const auto points = plan_row<double>("points", i), pressure = plan_row<double>("pressure", i);
  const auto length = plan_row<double>("length", i), speed = plan_row<double>("speed", i);
  const auto period = plan_row<double>("period", i);
  for (std::size_t k = 0; k < count; ++k) {
    FocalPath path_now;
    path_now.patch = patch[k];
    for (int j = 0; j < std::clamp(samples[k], 0, kMaxPathPoints); ++j) {
      const std::size_t at = k * kMaxPathPoints + static_cast<std::size_t>(j);
      path_now.points.push_back(Vec2(points[2 * at], points[2 * at + 1]));
      path_now.pressure.push_back(pressure[at]);
    }
    path_now.length = length[k];
    path_now.speed = speed[k];
    path_now.period = period[k];
    if (samples[k] > kMaxPathPoints || !is_path(path_now, patches[i])) broken();
    plan.paths.push_back(path_now);
  }
}

void RecordingReader::Impl::read_foci(std::size_t i, std::size_t count, Plan& plan) const {
  const auto patch = plan_row<std::int32_t>("focus_patch", i);
  const auto position = plan_row<double>("focus_position", i);
  const auto pressure = plan_row<double>("focus_pressure", i);
  const bool phased = has_plan_table(recording::kFocusPhase);
  std::vector<double> phase;
  if (phased) phase = plan_row<double>(recording::kFocusPhase, i);
  for (std::size_t k = 0; k < count; ++k) {
    const FocalPoint focus{patch[k], Vec2(position[2 * k], position[2 * k + 1]), pressure[k],
                           phased ? phase[k] : 0.0};
    if (!is_focus(focus, patches[i])) broken();
    plan.foci.push_back(focus);
  }
}

PlanStats RecordingReader::Impl::read_stats(std::size_t i) const {
  PlanStats stats;
  const auto times = plan_row<double>("stage_time", i);
  const auto counts = plan_row<std::int32_t>("counts", i);
  std::size_t k = 0;
  for (const Quantity<PlanStats>& stage : plan_stages())
    stats.*std::get<double PlanStats::*>(stage.value) = times[k++];
  k = 0;
  for (const Quantity<PlanStats>& count : recording::plan_counts())
    stats.*std::get<int PlanStats::*>(count.value) = counts[k++];
  stats.cost = plan_row<double>("cost", i)[0];
  return stats;
}

FieldShape RecordingReader::Impl::read_shape(std::size_t i) const {
  FieldShape shape;
  const std::int32_t maxima = gate_row<std::int32_t>("maxima", i)[0];
  if (maxima < 0 || maxima > FieldShape::kMaxMaxima) broken();
  const auto position = gate_row<double>("position", i), pressure = gate_row<double>("pressure", i);
  for (std::size_t k = 0; k < static_cast<std::size_t>(maxima); ++k) {
    shape.maxima.push_back({Vec2(position[2 * k], position[2 * k + 1]), pressure[k]});
    if (!shape.maxima[k].position.allFinite() || !is_number(pressure[k])) broken();
  }
  for (const recording::ShapeColumn& number : recording::shape_columns()) {
    shape.*number.value = gate_row<double>(number.name, i)[0];
    if (!is_number(shape.*number.value)) broken();
  }
  return shape;
}

RecordingReader::RecordingReader(const std::string& path) : impl_(std::make_unique<Impl>()) {
  if (path == "-") throw InputError("a recording cannot come from standard input; name its file");
  check_readable(path);
  const h5::Quiet quiet;
  impl_->path = path;
  h5::register_lzf();
  impl_->file = h5::open_to_read(path);
  if (!impl_->file.valid()) {
    const LockResult lock = h5::probe_lock(path);
    if (lock == LockResult::Held)
      throw InputError(path + " is open for writing in another program; close it there first");
    if (lock == LockResult::Unavailable) impl_->file = h5::open_to_read(path, false);
    // the environment takes precedence over the program's request to HDF5
    if (!impl_->file.valid() && lock == LockResult::Unavailable && asks_for_locks()) {
      throw InputError(path +
                       " is on a file system without locks, and HDF5_USE_FILE_LOCKING in the "
                       "environment asks for them; unset that");
    }
  }
  if (!impl_->file.valid()) {
    throw InputError(path + " " + is_not(read_head(path), "an HDF5 file") +
                     ", or is cut off; it must be a recording of prostm (.h5)");
  }
  const std::string format = h5::read_text(impl_->file.get(), "format");
  if (format != "prostm-recording/1") {
    throw InputError(
        fmt::format("{}: its attribute \"format\" is \"{:.40}\"; it must be \"prostm-recording/1\" "
                    "(a data set of another program: numpy.save(\"field.npy\", "
                    "h5py.File(FILE)[NAME][()]))",
                    path, format));
  }
  impl_->read_index();
}

RecordingReader::~RecordingReader() = default;

int RecordingReader::frames() const {
  return static_cast<int>(impl_->time.size());
}

std::span<const double> RecordingReader::times() const {
  return impl_->time;
}

std::string RecordingReader::attribute(const char* name) const {
  const h5::Quiet quiet;
  return h5::read_text(impl_->file.get(), name);
}

TargetFrame RecordingReader::frame(int i) const {
  const std::size_t at = impl_->checked(i);
  const h5::Quiet quiet;
  TargetFrame frame;
  frame.time = impl_->time[at];
  for (std::int32_t k = 0; k < impl_->patches[at]; ++k) {
    frame.patches.push_back(
        impl_->read_patch(static_cast<std::size_t>(impl_->first_patch[at] + k)));
    clear_rounding(frame.patches.back());
    try {
      validate(frame.patches.back());
    } catch (const std::invalid_argument& e) {
      throw InputError(fmt::format("{}, frame {}: {}", impl_->path, i, e.what()));
    }
  }
  return frame;
}

std::optional<RecordedPlan> RecordingReader::plan(int i) const {
  const std::size_t at = impl_->checked(i);
  const h5::Quiet quiet;
  const std::int32_t paths = impl_->plan_row<std::int32_t>("paths", at)[0];
  const std::int32_t foci = impl_->plan_row<std::int32_t>("foci", at)[0];
  if (paths == -1 && foci == -1) return std::nullopt;
  if (paths < 0 || paths > kMaxPaths || foci < 0 || foci > kMaxPaths || (paths > 0 && foci > 0)) {
    impl_->broken();
  }
  RecordedPlan recorded;
  impl_->read_paths(at, static_cast<std::size_t>(paths), recorded.plan);
  impl_->read_foci(at, static_cast<std::size_t>(foci), recorded.plan);
  if (impl_->has_plan_table(recording::kLoop)) {
    recorded.plan.loop = impl_->plan_row<double>(recording::kLoop, at)[0];
    if (!is_loop(recorded.plan.loop)) impl_->broken();
  }
  recorded.stats = impl_->read_stats(at);
  recorded.full_scale_pressure = impl_->plan_row<double>("full_scale_pressure", at)[0];
  const auto sigma = impl_->plan_row<double>("sigma", at);
  const auto patches = static_cast<std::size_t>(impl_->patches[at]);
  std::copy_n(sigma.begin(), patches, recorded.sigma.begin());
  const bool sound = is_number(recorded.full_scale_pressure) &&
                     std::all_of(sigma.begin(), sigma.begin() + impl_->patches[at],
                                 [](double x) { return is_number(x) && x > 0.0; });
  if (!sound) impl_->broken();
  return recorded;
}

std::optional<GateResult> RecordingReader::gate(int i) const {
  const std::size_t at = impl_->checked(i);
  const h5::Quiet quiet;
  if (H5Lexists(impl_->file.get(), "/gate", H5P_DEFAULT) <= 0) return std::nullopt;
  const std::int32_t passed = impl_->gate_row<std::int32_t>("passed", at)[0];
  if (passed == -1) return std::nullopt;
  const std::int32_t problem = impl_->gate_row<std::int32_t>("problem", at)[0];
  const auto away = impl_->gate_row<double>("away", at);
  GateResult result;
  result.pass = passed == 1;
  result.share = impl_->gate_row<double>("share", at)[0];
  result.finding.value = impl_->gate_row<double>("value", at)[0];
  result.finding.wanted = impl_->gate_row<double>("wanted", at)[0];
  result.finding.away = Vec2(away[0], away[1]);
  const bool sound = (passed == 0 || passed == 1) && problem >= 0 &&
                     static_cast<std::size_t>(problem) < kNames<GateProblem>.size() &&
                     is_number(result.share) && is_number(result.finding.value) &&
                     is_number(result.finding.wanted) && result.finding.away.allFinite();
  if (!sound) impl_->broken();
  result.finding.problem = static_cast<GateProblem>(problem);
  result.shape = impl_->read_shape(at);
  return result;
}

}  // namespace prostm
