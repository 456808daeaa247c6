/// Recordings: whatever the datasets hold, a frame is valid or gives an InputError. The input
/// becomes the numbers of a recording, not the file itself: broken HDF5 structure is up to libhdf5.
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

#include "prostm/core/input_error.hpp"
#include "prostm/io/recorder.hpp"

namespace {

/// Takes the next number of the input; 0 if it is used up.
template <class T>
T take(std::string_view& bytes) {
  T value{};
  if (bytes.size() < sizeof(T)) return value;
  std::memcpy(&value, bytes.data(), sizeof(T));
  bytes.remove_prefix(sizeof(T));
  return value;
}

/// Makes a field whose shape, numbers and sizes may contradict each other.
prostm::TargetField any_field(std::string_view& bytes) {
  prostm::TargetField field;
  field.rows = take<std::int16_t>(bytes);
  field.cols = take<std::int16_t>(bytes);
  field.cell = take<double>(bytes);
  field.origin.x() = take<double>(bytes);
  if (take<std::uint8_t>(bytes) > 200) field.X_DP(1, 2) = take<double>(bytes);
  const std::size_t cells = take<std::uint8_t>(bytes);
  const bool has_weights = (take<std::uint8_t>(bytes) & 1U) != 0;
  for (std::size_t i = 0; i < cells; ++i) {
    field.pressure.push_back(take<double>(bytes));
    field.height.push_back(take<double>(bytes));
    field.skin.push_back(take<std::uint8_t>(bytes) & 1U);
    if (has_weights) field.weight.push_back(take<double>(bytes));
  }
  return field;
}

/// Makes a plan whose paths may lie on no patch and hold any numbers.
prostm::RecordedPlan any_plan(std::string_view& bytes) {
  prostm::RecordedPlan made;
  made.full_scale_pressure = take<double>(bytes);
  for (double& sigma : made.sigma) sigma = take<double>(bytes);
  for (int paths = take<std::uint8_t>(bytes) % 9; paths > 0; --paths) {
    prostm::FocalPath path;
    path.patch = take<std::int8_t>(bytes);
    for (int points = take<std::uint8_t>(bytes) % 65; points > 0; --points) {
      path.points.emplace_back(take<double>(bytes), take<double>(bytes));
      path.pressure.push_back(take<double>(bytes));
    }
    path.length = take<double>(bytes);
    path.speed = take<double>(bytes);
    path.period = take<double>(bytes);
    made.plan.paths.push_back(path);
  }
  return made;
}

/// Makes a result with any numbers, also with a problem that does not exist.
std::optional<prostm::GateResult> any_gate(std::string_view& bytes) {
  if (take<std::uint8_t>(bytes) % 2 == 0) return {};
  prostm::GateResult said;
  said.finding.problem = static_cast<prostm::GateProblem>(take<std::uint8_t>(bytes));
  said.finding.value = take<double>(bytes);
  said.share = take<double>(bytes);
  for (int maxima = take<std::uint8_t>(bytes) % 17; maxima > 0; --maxima) {
    const prostm::Vec2 position(take<double>(bytes), take<double>(bytes));
    said.shape.maxima.push_back({position, take<double>(bytes)});
  }
  said.shape.force = take<double>(bytes);
  return said;
}

void read_frame(const prostm::RecordingReader& reader, int i) {
  try {
    for (const prostm::TargetField& field : reader.frame(i).patches) prostm::validate(field);
    static_cast<void>(reader.plan(i));
    if (const auto gate = reader.gate(i)) static_cast<void>(sentence(*gate));
  } catch (const prostm::InputError&) {
    // the required answer to bad input
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace prostm;
  std::string_view bytes(reinterpret_cast<const char*>(data), size);
  static const std::string path = "/tmp/prostm-fuzz-" + std::to_string(::getpid()) + ".h5";
  Recorder recorder(path, {});
  for (int i = 0; i < 3; ++i) {
    TargetFrame frame;
    frame.time = take<double>(bytes);
    const int patches = take<std::uint8_t>(bytes) % 3;
    for (int p = 0; p < patches; ++p) frame.patches.push_back(any_field(bytes));
    const RecordedPlan made = any_plan(bytes);
    recorder.append(frame, {}, made.plan.paths.empty() ? nullptr : &made, any_gate(bytes));
  }
  recorder.close();
  try {
    const RecordingReader reader(path);
    for (int i = 0; i < reader.frames(); ++i) read_frame(reader, i);
  } catch (const InputError&) {
    // the required answer to tables that contradict each other
  }
  ::unlink(path.c_str());
  return 0;
}
