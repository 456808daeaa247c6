#include "prostm/io/recorder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>
#include <vector>

#include "prostm/core/file/file.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/core/text/json.hpp"
#include "prostm/io/detail/hdf5.hpp"
#include "prostm/io/detail/hdf5_disk.hpp"
#include "prostm/io/detail/recording_layout.hpp"
#include "prostm/io/settings_file.hpp"

namespace prostm {
namespace {

using recording::kHands;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr float kNanFloat = std::numeric_limits<float>::quiet_NaN();

/// A group of tables, accessed by name.
class Group {
 public:
  bool create(hid_t file, const char* name, const std::vector<h5::Column>& columns) {
    group_ = h5::Id(H5Gcreate2(file, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
    bool ok = group_.valid();
    for (const h5::Column& column : columns) ok = ok && add(column);
    return ok;
  }
  bool has(const char* name) const { return tables_.count(name) != 0; }
  /// Adds a table to the group.
  bool add(const h5::Column& column) {
    ok_ =
        tables_.emplace(column.name, h5::Table(group_.get(), column)).first->second.valid() && ok_;
    return ok_;
  }
  template <class T>
  void append(const char* name, const std::vector<T>& values, hsize_t rows) {
    ok_ = tables_.at(name).append(values.data(), rows) && ok_;
  }
  template <class T>
  void append(const char* name, T value) {
    ok_ = tables_.at(name).append(&value, 1) && ok_;
  }
  bool ok() const { return ok_; }
  bool close() {
    for (auto& [name, table] : tables_) ok_ = table.close() && ok_;
    ok_ = group_.close() && ok_;
    return ok_;
  }

 private:
  h5::Id group_;
  std::map<std::string, h5::Table> tables_;
  bool ok_ = true;
};

std::string reason(int error) {
  return std::generic_category().message(error);
}

/// Syncs a file to disk. Returns 0 or the error.
int sync(const std::string& path) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return errno;
  const int error = ::fsync(fd) == 0 ? 0 : errno;
  ::close(fd);
  return error;
}

/// The name of a file that is being recorded: `path` + ".part.h5", with `path` shortened if the
/// file system does not allow such a long name.
std::string part_of(const std::string& path) {
  constexpr std::string_view kEnding = ".part.h5";
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  const long limit = ::pathconf(folder.empty() ? "." : folder.c_str(), _PC_NAME_MAX);
  const std::size_t most = limit > 0 ? static_cast<std::size_t>(limit) : 255;
  std::string name = std::filesystem::path(path).filename().string();
  if (name.size() + kEnding.size() > most) {
    name.resize(most - kEnding.size());
    // do not split a UTF-8 character
    while (!name.empty() && (static_cast<unsigned char>(name.back()) & 0xc0U) == 0x80U)
      name.pop_back();
    if (!name.empty() && (static_cast<unsigned char>(name.back()) & 0x80U) != 0) name.pop_back();
  }
  return (folder / (name + std::string(kEnding))).string();
}

}  // namespace

void check_recording(const std::string& path) {
  check_writable(path);
  std::error_code ignored;
  const auto kind = std::filesystem::status(path, ignored).type();
  if (kind == std::filesystem::file_type::regular ||
      kind == std::filesystem::file_type::not_found || kind == std::filesystem::file_type::none) {
    if (path.ends_with(".h5") || path.ends_with(".H5")) return;
    throw InputError(path + " is not a name for a recording; it must end in .h5");
  }
  throw InputError(path + " is not an ordinary file; name a file to record into");
}

struct Recorder::Impl {
  std::string path, part;
  int error = 0;  // first errno of a write to the file
  h5::Id file;
  Group frame, target, hand, plan, gate;
  std::int64_t frames = 0, patches = 0, cells = 0;
  double flushed_at = 0.0;

