#include <pybind11/stl.h>

#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>

#include "bindings.hpp"
#include "plan_result.hpp"
#include "prostm/core/require.hpp"
#include "prostm/emit/emitter.hpp"
#include "settings.hpp"

namespace prostm::python {
namespace {

constexpr int kMostSamples = 100'000'000;  // in one call; each takes 16 bytes per focal point

void check_patches(const Plan& plan, std::size_t patches) {
  const auto check = [patches](const char* what, int patch) {
    if (static_cast<std::size_t>(patch) < patches) return;
    throw std::invalid_argument(std::string("a ") + what + " lies on patch " +
                                std::to_string(patch) + "; the target has " +
                                std::to_string(patches));
  };
  for (const FocalPath& path : plan.paths) check("path", path.patch);
  for (const FocalPoint& focus : plan.foci) check("focus", focus.patch);
}

std::unique_ptr<LiftedPlan> lift_on_frame(const Plan& plan, const TargetFrame& frame) {
  check_patches(plan, frame.patches.size());
  auto lifted = std::make_unique<LiftedPlan>();
  const py::gil_scoped_release unlocked;
  lift(plan, frame, *lifted);
  return lifted;
}

/// Lifts a Plan for a target, or a PlanResult for its own.
std::unique_ptr<LiftedPlan> lift_any(const py::object& plan, const py::object& target) {
  if (py::isinstance<PlanResult>(plan)) {
    if (!target.is_none()) {
      throw std::invalid_argument(
          "a PlanResult holds the target that it was made for; leave out target, or give the "
          "result's plan");
    }
    const auto& result = plan.cast<const PlanResult&>();
    return lift_on_frame(result.plan, result.frame());
  }
  if (!py::isinstance<Plan>(plan))
    throw py::type_error("plan must be a Plan or a PlanResult, not " + described(plan));
  if (target.is_none()) {
    throw py::type_error(
        "a Plan needs the TargetField or TargetFrame that it was made for, as target; a PlanResult "
        "brings its own");
  }
  TargetFrame frame;
  for (const TargetField* patch : patches_of(target)) frame.patches.push_back(*patch);
  return lift_on_frame(plan.cast<const Plan&>(), frame);
}

void bind_lifted(py::module_& m) {
  py::class_<LiftedPath>(m, "LiftedPath",
                         "A closed path on the skin, in the device's frame: a polygon in 3-D.")
      .def_property_readonly(
          "p_D",
          [](const py::object& self) {
            static_assert(sizeof(Vec3) == 3 * sizeof(double));
            const auto& p = self.cast<const LiftedPath&>().p_D;
            const double* data = p.empty() ? nullptr : p.data()->data();
            return view({static_cast<py::ssize_t>(p.size()), 3}, data, self);
          },
          "(n, 3) points [m]; a view.")
      .def_property_readonly(
          "pressure",
          [](const py::object& self) {
            const auto& p = self.cast<const LiftedPath&>().pressure;
            return view({static_cast<py::ssize_t>(p.size())}, p.data(), self);
          },
          "(n,) rendered pressure, in the target's unit; a view.")
      .def_property_readonly(
          "s",
          [](const py::object& self) {
            const auto& s = self.cast<const LiftedPath&>().s;
            return view({static_cast<py::ssize_t>(s.size())}, s.data(), self);
          },
          "(n,) arc length of each point [m], s[0] = 0; a view.")
      .def_readonly("length", &LiftedPath::length, "Length on the skin [m].")
      .def_readonly("speed", &LiftedPath::speed, "Speed of the focal point [m/s].");

  py::class_<LiftedFocus>(m, "LiftedFocus", "A focal point that stands still on the skin.")
      .def_property_readonly(
          "p_D",
          [](const py::object& self) {
            return view({3}, self.cast<const LiftedFocus&>().p_D.data(), self);
          },
          "(3,) in the device's frame [m]; a view.")
      .def_readonly("pressure", &LiftedFocus::pressure,
                    "Rendered pressure at the peak of the modulation, in the target's unit.")
      .def_readonly("phase", &LiftedFocus::phase,
                    "Delay of its modulation, as a share of its period.");

  py::class_<LiftedPlan>(m, "LiftedPlan", "A plan on the skin, ready to be emitted; see lift().")
      .def_property_readonly(
          "paths",
          [](const py::object& self) {
            py::list paths;
            for (const LiftedPath& path : self.cast<const LiftedPlan&>().paths) {
              paths.append(py::cast(&path, py::return_value_policy::reference_internal, self));
            }
            return paths;
          },
          "The LiftedPaths, as a new list.")
      .def_property_readonly(
          "foci",
          [](const py::object& self) {
            py::list foci;
            for (const LiftedFocus& focus : self.cast<const LiftedPlan&>().foci) {
              foci.append(py::cast(&focus, py::return_value_policy::reference_internal, self));
            }
            return foci;
          },
          "The LiftedFoci, as a new list.")
      .def_readonly("loop", &LiftedPlan::loop,
                    "Period in which all paths come round together [s]; 0: each on its own.")
      .def_readwrite("id", &LiftedPlan::id, "Number of the plan, which TakeOver repeats.");

  m.def(
      "lift", &lift_any,
      "Lifts a plan back to the skin: each segment is cut in five, each point gets the height of\n"
      "the skin there, in the device's frame. plan: a PlanResult, or a Plan with the TargetField\n"
      "or TargetFrame that it was made for as target. Returns a LiftedPlan.",
      py::arg("plan"), py::arg("target") = py::none());
}

/// An emitter and a lock for each of its two sides, so that any Python threads may call it.
struct SharedEmitter {
  SharedEmitter(Method method, const EmitSettings& s, double rate)
      : emitter(make_emitter(method, s, rate)), settings(s), sample_rate(rate) {}
  std::unique_ptr<Emitter> emitter;
  EmitSettings settings;
  double sample_rate;
  std::mutex planners_side, devices_side;
};

/// The emitter of a method; each has its own class in Python.
template <Method kMethod>
struct SharedEmitterOf : SharedEmitter {
  SharedEmitterOf(const EmitSettings& s, double rate) : SharedEmitter(kMethod, s, rate) {}
};

template <Method kMethod>
void bind_emitter_of(py::module_& m, const char* name, const char* doc) {
  py::class_<SharedEmitterOf<kMethod>, SharedEmitter>(m, name, doc)
      .def(py::init([](const EmitSettings* settings, double sample_rate, const py::kwargs& values) {
             EmitSettings own = settings != nullptr ? *settings : EmitSettings{};
             set_settings(group_of("EmitSettings", own), values);
             return std::make_unique<SharedEmitterOf<kMethod>>(own, sample_rate);
           }),
           "settings: EmitSettings, copied; None: the defaults. sample_rate: that of the device\n"
           "[Hz]. Further keywords are settings. Raises ValueError that names the setting and its\n"
           "bound.",
           py::arg("settings") = py::none(), py::arg("sample_rate") = 40e3);
}

void submit(SharedEmitter& self, const LiftedPlan& plan) {
  const py::gil_scoped_release unlocked;
  const std::lock_guard lock(self.planners_side);
  self.emitter->draft() = plan;
  self.emitter->submit();
}

/// Fills an array in place: a FocusSample is four floats, of which two arrays are views.
py::tuple fill(SharedEmitter& self, std::int64_t first, int samples) {
  static_assert(sizeof(FocusSample) == 4 * sizeof(float));
  static_assert(offsetof(FocusSample, intensity) == 3 * sizeof(float));
  require_between("samples", samples, 1, kMostSamples);
  if (first < 0) {
    throw std::invalid_argument("first = " + std::to_string(first) + " must be at least 0");
  }
  const py::ssize_t foci = self.emitter->foci(), n = samples;
  py::array_t<float> all({n, foci, py::ssize_t{4}});
  float* data = all.mutable_data();
  {
    const py::gil_scoped_release unlocked;
    const std::lock_guard lock(self.devices_side);
    const auto count = static_cast<std::size_t>(n * foci);
    auto* out = reinterpret_cast<FocusSample*>(data);
    std::uninitialized_default_construct_n(out, count);
    self.emitter->fill(first, {out, count});
  }
  const py::ssize_t number = sizeof(float), sample = 4 * number;
  const std::vector<py::ssize_t> strides{foci * sample, sample, number};
  const auto type = py::dtype::of<float>();
  const py::array positions(type, {n, foci, py::ssize_t{3}}, strides, data, all);
  const py::array intensities(type, {n, foci}, {strides[0], strides[1]}, data + 3, all);
  return py::make_tuple(positions, intensities);
}

void bind_emitter(py::module_& m) {
  bind_settings<EmitSettings>(
      m, "EmitSettings",
      "Settings of the emission, in SI units. full_scale_pressure, the rendered pressure that is\n"
      "played at intensity 1, must be given.");

  Record<EmitStats>(m, "EmitStats", "Counters of an emission.")
      .field("samples", &EmitStats::samples, "Samples emitted, summed over focal points.")
      .field("saturated", &EmitStats::saturated,
             "Samples whose path asks for more than full scale, clipped to intensity 1. A path at\n"
             "full scale itself, as planned for the largest pressures, is not counted.")
      .field("limited", &EmitStats::limited, "Samples scaled down by the power limit.")
      .field("faded", &EmitStats::faded, "Samples in a fade of a transition.")
      .field("laps_started", &EmitStats::laps_started, "Laps that began.")
      .field("laps_cut", &EmitStats::laps_cut, "Laps that were cut short.")
      .field("stalls", &EmitStats::stalls, "Fade-outs because no plan arrived.")
      .field("refused_plans", &EmitStats::refused_plans,
             "Plans with a number that is not finite or out of bounds.")
      .field("dropped_paths", &EmitStats::dropped_paths,
             "Paths beyond the number of focal points, not drawn.")
      .field("max_focus_step", &EmitStats::max_focus_step,
             "Largest step between samples while the intensity is above 1 % [m].")
      .done();
  Record<TakeOver>(m, "TakeOver", "When a plan took over, in counts of samples.")
      .field("plan", &TakeOver::plan, "Id of the plan.")
      .field("arrival_sample", &TakeOver::arrival_sample,
             "First sample that was made after the plan arrived.")
      .field("first_sample", &TakeOver::first_sample, "First sample that follows the plan.")
      .field("redrawn_sample", &TakeOver::redrawn_sample,
             "Sample at which 90 % of its path length was drawn; -1: never.")
      .done();

  py::class_<SharedEmitter>(
      m, "Emitter",
      "Turns plans into samples of focal points: a PathEmitter or a FocusEmitter.\n\n"
      "While its intensity is above 1 % a focal point moves at most 8 m/s, intensities change by\n"
      "at most 1/40 per sample and the sum of their squares stays within power_limit. Output "
      "fades\n"
      "out if no new plan arrives within stall_time.")
      .def("submit", &submit,
           "Hands over a LiftedPlan, which is copied; it replaces a plan that no fill() has "
           "fetched.",
           py::arg("plan"))
      .def(
          "lose",
          [](SharedEmitter& self) {
            const py::gil_scoped_release unlocked;
            const std::lock_guard lock(self.planners_side);
            self.emitter->lose();
          },
          "Fades out within 50 ms, until the next plan: the hand is gone.")
      .def(
          "fill", &fill,
          "Makes the samples first ... first + samples - 1; call it with consecutive samples. A\n"
          "submitted plan is fetched at the start of a call.\n\n"
          "Returns (positions, intensities): (samples, foci, 3) float32 in the device's frame [m]\n"
          "and (samples, foci) float32 in 0..1, linear in acoustic pressure amplitude. Both are\n"
          "views of one array of (x, y, z, intensity).",
          py::arg("first"), py::arg("samples"))
      .def_property_readonly(
          "foci", [](const SharedEmitter& self) { return self.emitter->foci(); },
          "Focal points per sample.")
      .def_readonly("sample_rate", &SharedEmitter::sample_rate, "Samples a second [Hz].")
      .def_property_readonly(
          "settings", [](const SharedEmitter& self) { return EmitSettings(self.settings); },
          "A copy of the settings.")
      .def(
          "next_take_over",
          [](SharedEmitter& self) -> std::optional<TakeOver> {
            const py::gil_scoped_release unlocked;
            const std::lock_guard lock(self.planners_side);
            TakeOver out;
            if (!self.emitter->next_take_over(out)) return std::nullopt;
            return out;
          },
          "The oldest unread TakeOver, or None.")
      .def(
          "stats",
          [](SharedEmitter& self) {
            const py::gil_scoped_release unlocked;
            const std::lock_guard lock(self.planners_side);
            return self.emitter->stats();
          },
          "The EmitStats after the last fill().");
  bind_emitter_of<Method::ProStm>(m, "PathEmitter",
                                  "Plans of paths as samples: speed, transitions, drive law, "
                                  "fade-out; docs/design/emission.md");
  bind_emitter_of<Method::Am>(
      m, "FocusEmitter",
      "Plans of foci as samples: amplitude modulation of focal points that stand still and move\n"
      "between two silent samples; docs/design/am.md.");
}

/// The drive law over an array of any shape.
py::array drive_intensities(const py::object& pressure, double full_scale, double silent_below) {
  const py::array given = py::array::ensure(pressure);
  const Numbers p = numbers(pressure, "pressure", given ? static_cast<int>(given.ndim()) : 0);
  require_between("full_scale", full_scale, 1e-300, 1e300);
  require_between("silent_below", silent_below, 0.0, 0.999);
  py::array_t<double> out(std::vector<py::ssize_t>(p.shape(), p.shape() + p.ndim()));
  for (py::ssize_t i = 0; i < p.size(); ++i) {
    require_between("pressure", p.data()[i], -1e300, 1e300);
    bool saturated = false;
    out.mutable_data()[i] = drive_intensity(p.data()[i], full_scale, silent_below, saturated);
  }
  return out;
}

}  // namespace

void bind_emit(py::module_& m) {
  m.attr("kMostSamples") = kMostSamples;
  bind_lifted(m);
  bind_emitter(m);
  m.def(
      "drive_intensity", &drive_intensities,
      "The drive law: sqrt(pressure / full_scale), since radiation pressure goes with the square\n"
      "of acoustic pressure; clipped to 1, 0 below the silent share. pressure: an array of any\n"
      "shape, in the unit of full_scale. Returns intensities 0..1 of the same shape.",
      py::arg("pressure"), py::arg("full_scale"),
      py::arg("silent_below") = EmitSettings{}.silent_below);
  m.def(
      "even_share",
      [](int paths, double power_limit) {
        require_between("paths", paths, 1, kMaxPaths);
        require_between("power_limit", power_limit, 1e-6, double{kMaxPaths});
        return even_share(paths, power_limit);
      },
      "min(1, power_limit / paths): the share of full scale's radiation pressure that each of "
      "this\n"
      "many focal points may have if all request the same.",
      py::arg("paths"), py::arg("power_limit") = EmitSettings{}.power_limit);
}

}  // namespace prostm::python
