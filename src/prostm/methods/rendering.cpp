#include "prostm/methods/rendering.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "prostm/acoustics/field/focus_width.hpp"
#include "prostm/am/am_planner.hpp"
#include "prostm/core/units.hpp"
#include "prostm/emit/loop_samples.hpp"
#include "prostm/plan/planner.hpp"
#include "prostm/score/plan_percept.hpp"

namespace prostm::methods {
namespace {

constexpr double kRate = 40e3;         // sample rate [Hz]
constexpr double kModulation = 200.0;  // modulation frequency of the flat field [Hz]

/// Plans with a preset. @param sigma [m].
Plan pro_stm(Preset preset, double sigma, const TargetField& target) {
  Plan plan;
  PlanStats stats;
  PlanSettings settings;
  settings.preset = preset;
  settings.sigma = sigma;
  Planner(settings, target.size()).plan(target, plan, stats);
  return plan;
}

Plan am(const AmSettings& settings, const TargetField& target) {
  Plan plan;
  PlanStats stats;
  AmPlanner(settings, target.size()).plan(target, plan, stats);
  return plan;
}

/// AM with optimised pressures and phases; σ is the best one (docs/measurements/felt.md).
AmSettings felt_am(int foci, double focus_width) {
  AmSettings settings;
  settings.foci = foci;
  settings.sigma = 16e-3;
  settings.felt_weight = 1.0;
  settings.widths = {{0.2}, {0.0}, {0.0}, {focus_width}};  // the same everywhere
  return settings;
}

/// @param focus_width of the array [m].
Plan plan_by(Way way, const TargetField& target, double focus_width, Random& random) {
  const PlanSettings paper;
  switch (way) {
    case Way::PaperValid:
      return pro_stm(Preset::PaperValid, paper.sigma, target);
    case Way::Best:
      return pro_stm(Preset::Best, paper.sigma, target);
    case Way::BestNarrow:
      return pro_stm(Preset::Best, focus_width, target);
    case Way::Felt:
      return pro_stm(Preset::Felt, focus_width, target);
    case Way::Am:
      return am({}, target);
    case Way::Circle:
      return circle_at_mean_distance(target, paper.gain_law(), paper.least_length,
                                     paper.max_length());
    case Way::Circles:
      return circles_at_mass_centres(target, paper.gain_law(), paper.max_length(), 1);
    case Way::RandomCircles:
      return random_circles(target, paper.sigma, paper.gain_law(), paper.max_length(), random);
    case Way::AmFelt:  // Renderer::render() compares several
    case Way::Flat:
      break;
  }
  return {};
}

/// Returns the pressure of the flat field: 1 Pa on all skin at the peak of the modulation, whose
/// intensity is |sin|.
std::vector<double> flat_loop(const TargetField& raster, int parts) {
  std::vector<double> out;
  for (int k = 0; k < parts; ++k) {
    const double sine = std::sin(kPi * k / parts);
    for (const std::uint8_t skin : raster.skin) out.push_back(skin != 0 ? sine * sine : 0.0);
  }
  return out;
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
    case Way::Felt:
      return "preset felt";
    case Way::Am:
      return "AM";
    case Way::AmFelt:
      return "AM, optimised";
    case Way::Circle:
      return "one circle";
    case Way::Circles:
      return "four circles";
    case Way::RandomCircles:
      return "random circles";
    case Way::Flat:
      return "flat";
  }
  return "";
}

struct Renderer::Parts {
  Parts(const TransducerArray& given, const TargetField& raster, int threads)
      : array(given),
        packed(given, medium),
        pool(threads),
        skin(raster),
        sigma(focus_width(packed, medium, raster.X_DP.translation(), -raster.X_DP.linear().col(2),
                          raster.X_DP.linear().col(0))
                  .sigma()) {}

  void play(const TargetField& target, Rendering& out);
  void score(const TargetField& target, Rendering& out) const;
  Rendering felt_am_rendering(const TargetField& target);

  Medium medium;
  TransducerArray array;
  PackedArray packed;
  WorkerPool pool;
  FeelingSkin skin;
  double sigma;  // width of a focus in the raster's middle [m]
  Random random{1};
};

/// Computes the field of the array on the skin, and the skin's response.
void Renderer::Parts::play(const TargetField& target, Rendering& out) {
  TargetFrame frame;
  frame.patches.push_back(target);
  const LoopSamples loop = plan_loop(out.plan, frame, {}, kRate);
  out.felt_at_all = is_felt(target, loop);
  if (!out.felt_at_all) return;
  LoopDriveResult drives;
  loop_drives(
      array, medium, loop, {}, [](int, int) { return true; }, drives);
  out.mean_power = drives.mean_power;
  out.field = physical_field(packed, medium, target, loop, drives, felt_parts(loop), pool);
  out.felt = skin.feel(target, loop.samples / loop.sample_rate, out.field.parts, out.field.part);
  out.field.part = {};  // megabytes that nothing else reads
}

void Renderer::Parts::score(const TargetField& target, Rendering& out) const {
  const PlanSettings paper;
  if (!out.plan.empty())
    out.of_model = score_plan(target, out.plan, 0, paper.sigma, paper.gain_law());
  out.of_envelope = score_physical(target, out.field.envelope, 0.0);
  out.of_felt = score_physical(target, out.felt.percept, 0.0);
  out.ghosts = ghosts_of(target, out.felt.percept);
}

/// Renders every number of foci, and keeps the rendering with the least (P25), without spill, of
/// its own percept.
Rendering Renderer::Parts::felt_am_rendering(const TargetField& target) {
  Rendering best;
  double least = std::numeric_limits<double>::infinity();
  for (int foci = 1; foci <= kMaxPaths; ++foci) {
    Rendering one;
    one.plan = am(felt_am(foci, sigma), target);
    play(target, one);
    if (!one.felt_at_all) return one;
    score(target, one);
    const double cost =
        1.0 - one.of_felt.skill_8 - PlanSettings().strength_weight * std::log(one.felt.largest);
    if (cost >= least) continue;
    least = cost;
    best = std::move(one);
  }
  return best;
}

Renderer::Renderer(const TransducerArray& array, const TargetField& raster, int threads)
    : parts_(std::make_unique<Parts>(array, raster, threads)) {}

Renderer::~Renderer() = default;

Rendering Renderer::render(Way way, const TargetField& target) {
  if (way == Way::AmFelt) return parts_->felt_am_rendering(target);
  Rendering out;
  out.plan = plan_by(way, target, parts_->sigma, parts_->random);
  if (way == Way::Flat) {
    constexpr int kParts = 25;
    out.field.envelope.assign(target.size(), 0.0);
    for (std::size_t c = 0; c < target.size(); ++c) {
      if (target.skin[c] != 0) out.field.envelope[c] = 1.0;
    }
    out.field.largest = 1.0;
    out.felt = parts_->skin.feel(target, 1.0 / kModulation, kParts, flat_loop(target, kParts));
  } else {
    parts_->play(target, out);
    if (!out.felt_at_all) return out;
  }
  parts_->score(target, out);
  return out;
}

}  // namespace prostm::methods