  void append_target(const TargetField& field);
  void append_optional(const h5::Column& column, const TargetField& field,
                       const std::vector<double>& values);
  void append_hands(const HandFrame& hands);
  void append_plan(const RecordedPlan* made, std::size_t patches_now);
  void append_how(const RecordedPlan* made, std::size_t patches_now);
  void append_foci(const Plan* p);
  void append_gate(const std::optional<GateResult>& result);
  bool ok() const {
    return error == 0 && frame.ok() && target.ok() && hand.ok() && plan.ok() && gate.ok();
  }
  bool close_all();
  [[noreturn]] void give_up();
};

void Recorder::Impl::append_target(const TargetField& field) {
  target.append<std::int64_t>("frame", frames);
  target.append<std::int32_t>("rows", field.rows);
  target.append<std::int32_t>("cols", field.cols);
  target.append<std::int64_t>("offset", cells);
  target.append("cell", field.cell);
  target.append("origin", std::vector<double>{field.origin.x(), field.origin.y()}, 1);
  std::vector<double> pose;
  for (int row = 0; row < 4; ++row) {
    for (int col = 0; col < 4; ++col) pose.push_back(field.X_DP(row, col));
  }
  target.append("pose", pose, 1);

  // skin and pressure in one array: NaN means no skin
  std::vector<double> pressure = field.pressure;
  for (std::size_t i = 0; i < field.size(); ++i) {
    if (field.skin[i] == 0) pressure[i] = kNan;
  }
  target.append("pressure", pressure, field.size());
  target.append("height", field.height, field.size());
  append_optional(recording::weight_column(), field, field.weight);
  append_optional(recording::smoke_column(), field, field.smoke);
  append_optional(recording::movement_column(), field, field.movement);
  ++patches;
  cells += static_cast<std::int64_t>(field.size());
}

/// Appends optional values, one per cell. The table is created at the first patch that has values;
/// earlier patches have none.
void Recorder::Impl::append_optional(const h5::Column& column, const TargetField& field,
                                     const std::vector<double>& values) {
  const bool first = !target.has(column.name);
  if (first && values.empty()) return;
  std::vector<double> on_skin(field.size(), kNan);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (field.skin[i] != 0) on_skin[i] = values[i];
  }
  if (first && target.add(column)) {
    constexpr std::int64_t kRows = 1 << 16;
    const std::vector<double> none(kRows, kNan);
    for (std::int64_t left = cells; left > 0; left -= kRows) {
      target.append(column.name, none, static_cast<hsize_t>(std::min(left, kRows)));
    }
  }
  target.append(column.name, on_skin, field.size());
}

void Recorder::Impl::append_hands(const HandFrame& hands) {
  std::vector<std::int64_t> id(kHands, -1);
  std::vector<std::int32_t> side(kHands, -1);
  std::vector<std::uint32_t> inferred(kHands, 0);
  std::vector<float> confidence(kHands, kNanFloat), radius(kHands * kJointCount, kNanFloat);
  std::vector<float> position(3 * radius.size(), kNanFloat), velocity = position;
  std::vector<float> orientation(4 * radius.size(), kNanFloat);
  for (std::size_t h = 0; h < hands.hands.size(); ++h) {
    const Hand& hand_now = hands.hands[h];
    id[h] = hand_now.id;
    side[h] = hand_now.side == Side::Left ? 0 : 1;
    inferred[h] = hand_now.inferred;
    confidence[h] = static_cast<float>(hand_now.confidence);
    for (std::size_t j = 0; j < static_cast<std::size_t>(kJointCount); ++j) {
      const std::size_t at = h * kJointCount + j;
      radius[at] = static_cast<float>(hand_now.radius[j]);
      for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        position[3 * at + a] = static_cast<float>(hand_now.position[j][axis]);
        velocity[3 * at + a] = static_cast<float>(hand_now.velocity[j][axis]);
      }
      for (int k = 0; k < 4; ++k) {
        orientation[4 * at + static_cast<std::size_t>(k)] =
            static_cast<float>(hand_now.orientation[j].coeffs()[k]);
      }
    }
  }
  hand.append("id", id, 1);
  hand.append("side", side, 1);
  hand.append("confidence", confidence, 1);
  hand.append("inferred", inferred, 1);
  hand.append("position", position, 1);
  hand.append("orientation", orientation, 1);
  hand.append("radius", radius, 1);
  hand.append("velocity", velocity, 1);
}

