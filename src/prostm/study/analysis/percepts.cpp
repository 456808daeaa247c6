#include "prostm/study/analysis/percepts.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "prostm/acoustics/skin/bounded_skin.hpp"
#include "prostm/am/am_planner.hpp"
#include "prostm/core/random.hpp"
#include "prostm/core/units.hpp"
#include "prostm/pipeline/pipeline.hpp"
#include "prostm/pipeline/world_kinds.hpp"
#include "prostm/plan/planner.hpp"
#include "prostm/plan/quasi_static/quasi_static.hpp"
#include "prostm/psychophysics/observer.hpp"
#include "prostm/score/felt.hpp"
#include "prostm/score/plan_percept.hpp"

namespace prostm {
namespace {

// places of the hand about its palm joint, in steps of kTouchResolution: 120 mm wide, 187 mm long
constexpr int kSideways = 7, kTowardsWrist = 8, kTowardsTips = 14;
constexpr double kSettle = 4.0;  // [s]
constexpr double kApart = 0.3;   // time between moments [s]

/// A study hand with a rigid tremor: along each axis, two sines of random frequency and phase.
class TremblingHand final : public HandSource {
 public:
  TremblingHand(const StudyHandSettings& settings, const ModelHand& hand)
      : held_(make_study_hand(settings)) {
    Random random(hand.seed);
    for (Sine& sine : sines_) {
      const double omega = 2.0 * kPi * random.uniform(8.0, 12.0);
      sine = {omega, random.uniform(0.0, 2.0 * kPi), hand.tremor / std::sqrt(kSines / 2.0)};
    }
  }

  void sample(double time, HandFrame& out) override {
    held_->sample(time, out);
    Vec3 shift = Vec3::Zero(), velocity = Vec3::Zero();
    for (std::size_t i = 0; i < sines_.size(); ++i) {
      const auto& [omega, phase, speed] = sines_[i];
      const auto axis = static_cast<Eigen::Index>(i % 3);
      shift[axis] += speed / omega * std::sin(omega * time + phase);
      velocity[axis] += speed * std::cos(omega * time + phase);
    }
    for (Hand& hand : out.hands) {
      for (Vec3& position : hand.position) position += shift;
      for (Vec3& v : hand.velocity) v += velocity;
    }
  }

