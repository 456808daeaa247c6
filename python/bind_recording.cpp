#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>

#include "bindings.hpp"
#include "hdf5_turn.hpp"
#include "plan_result.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/io/recorder.hpp"
#include "settings.hpp"

namespace prostm::python {
namespace {

/// A recording that stays open, and its settings.
class Recording {
 public:
  explicit Recording(const std::filesystem::path& path) : path_(path.string()) {
    const Hdf5Turn turn;
    reader_ = std::make_unique<RecordingReader>(path_);
    try {
      settings_ = py::module_::import("json").attr("loads")(reader_->attribute("settings"));
    } catch (const py::error_already_set&) {
      throw InputError(path_ + ": its attribute \"settings\" is not JSON");
    }
  }
  ~Recording() {
    // an interpreter that is shutting down has no other threads and no modules
    if (_Py_IsFinalizing() != 0) return;
    const Hdf5Turn turn;
    reader_.reset();
  }
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  const RecordingReader& reader() const { return *reader_; }
  /// Returns an independent copy, by stage.
  py::dict settings() const { return py::module_::import("copy").attr("deepcopy")(settings_); }

  std::string attribute(const char* name) const {
    const Hdf5Turn turn;
    return reader_->attribute(name);
  }
  TargetFrame target(int i) const {
    const Hdf5Turn turn;
    return reader_->frame(i);
  }
  std::unique_ptr<PlanResult> plan(int i) const;
  std::optional<GateResult> gate(int i) const {
    const Hdf5Turn turn;
    return reader_->gate(i);
  }

 private:
  template <class S>
  S settings_of(const char* stage) const;
  AnySettings planner_settings() const;

  std::string path_;
  std::unique_ptr<RecordingReader> reader_;
  py::dict settings_;
};

template <class S>
S Recording::settings_of(const char* stage) const {
  S settings;
  set_settings(group_of(stage, settings), settings_[stage]);
  return settings;
}

AnySettings Recording::planner_settings() const {
  const py::object method = settings_["pipeline"]["method"];
  if (method.equal(py::str(std::string(name_of(Method::Am))))) return settings_of<AmSettings>("am");
  return settings_of<PlanSettings>("plan");
}

std::unique_ptr<PlanResult> Recording::plan(int i) const {
  std::optional<RecordedPlan> made;
  TargetFrame frame;
  {
    const Hdf5Turn turn;
    made = reader_->plan(i);
    if (!made) return nullptr;
    frame = reader_->frame(i);
  }
  std::unique_ptr<PlanResult> result;
  try {
    result = std::make_unique<PlanResult>(py::cast(std::move(frame)), planner_settings());
    result->recorded = PlanResult::Recorded{settings_of<EmitSettings>("emit"), made->sigma};
  } catch (const std::exception& e) {
    throw InputError(path_ + ": its attribute \"settings\" is of another version: " + e.what());
  }
  result->recorded->emission.full_scale_pressure = made->full_scale_pressure;
  result->status = PlanStatus::Planned;
  result->plan = made->plan;
  result->stats = made->stats;
  return result;
}

}  // namespace

void bind_recording(py::module_& m) {
  py::class_<Recording>(
      m, "Recording",
      "A recording of `prostm run --record` or `prostm capture`: targets and plans by frame.\n\n"
      "Frames are read on request, and the file stays open while the object lives.\n"
      "It may be open in h5py at the same time.")
      .def(py::init<const std::filesystem::path&>(),
           "path: name of the .h5 file. Raises InputError, a ValueError, that names the file.",
           py::arg("path"))
      .def_property_readonly(
          "frames", [](const Recording& self) { return self.reader().frames(); },
          "Number of frames, which count from 0.")
      .def_property_readonly(
          "time",
          [](const py::object& self) {
            const auto times = self.cast<const Recording&>().reader().times();
            return view({static_cast<py::ssize_t>(times.size())}, times.data(), self);
          },
          "(frames,) time of each frame [s]; a view.")
      .def_property_readonly(
          "scene", [](const Recording& self) { return self.attribute("scene"); },
          "Name of the scene.")
      .def_property_readonly("settings", &Recording::settings,
                             "Settings of every stage as the run began with them: a dictionary of "
                             "dictionaries, as a copy.")
      .def("target", &Recording::target,
           "The TargetFrame of a frame: one TargetField for each hand, none without hands.\n"
           "Raises InputError for a frame that does not exist.",
           py::arg("frame"))
      .def("plan", &Recording::plan,
           "The plan of a frame as it was made and played, not planned anew: a PlanResult for the\n"
           "TargetFrame, or None if no plan was made. Its metrics() and quasi_static_field() use\n"
           "the recorded emission, and the width of a focal point that each target was planned\n"
           "with. Raises InputError for a frame that does not exist.",
           py::arg("frame"))
      .def("gate", &Recording::gate,
           "The GateResult of a frame; None if the gate did not check it, and in recordings of\n"
           "earlier versions. Raises InputError for a frame that does not exist.",
           py::arg("frame"))
      .def("__repr__", [](const Recording& self) {
        return "Recording(" + std::to_string(self.reader().frames()) + " frames)";
      });
}

}  // namespace prostm::python
