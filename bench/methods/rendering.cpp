#include "methods/rendering.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "acoustics/focus_width.hpp"
#include "acoustics/skin_percept.hpp"
#include "am/am_planner.hpp"
#include "core/units.hpp"
#include "emit/loop_samples.hpp"
#include "plan/planner.hpp"

namespace prostm::bench {
namespace {

constexpr double kRate = 40e3;         // of samples [Hz]
constexpr int kPart = kLoopUnit;       // samples of a part of the loop, 0.2 ms, for the skin
constexpr double kBeside = 10e-3;      // of a ghost from where something is to be felt [m]
constexpr double kNothing = 0.1;       // share of the target's maximum that is nothing
constexpr double kModulation = 200.0;  // of the flat field [Hz]

/// @param sigma of the array's focus [m].
Plan plan_by(Way way, const TargetField& target, double sigma) {
  Plan plan;
  PlanStats stats;
  PlanSettings settings;
  switch (way) {
    case Way::Am:
      AmPlanner(AmSettings{}, target.size()).plan(target, plan, stats);
      break;
    case Way::Circles:
      plan = circles_at_mass_centres(target, settings.gain_law(), settings.max_length(), 1);
      break;
    case Way::PaperValid:
    case Way::Best:
    case Way::BestNarrow:
      settings.preset = way == Way::PaperValid ? "paper-valid" : "best";
      if (way == Way::BestNarrow) settings.sigma = sigma;
      Planner(settings, target.size()).plan(target, plan, stats);
      break;
    case Way::Flat:
      break;
  }
  return plan;
}

/// The plan as it sounds once it is running, full scale at its own largest pressure.
LoopSamples loop_of(const Plan& plan, const TargetField& target) {
  TargetFrame frame;
  frame.patches.push_back(target);
  LiftedPlan lifted;
  lift(plan, frame, lifted);
  EmitSettings settings;
  settings.foci = static_cast<int>(lifted.paths.size() + lifted.foci.size());
  for (const LiftedPath& path : lifted.paths) {
    for (const double p : path.pressure) {
      settings.full_scale_pressure = std::max(settings.full_scale_pressure, p);
    }
  }
  for (const LiftedFocus& focus : lifted.foci) {
    settings.full_scale_pressure = std::max(settings.full_scale_pressure, focus.pressure);
  }
  return loop_samples(lifted, settings, kRate);
}

/// Pressures of a loop over the whole raster, part by part: 0 off the skin.
std::vector<double> on_raster(const TargetField& raster, const SkinSurface& skin,
                              const LoopPressure& pressure) {
  const auto parts = static_cast<std::size_t>(pressure.frames);
  std::vector<double> out(raster.size() * parts, 0.0);
  for (std::size_t m = 0; m < skin.cell.size(); ++m) {
    for (std::size_t k = 0; k < parts; ++k) {
      out[k * raster.size() + skin.cell[m]] = static_cast<double>(pressure.frame[m * parts + k]);
    }
  }
  return out;
}

/// 1 Pa on all skin at the peak of the modulation, whose intensity is |sin|.
std::vector<double> flat_loop(const TargetField& raster, int parts) {
  std::vector<double> out;
  for (int k = 0; k < parts; ++k) {
    const double sine = std::sin(kPi * k / parts);
    for (const std::uint8_t skin : raster.skin) out.push_back(skin != 0 ? sine * sine : 0.0);
  }
  return out;
}

bool is_beside(const TargetField& target, double nothing, int row, int col) {
  const int reach = static_cast<int>(std::floor(kBeside / target.cell));
  for (int j = std::max(0, row - reach); j <= std::min(target.rows - 1, row + reach); ++j) {
    for (int i = std::max(0, col - reach); i <= std::min(target.cols - 1, col + reach); ++i) {
      const std::size_t cell = target.index(j, i);
      if (target.skin[cell] != 0 && target.pressure[cell] >= nothing &&
          std::hypot(j - row, i - col) * target.cell <= kBeside) {
        return false;
      }
    }
  }
  return true;
}

bool is_local_maximum(const TargetField& raster, const std::vector<double>& map, int row, int col) {
  const double here = map[raster.index(row, col)];
  for (int j = std::max(0, row - 1); j <= std::min(raster.rows - 1, row + 1); ++j) {
    for (int i = std::max(0, col - 1); i <= std::min(raster.cols - 1, col + 1); ++i) {
      if (map[raster.index(j, i)] > here) return false;
    }
  }
  return here > 0.0;
}

}  // namespace

std::string to_string(Way way) {
  switch (way) {
    case Way::PaperValid:
      return "paper-valid";
    case Way::Best:
      return "best";
    case Way::BestNarrow:
      return "best, its width";
    case Way::Am:
      return "AM";
    case Way::Circles:
      return "four circles";
    case Way::Flat:
      return "flat";
  }
  return "";
}

Ghosts ghosts_of(const TargetField& target, const std::vector<double>& percept) {
  const double nothing = kNothing * max_pressure(target);
  const double largest = *std::max_element(percept.begin(), percept.end());
  Ghosts out;
  for (int row = 0; row < target.rows; ++row) {
    for (int col = 0; col < target.cols; ++col) {
      const std::size_t cell = target.index(row, col);
      if (target.skin[cell] == 0 || !is_local_maximum(target, percept, row, col) ||
          !is_beside(target, nothing, row, col)) {
        continue;
      }
      out.largest = std::max(out.largest, percept[cell] / largest);
      out.count += percept[cell] > 0.5 * largest ? 1 : 0;
    }
  }
  return out;
}

struct Renderer::Parts {
  Parts(const TransducerArray& given, const TargetField& raster)
      : array(given),
        packed(given, medium),
        pool(2),
        skin(SkinModel(SkinSettings()), {raster.rows, raster.cols, raster.cell}),
        sigma(focus_width(packed, medium, raster.X_DP.translation(), -raster.X_DP.linear().col(2),
                          raster.X_DP.linear().col(0))
                  .sigma()) {}