/// @param patches_now number of patches in the frame.
void Recorder::Impl::append_plan(const RecordedPlan* made, std::size_t patches_now) {
  const Plan* p = made == nullptr ? nullptr : &made->plan;
  const std::size_t paths = p == nullptr ? 0 : p->paths.size();
  std::vector<std::int32_t> samples(kMaxPaths, 0), patch(kMaxPaths, -1);
  std::vector<double> length(kMaxPaths, kNan), speed = length, period = length;
  std::vector<double> pressure(static_cast<std::size_t>(kMaxPaths) * kMaxPathPoints, kNan);
  std::vector<double> points(2 * pressure.size(), kNan);
  for (std::size_t i = 0; i < paths; ++i) {
    const FocalPath& path_now = p->paths[i];
    samples[i] = static_cast<std::int32_t>(path_now.points.size());
    patch[i] = path_now.patch;
    length[i] = path_now.length;
    speed[i] = path_now.speed;
    period[i] = path_now.period;
    for (std::size_t k = 0; k < path_now.points.size(); ++k) {
      const std::size_t at = i * kMaxPathPoints + k;
      points[2 * at] = path_now.points[k].x();
      points[2 * at + 1] = path_now.points[k].y();
      pressure[at] = path_now.pressure[k];
    }
  }
  plan.append<std::int32_t>("paths", p == nullptr ? -1 : static_cast<std::int32_t>(paths));
  plan.append("samples", samples, 1);
  plan.append("patch", patch, 1);
  plan.append("points", points, 1);
  plan.append("pressure", pressure, 1);
  plan.append("length", length, 1);
  plan.append("speed", speed, 1);
  plan.append("period", period, 1);
  plan.append(recording::kLoop, p == nullptr ? 0.0 : p->loop);
  append_foci(p);
  append_how(made, patches_now);
}

/// Appends statistics of a plan, and the parameters of its reconstruction.
void Recorder::Impl::append_how(const RecordedPlan* made, std::size_t patches_now) {
  std::vector<double> stage, sigma(kMaxPatches, kNan);
  std::vector<std::int32_t> counts;
  for (const Quantity<PlanStats>& time : plan_stages())
    stage.push_back(made == nullptr ? kNan : value_of(time, made->stats));
  for (const Quantity<PlanStats>& count : recording::plan_counts()) {
    counts.push_back(made == nullptr ? 0 : static_cast<std::int32_t>(value_of(count, made->stats)));
  }
  if (made != nullptr) std::copy_n(made->sigma.begin(), patches_now, sigma.begin());
  plan.append("stage_time", stage, 1);
  plan.append("counts", counts, 1);
  plan.append("cost", made == nullptr ? kNan : made->stats.cost);
  plan.append("full_scale_pressure", made == nullptr ? kNan : made->full_scale_pressure);
  plan.append("sigma", sigma, 1);
}

void Recorder::Impl::append_foci(const Plan* p) {
  const std::size_t foci = p == nullptr ? 0 : p->foci.size();
  std::vector<std::int32_t> patch(kMaxPaths, -1);
  std::vector<double> pressure(kMaxPaths, kNan), phase = pressure;
  std::vector<double> position(2 * pressure.size(), kNan);
  for (std::size_t i = 0; i < foci; ++i) {
    const FocalPoint& focus = p->foci[i];
    patch[i] = focus.patch;
    position[2 * i] = focus.position.x();
    position[2 * i + 1] = focus.position.y();
    pressure[i] = focus.pressure;
    phase[i] = focus.phase;
  }
  plan.append<std::int32_t>("foci", p == nullptr ? -1 : static_cast<std::int32_t>(foci));
  plan.append("focus_patch", patch, 1);
  plan.append("focus_position", position, 1);
  plan.append("focus_pressure", pressure, 1);
  plan.append(recording::kFocusPhase, phase, 1);
}

void Recorder::Impl::append_gate(const std::optional<GateResult>& result) {
  const GateResult said = result.value_or(GateResult{});
  gate.append<std::int32_t>("passed", !result ? -1 : said.pass ? 1 : 0);
  gate.append("share", said.share);
  gate.append("problem", static_cast<std::int32_t>(said.finding.problem));
  gate.append("value", said.finding.value);
  gate.append("wanted", said.finding.wanted);
  gate.append("away", std::vector<double>{said.finding.away.x(), said.finding.away.y()}, 1);
  gate.append<std::int32_t>("maxima", said.shape.count());
  std::vector<double> position(2 * FieldShape::kMaxMaxima, kNan);
  std::vector<double> pressure(FieldShape::kMaxMaxima, kNan);
  for (std::size_t i = 0; i < said.shape.maxima.size(); ++i) {
    position[2 * i] = said.shape.maxima[i].position.x();
    position[2 * i + 1] = said.shape.maxima[i].position.y();
    pressure[i] = said.shape.maxima[i].pressure;
  }
  gate.append("position", position, 1);
  gate.append("pressure", pressure, 1);
  for (const recording::ShapeColumn& number : recording::shape_columns())
    gate.append(number.name, said.shape.*number.value);
}

