#include "plumes/plumes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "plumes/held_hand.hpp"
#include "prostm/device/simulated/simulated_array.hpp"
#include "prostm/pipeline/pipeline.hpp"

namespace prostm::bench {
namespace {

constexpr double kSettle = 5.0;  // [s]

std::unique_ptr<HandSource> study(double size, Side side = Side::Right) {
  return make_study_hand({.size = size, .side = side});
}

HeldCase held_study(const std::string& name, const Hold& hold) {
  return {name, [hold](const PipelineSettings&) { return make_still_hand(*study(1.0), hold); },
          JetPlace::Array};
}

/// [N]
double force_around(const Vec2& axis, const TargetFrame& target) {
  constexpr double kAround = 0.030;  // [m]
  double force = 0.0;
  for (const TargetField& patch : target.patches) {
    for (std::size_t cell = 0; cell < patch.size(); ++cell) {
      const Vec2 x = patch.position(cell);
      const Vec3 p_D = patch.X_DP * Vec3(x.x(), x.y(), patch.height[cell]);
      if (patch.skin[cell] == 0 || (p_D.head<2>() - axis).norm() > kAround) continue;
      force += patch.cell * patch.cell * patch.pressure[cell];
    }
  }
  return force;
}

Summary over_frames(const std::vector<FieldShape>& frames, const Quantity<FieldShape>& quantity) {
  Distribution out;
  for (const FieldShape& frame : frames) out.add(quantity.scale * value_of(quantity, frame));
  return out.summary();
}

}  // namespace

std::vector<HeldCase> held_cases(const std::string& folder, double tremor_above) {
  std::vector<HeldCase> cases;
  for (const double size : {0.9, 1.0, 1.1}) {
    cases.push_back({fmt::format("study hand {:.1f}", size),
                     [size](const PipelineSettings&) { return study(size); }});
  }
  cases.push_back(
      {"study hand, left", [](const PipelineSettings&) { return study(1.0, Side::Left); }});
  cases.push_back(held_study("10 mm to the right", {.x = 0.010}));
  cases.push_back(held_study("10 mm towards the user", {.y = -0.010}));
  for (const double skin : {0.14, 0.17, 0.24})
    cases.push_back(held_study(fmt::format("skin at {:.2f} m", skin), {.height = skin + 0.015}));
  cases.push_back({"scripted hand, open, still",
                   [](const PipelineSettings& s) {
                     ScriptedHandSettings still = s.scripted_hand;
                     still.still = true;
                     return make_scripted_hand(still, s.track);
                   },
                   JetPlace::Array});
  cases.push_back(
      {"scripted hand, moving",
       [](const PipelineSettings& s) { return make_scripted_hand(s.scripted_hand, s.track); },
       JetPlace::Array});
  cases.push_back({"finger over a jet",
                   [](const PipelineSettings& s) {
                     const Vec2 jet = scene_from_name(s.scene).smoke.jets.front().centre;
                     return make_finger(jet.x(), jet.y(), 0.2);
                   },
                   JetPlace::Array, true});
  if (folder.empty()) return cases;
  for (const char* name :
       {"flat-closed", "HandSplay-110fps", "rollAndPitchWithEntry", "flapping"}) {
    const std::string path = folder + "/" + name + ".hands.jsonl";
    cases.push_back({std::string(name) + ", held", [path, tremor_above](const PipelineSettings&) {
                       return make_held_hand(path, {.tremor_above = tremor_above});
                     }});
  }
  return cases;
}

Measured measure_plumes(const HeldCase& held, const PipelineSettings& base, double dt, int frames) {
  PipelineSettings settings = base;
  settings.world_rate = 1.0 / dt;
  settings.world_steps_per_plan = 1;
  settings.jets.place = held.place;
  settings.devices.of<SimulatedArraySettings>().realtime = false;
  WorldStage stage(settings, held.make(settings));
  StimulusGate gate(static_cast<int>(std::lround(1.0 / dt)), stage.max_cells());
  WorldFrame frame;
  Measured out;
  const auto settle = std::llround(kSettle / dt);
  for (std::int64_t step = 1; step <= settle + frames; ++step) {
    stage.run(step, static_cast<double>(step) * dt, dt, frame);
    const GateResult result = gate.judge(frame.hands, frame.target, *frame.stimulus);
    if (step <= settle) continue;
    out.size = frame.stimulus->place.size;
    out.frames.push_back(result.shape);
    if (held.has_pad) {
      const Vec2 jet = scene_from_name(settings.scene).smoke.jets.front().centre;
      out.pad.add(1e3 * force_around(jet, frame.target));
    }
    out.pass += result.pass ? 1.0 / frames : 0.0;
    out.says = sentence(result);
  }
  return out;
}

void add_rows(const std::string& name, const Measured& m, int maxima, std::vector<Row>& rows) {
  const auto add_share = [&](const char* what, const auto& test) {
    const auto good = std::count_if(m.frames.begin(), m.frames.end(), test);
    Distribution share(1);
    share.add(100.0 * static_cast<double>(good) / static_cast<double>(m.frames.size()));
    rows.push_back({name + ", " + what, "%", share.summary(), "", 0.0});
  };
  add_share("frames with its maxima", [&](const FieldShape& s) {
    return s.count() == maxima && s.balance >= GateBounds::kBalance;
  });
  add_share("frames with deep saddles",
            [](const FieldShape& s) { return s.saddle <= GateBounds::kSaddle; });
  if (m.pad.count() > 0)
    rows.push_back({name + ", force on the pad", "mN", m.pad.summary(), "", 0.0});
  for (const Quantity<FieldShape>& q : quantities<FieldShape>())
    rows.push_back({name + ", " + q.name, q.unit, over_frames(m.frames, q), "", 0.0});
}

}  // namespace prostm::bench