  void play(const TargetField& target, Rendering& out);
  void feel(const TargetField& target, double period, int parts, std::span<const double> pressure,
            Rendering& out);

  Medium medium;
  TransducerArray array;
  PackedArray packed;
  WorkerPool pool;
  SkinResponse skin;
  double sigma;  // of a focus in the raster's middle [m]
};

/// What the array puts on the skin, and the skin's answer.
void Renderer::Parts::play(const TargetField& target, Rendering& out) {
  const LoopSamples loop = loop_of(out.plan, target);
  LoopDriveResult drives;
  loop_drives(
      array, medium, loop, {}, [](int, int) { return true; }, drives);
  out.mean_power = drives.mean_power;
  out.field = physical_field(packed, medium, target, loop, drives, pool);
  const SkinSurface surface = skin_surface(target);
  const int parts = loop.samples / kPart;
  const LoopPressure pressure =
      loop_pressure(packed, medium, drives.output, surface.points, parts, pool);
  feel(target, loop.samples / kRate, parts, on_raster(target, surface, pressure), out);
}

void Renderer::Parts::feel(const TargetField& target, double period, int parts,
                           std::span<const double> pressure, Rendering& out) {
  skin.prepare(period, parts);
  skin.respond({period, parts, pressure});
  out.percept.resize(target.size());
  percept_map(skin, out.percept);
  for (std::size_t c = 0; c < target.size(); ++c) {
    if (target.skin[c] == 0) out.percept[c] = 0.0;
  }
  out.intensity = perceived_intensity(skin);
  out.largest_percept = *std::max_element(out.percept.begin(), out.percept.end());
}

Renderer::Renderer(const TransducerArray& array, const TargetField& raster)
    : parts_(std::make_unique<Parts>(array, raster)) {}

Renderer::~Renderer() = default;

Rendering Renderer::render(Way way, const TargetField& target) {
  Rendering out;
  out.plan = plan_by(way, target, parts_->sigma);
  if (way == Way::Flat) {
    constexpr int kParts = 25;
    out.field.envelope.assign(target.size(), 0.0);
    for (std::size_t c = 0; c < target.size(); ++c) {
      if (target.skin[c] != 0) out.field.envelope[c] = 1.0;
    }
    out.field.largest = 1.0;
    parts_->feel(target, 1.0 / kModulation, kParts, flat_loop(target, kParts), out);
  } else {
    parts_->play(target, out);
  }
  out.envelope = score_physical(target, out.field.envelope, 0.0);
  out.felt = score_physical(target, out.percept, 0.0);
  out.ghosts = ghosts_of(target, out.percept);
  return out;
}

}  // namespace prostm::bench
