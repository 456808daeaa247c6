#include "planner/on_skin.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "planner/contenders.hpp"
#include "prostm/fields/skin_shapes.hpp"
#include "prostm/plan/lifted_plan.hpp"

namespace prostm::bench {
namespace {

constexpr double kTolerance = 0.5e-3;  // accepted excess over L [m]

/// The paths of one planner on one skin.
struct OnSkin {
  Distribution length;        // on the skin [mm]
  Distribution period_error;  // error of the stated period on the skin [%]
  Distribution planar_speed;  // on the skin, if laps took length / speed of the plane [m/s]
  int too_long = 0;

  void add(const Plan& plan, const TargetField& field, double max_length) {
    for (const FocalPath& path : plan.paths) {
      const double skin = skin_length(path, field);
      length.add(1e3 * skin);
      period_error.add(100.0 * std::abs(path.period * path.speed / skin - 1.0));
      planar_speed.add(skin / (path.length / path.speed));
      too_long += skin > max_length + kTolerance ? 1 : 0;
    }
  }
};

OnSkin plan_all(Contender& contender, fields::SkinShape shape, bool in_voxels, int frames) {
  OnSkin out;
  for (const fields::Pattern pattern : fields::kPatterns) {
    for (int i = 0; i < frames; ++i) {
      const int frame = i * fields::kFrames / frames;
      const TargetField field = fields::with_skin(fields::make(pattern, frame), shape, in_voxels);
      contender.begin(field.size());
      Plan plan;
      PlanStats stats;
      contender.plan(field, plan, stats);
      out.add(plan, field, contender.settings().max_length());
    }
  }
  return out;
}

void print_line(const std::string& skin, const Contender& contender, const OnSkin& on) {
  const Summary length = on.length.summary(), speed = on.planar_speed.summary();
  const double excess = length.max - 1e3 * contender.settings().max_length();
  fmt::print("{:<24} {:<12} {:>6} {:>9} {:>10.1f} {:>+10.1f} {:>12.2f} {:>9.2f} {:>9.2f}\n", skin,
             contender.name(), length.n, on.too_long, length.max, excess,
             on.period_error.summary().max, speed.p50, speed.max);
}

}  // namespace

void measure_on_skin(int frames, std::vector<Row>& rows) {
  fmt::print(
      "\nOn the skin, 9 fields of {} frames each\n{:<24} {:<12} {:>6} {:>9} {:>10} {:>10} {:>12} "
      "{:>9} {:>9}\n{:<37} {:>6} {:>9} {:>10} {:>10} {:>12} {:>19}\n",
      frames, "", "", "paths", "too long", "longest", "over L", "period off", "median", "fastest",
      "", "", "", "mm", "mm", "at most %", "m/s, planar period");
  for (const fields::SkinShape shape : fields::kSkinShapes) {
    for (const bool in_voxels : {false, true}) {
      const std::string skin = to_string(shape) + (in_voxels ? ", voxels" : "");
      for (Contender& contender : presets()) {
        if (contender.name() == "fast") continue;
        const OnSkin on = plan_all(contender, shape, in_voxels, frames);
        print_line(skin, contender, on);
        rows.push_back({fmt::format("planner/{}/length on {}", contender.name(), skin), "mm",
                        on.length.summary(), "", 0.0});
      }
    }
  }
}

}  // namespace prostm::bench