bool Recorder::Impl::close_all() {
  bool done = frame.close();
  done = target.close() && done;
  done = hand.close() && done;
  done = plan.close() && done;
  done = gate.close() && done;
  return file.close() && done && error == 0;
}

void Recorder::Impl::give_up() {
  close_all();
  // flushed data may still be a valid recording; a damaged file is deleted
  std::string rest = fmt::format("the recording up to then is in {}", part);
  try {
    RecordingReader reader(part);
  } catch (const InputError&) {
    ::unlink(part.c_str());
    rest = "nothing was kept";
  }
  throw InputError(fmt::format("{} cannot be written ({}); {}", path,
                               error != 0 ? reason(error) : "libhdf5 failed", rest));
}

Recorder::Recorder(const std::string& path, const std::vector<SettingsGroup>& settings)
    : impl_(std::make_unique<Impl>()) {
  const h5::Quiet quiet;
  Impl& r = *impl_;
  r.path = path;
  r.part = part_of(path);
  check_recording(path);  // HDF5 does not report why a file cannot be created
  r.file = h5::create_file(r.part, r.error);
  const hid_t file = r.file.get();
  const bool ok = r.file.valid() && h5::write_text(file, "format", "prostm-recording/1") &&
                  h5::write_text(file, "settings", to_text(settings_to_json(settings))) &&
                  r.frame.create(file, "frame", recording::frame_columns()) &&
                  r.target.create(file, "target", recording::target_columns()) &&
                  r.hand.create(file, "hand", recording::hand_columns()) &&
                  r.plan.create(file, "plan", recording::plan_columns()) &&
                  r.gate.create(file, "gate", recording::gate_columns()) &&
                  H5Fflush(file, H5F_SCOPE_GLOBAL) >= 0 && r.error == 0;
  if (!ok) {
    r.close_all();
    ::unlink(r.part.c_str());
    throw InputError(fmt::format("{} cannot be written ({})", path,
                                 r.error != 0 ? reason(r.error) : "another program uses it"));
  }
}

Recorder::~Recorder() {
  try {
    close();
  } catch (const InputError&) {
    // a destructor cannot report errors; call close() for that
  }
}

void Recorder::append(const TargetFrame& frame, const HandFrame& hands, const RecordedPlan* plan,
                      const std::optional<GateResult>& gate) {
  if (!impl_->file.valid()) throw std::logic_error("a closed recording cannot be appended to");
  const h5::Quiet quiet;
  Impl& r = *impl_;
  r.frame.append("time", frame.time);
  r.frame.append<std::int64_t>("first_patch", r.patches);
  r.frame.append<std::int32_t>("patches", static_cast<std::int32_t>(frame.patches.size()));
  for (const TargetField& field : frame.patches) r.append_target(field);
  r.append_hands(hands);
  r.append_plan(plan, frame.patches.size());
  r.append_gate(gate);

  // flush after every second of data; time that decreases is a recording that starts again
  if (r.frames++ == 0) r.flushed_at = frame.time;
  bool ok = r.ok();
  if (ok && std::abs(frame.time - r.flushed_at) >= 1.0) {
    ok = H5Fflush(r.file.get(), H5F_SCOPE_GLOBAL) >= 0 && r.error == 0;
    r.flushed_at = frame.time;
  }
  if (!ok) r.give_up();
}

void Recorder::set_attribute(const std::string& name, const std::string& value) {
  const h5::Quiet quiet;
  if (!h5::write_text(impl_->file.get(), name.c_str(), value) || impl_->error != 0)
    impl_->give_up();
}

bool Recorder::open() const {
  return impl_->file.valid();
}

void Recorder::close() {
  Impl& r = *impl_;
  if (!r.file.valid()) return;
  const h5::Quiet quiet;
  const bool flushed = H5Fflush(r.file.get(), H5F_SCOPE_GLOBAL) >= 0;
  if (!r.close_all() || !flushed) r.give_up();
  int error = sync(r.part);
  if (error == 0 && std::rename(r.part.c_str(), r.path.c_str()) != 0) error = errno;
  if (error != 0) {
    throw InputError(fmt::format("{} cannot be written ({}); the recording is in {}", r.path,
                                 reason(error), r.part));
  }
}

}  // namespace prostm
