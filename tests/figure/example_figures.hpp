#pragma once
/// Generated inputs of the two figures.

#include <algorithm>
#include <cmath>

#include "prostm/core/random.hpp"
#include "prostm/figure/figures.hpp"
#include "prostm/plan/quasi_static/quasi_static.hpp"

namespace prostm::test {

/// Returns a palm with four fingers and a thumb under two jets, in 5 mm cells.
inline TargetField hand_field() {
  TargetField field;
  field.resize(40, 28);
  field.cell = 5e-3;
  field.origin = Vec2(-0.07, -0.09);
  const auto capsule = [](const Vec2& x, const Vec2& a, const Vec2& b) {
    const double t = std::clamp((x - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    return (x - a - t * (b - a)).norm();
  };
  for (int row = 0; row < field.rows; ++row) {
    for (int col = 0; col < field.cols; ++col) {
      const Vec2 x = field.position(row, col);
      bool skin = capsule(x, Vec2(-0.005, -0.04), Vec2(0.005, -0.03)) < 0.048;
      for (int finger = 0; finger < 4; ++finger) {
        const double side = -0.036 + 0.024 * finger;
        const double tip = 0.085 - 0.012 * std::abs(finger - 1.4);
        skin |= capsule(x, Vec2(side, 0.0), Vec2(1.35 * side, tip)) < 0.011;
      }
      skin |= capsule(x, Vec2(0.035, -0.05), Vec2(0.068, -0.005)) < 0.013;
      if (!skin) continue;
      const auto jet = [&](const Vec2& centre, double width) {
        return std::exp(-(x - centre).squaredNorm() / (2.0 * width * width));
      };
      const std::size_t i = field.index(row, col);
      field.skin[i] = 1;
      field.pressure[i] =
          40.0 * jet(Vec2(-0.02, -0.03), 0.022) + 28.0 * jet(Vec2(0.012, 0.045), 0.017);
      field.height[i] = 0.3 * x.squaredNorm();
    }
  }
  fill_heights(field);
  return field;
}

/// A plan from the planner, with its trace and its rendered field.
struct PlannedExample {
  TargetField target = hand_field();
  Plan plan;
  PlanTrace trace;
  PlanFigure figure;

  explicit PlannedExample(TargetField field = hand_field(),
                          const std::string& preset = "paper-valid")
      : target(std::move(field)) {
    PlanSettings settings;
    settings.preset = from_name<Preset>(preset, "preset");
    Planner planner(settings, target.size());
    PlanStats stats;
    planner.plan(target, plan, stats, &trace);
    figure.target = &target;
    figure.plan = &plan;
    figure.trace = &trace;
    figure.reconstruction.resize(target.size());
    quasi_static_field(plan, 0, target, settings.sigma, settings.gain_law(), figure.reconstruction);
    figure.metrics = score_plan(target, plan, 0, settings.sigma, settings.gain_law());
    figure.controls =
        controls(target, settings.sigma, settings.gain_law(), settings.max_length(), nullptr, 1);
    figure.title = "PRO-STM: from a target pressure to four closed paths";
  }
  PlannedExample(const PlannedExample&) = delete;
  PlannedExample& operator=(const PlannedExample&) = delete;
};

/// Returns a scene of a hand above a plume, with the fields of `patches` hands.
inline SceneFigure scene_example(const PlannedExample& planned, int patches) {
  SceneFigure scene;
  scene.nx = scene.nz = 64;
  scene.cell = 0.36 / 64;
  scene.origin = Vec2(-0.18 + 0.5 * scene.cell, 0.5 * scene.cell);
  for (int k = 0; k < scene.nz; ++k) {
    for (int i = 0; i < scene.nx; ++i) {
      const Vec2 x = scene.origin + scene.cell * Vec2(i, k);
      const double width = 0.012 + 0.12 * std::max(0.0, x.y() - 0.16) + 0.05 * x.y();
      const double plume =
          std::exp(-0.5 * std::pow((x.x() - 0.01 * std::sin(40.0 * x.y())) / width, 2));
      scene.smoke.push_back(static_cast<float>(x.y() < 0.21 ? plume : 0.3 * plume));
      const bool palm =
          std::abs(x.x()) < 0.09 && std::abs(x.y() - 0.205 - 0.3 * x.x() * x.x()) < 0.013;
      scene.hand.push_back(palm ? 1 : 0);
    }
  }
  for (int i = 0; i < 16; ++i) scene.array.push_back(Vec2(0.0105 * (i - 7.5), 0.0));
  for (const FocalPath& path : planned.plan.paths) {
    for (const Vec2& x : path.points) {
      scene.foci.push_back(planned.target.X_DP * Vec3(x.x(), x.y(), height_at(planned.target, x)));
    }
  }
  scene.plan = planned.plan;
  for (int p = 0; p < patches; ++p) {
    scene.targets.push_back(planned.target);
    scene.reconstructions.push_back(planned.figure.reconstruction);
  }
  scene.title = "A hand in a plume of smoke, felt through four focal points";
  return scene;
}

}  // namespace prostm::test