 private:
  static constexpr std::size_t kSines = 6;
  struct Sine {
    double omega, phase, speed;
  };
  std::unique_ptr<HandSource> held_;
  std::array<Sine, kSines> sines_;
};

Pose palm_joint(const Hand& hand) {
  Pose X_DH = Pose::Identity();
  X_DH.linear() = hand.orientation[kPalm].toRotationMatrix();
  X_DH.translation() = hand.position[kPalm];
  return X_DH;
}

std::size_t places() {
  return static_cast<std::size_t>((2 * kSideways + 1) * (kTowardsWrist + kTowardsTips + 1));
}

/// HandPlaces as a map of its own.
constexpr SkinPatch kPlaces{kTowardsWrist + kTowardsTips + 1, 2 * kSideways + 1, kTouchResolution};

ModelPercept model_percept(PerceptModel model, const Vibration& vibration, const HandPlaces& hand) {
  const PerceptEnergy energy = percept_energy(model, vibration);
  ModelPercept out;
  out.places = hand.of(strength_map(model, energy));
  out.strength = strength_of(model, vibration.patch, energy);
  FeltStimulus felt;
  felt.patch = kPlaces;
  felt.map = out.places;
  out.dip = deepest_dip(felt);
  return out;
}

/// Returns the response of the nominal skin to a loop.
std::shared_ptr<const SkinMotion> respond(const TargetField& raster, const PressureLoop& loop,
                                          SkinEdges edges) {
  const SkinModel model{SkinSettings{}};
  const SkinPatch patch{raster.rows, raster.cols, raster.cell};
  const auto responding = [&](auto skin) -> std::shared_ptr<const SkinMotion> {
    skin->prepare(loop.period, loop.samples);
    skin->respond(loop);
    return skin;
  };
  if (edges == SkinEdges::None) return responding(std::make_shared<SkinResponse>(model, patch));
  return responding(std::make_shared<BoundedSkin>(model, patch, raster.skin));
}

/// Returns a palm joint displaced in the hand's own plane.
Pose displaced(const Pose& X_DH, const SceneVariation& variation, Random& random) {
  Pose shift = Pose::Identity();
  shift.translation() =
      Vec3(variation.place * random.normal(), 0.0, variation.place * random.normal());
  shift.rotate(Eigen::AngleAxisd(variation.turn * random.normal(), Vec3::UnitY()));
  return X_DH * shift;
}

/// Modulates every second focus half a period late.
void oppose(Plan& plan) {
  for (std::size_t i = 1; i < plan.foci.size(); i += 2) plan.foci[i].phase = 0.5;
}

bool is_silent(const LoopSamples& loop) {
  return std::ranges::all_of(loop.sample,
                             [](const FocusSample& sample) { return sample.intensity == 0.0F; });
}

}  // namespace

HandPlaces::HandPlaces(const TargetField& raster, const Pose& X_DH) {
  for (std::size_t c = 0; c < raster.size(); ++c)
    if (raster.skin[c] != 0) skin_.push_back(c);
  const double s2 = kTouchResolution * kTouchResolution;
  const double scale = raster.cell * raster.cell / (2.0 * kPi * s2);
  const Pose X_PH = raster.X_DP.inverse() * X_DH;
  for (int j = -kTowardsWrist; j <= kTowardsTips; ++j) {
    for (int i = -kSideways; i <= kSideways; ++i) {
      const Vec2 place = (X_PH * (kTouchResolution * Vec3(i, 0, -j))).head<2>();
      for (const std::size_t c : skin_)
        weight_.push_back(scale *
                          std::exp(-(raster.position(c) - place).squaredNorm() / (2.0 * s2)));
    }
  }
}

Percept HandPlaces::of(std::span<const double> map) const {
  Percept out(places());
  for (std::size_t place = 0; place < out.size(); ++place) {
    for (std::size_t k = 0; k < skin_.size(); ++k)
      out[place] += weight_[place * skin_.size() + k] * map[skin_[k]];
  }
  return out;
}

StimulusFeeler::StimulusFeeler(const PipelineSettings& settings, double full_scale, double sound,
                               SkinEdges edges)
    : settings_(settings),
      emit_(emit_settings(settings, full_scale)),
      sound_(sound),
      edges_(edges),
      packed_(settings.transducers, air_),
      pool_(settings.threads) {}

StimulusPercept StimulusFeeler::feel(const Plan& plan, const TargetFrame& target,
                                     const Pose& X_DH) {
  StimulusPercept out{Percept(places()), Percept(places()), 0.0};
  for (ModelPercept& of : out.by_model) of.places.resize(places());
  if (plan.empty()) return out;
  const TargetField& raster = target.patches.front();
  std::vector<double> field(raster.size());
  quasi_static_field(plan, 0, raster, plan.foci.empty() ? settings_.plan.sigma : settings_.am.sigma,
                     settings_.plan.gain_law(), field);
  const HandPlaces hand(raster, X_DH);
  out.field = hand.of(field);
  const LoopSamples loop = plan_loop(plan, target, emit_, settings_.emission_rate());
  if (is_silent(loop)) return out;
  const LoopDriveSettings drive{.focus = {}, .transducer = {}, .full_scale_pa = sound_};
  const auto go_on = [](int, int) { return true; };
  LoopDriveResult drives;
  loop_drives(settings_.transducers, air_, loop, drive, go_on, drives);
  const std::vector<double> pressure = raster_pressure(packed_, air_, raster, loop, drives, pool_);
  const PressureLoop pressed{loop.samples / loop.sample_rate, felt_parts(loop), pressure};
  const std::shared_ptr<const SkinMotion> motion = respond(raster, pressed, edges_);
  const FeltField felt = felt_field(raster, *motion);
  out.skin = hand.of(felt.percept);
  out.strength = felt.intensity;
  const Vibration vibration = vibration_of(*motion, pressed);
  for (std::size_t m = 0; m < kPerceptModels; ++m)
    out.by_model[m] = model_percept(static_cast<PerceptModel>(m), vibration, hand);
  return out;
}

ModelHand random_hand(std::uint64_t seed) {
  Random random(seed);
  ModelHand hand;
  hand.size = std::clamp(1.0 + 0.06 * random.normal(), 0.85, 1.15);
  hand.tremor = random.uniform(0.015, 0.04);
  hand.seed = random.bits();
  return hand;
}

ScenePercepts feel_scene(PipelineSettings settings, const std::string& scene, const ModelHand& hand,
                         double sound, int moments, const SceneVariation& variation,
                         const std::function<bool()>& progress) {
  settings.scene = scene;
  settings.study_hand.size = hand.size;
  settings.jets.place = JetPlace::Hand;
  const double full_scale = scene_named(scene, world_named(settings.world)).full_scale_pressure;
  WorldStage world(settings, std::make_unique<TremblingHand>(settings.study_hand, hand));
  StimulusFeeler feeler(settings, full_scale, sound, variation.edges);
  settings.emit.full_scale_pressure = emit_settings(settings, full_scale).full_scale_pressure;
  Planner planner(plan_settings(settings, settings.emission_rate()), world.max_cells());
  AmPlanner am(am_settings(settings, settings.emission_rate()), world.max_cells());
  ScenePercepts out;
  const double dt = 1.0 / settings.world_rate;
  const auto apart = static_cast<std::int64_t>(std::lround(kApart * settings.world_rate));
  WorldFrame frame;
  Plan plan;
  PlanStats stats;
  Random random(hand.seed + 1);
  for (std::int64_t step = 1; std::ssize(out.am) < moments; ++step) {
    const double time = static_cast<double>(step) * dt;
    world.run(step, time, dt, frame);
    if (time < kSettle || step % apart != 0 || frame.hands.hands.empty()) continue;
    const Pose X_DH = displaced(palm_joint(frame.hands.hands.front()), variation, random);
    am.plan(frame.target, plan, stats);
    if (variation.opposed_foci) oppose(plan);
    out.am.push_back(feeler.feel(plan, frame.target, X_DH));
    planner.plan(frame.target, plan, stats);
    out.pro_stm.push_back(feeler.feel(plan, frame.target, X_DH));
    if (!progress()) break;
  }
  return out;
}

}  // namespace prostm
