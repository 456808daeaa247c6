#pragma once
/// Percepts of scenes rendered by a method on a participant's hand, for the model observers of
/// docs/design/study.md (Y2) to (Y6).

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "prostm/acoustics/field/propagation_kernels.hpp"
#include "prostm/core/medium.hpp"
#include "prostm/core/worker_pool.hpp"
#include "prostm/pipeline/settings.hpp"
#include "prostm/plan/plan.hpp"
#include "prostm/psychophysics/percept_model.hpp"
#include "prostm/psychophysics/places.hpp"
#include "prostm/psychophysics/template_observer.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm {

/// Acoustic pressure of a focal point at intensity 1 in the simulated study [Pa, rms].
inline constexpr double kStudySound = 450.0;
/// Noise of each place. It is set so that two AM focal points 45 mm apart are distinguished from
/// two 15 mm apart, which feel like one, as well as people do: d′ = 2.64 [Y-5]. A test checks this.
inline constexpr double kTouchNoise = 1.18;
/// Share of trials in which an observer guesses [Y-3].
inline constexpr double kObserverLapse = 0.03;

/// A moment of a stimulus as one percept model feels it.
struct ModelPercept {
  Percept places;         ///< strength at places of the hand [m, or Pa]
  double strength = 0.0;  ///< (X7) [m, or Pa]
  double dip = 0.0;       ///< deepest_dip() of the places
};

/// The percept of one moment of a stimulus.
struct StimulusPercept {
  Percept skin;           ///< √e of (S7) at places of the hand [m]
  Percept field;          ///< pressure of Eq. (1) at the same places [Pa]
  double strength = 0.0;  ///< √E of (S8) [m]
  std::array<ModelPercept, kPerceptModels> by_model = {};
};

/// Places of a hand on a raster: a grid of spacing kTouchResolution over palm and fingers.
class HandPlaces {
 public:
  /// @param X_DH palm joint: −z to the fingertips, +y dorsal.
  HandPlaces(const TargetField& raster, const Pose& X_DH);

  /// Samples a map at the places, smoothed by a Gaussian of kTouchResolution. @param map rows·cols
  Percept of(std::span<const double> map) const;

 private:
  std::vector<std::size_t> skin_;  // cells with skin
  std::vector<double> weight_;     // places × these cells
};

/// How the skin of a hand ends.
enum class SkinEdges : std::uint8_t { None, Reflecting };

/// Computes percepts of plans played on the array of the settings.
class StimulusFeeler {
 public:
  /// @param full_scale full scale of the scene, as for emit_settings() [Pa]. @param sound acoustic
  /// pressure of a focal point at intensity 1 [Pa, rms]. @param edges Reflecting: the skin ends at
  /// the outline of the hand, (S14) to (S17); some seconds for a plan of long loops.
  StimulusFeeler(const PipelineSettings& settings, double full_scale, double sound,
                 SkinEdges edges = SkinEdges::None);

  /// @param X_DH as for HandPlaces. All zeros for a plan without pressure.
  StimulusPercept feel(const Plan& plan, const TargetFrame& target, const Pose& X_DH);

 private:
  PipelineSettings settings_;
  EmitSettings emit_;
  double sound_;
  SkinEdges edges_;
  Medium air_;
  PackedArray packed_;
  WorkerPool pool_;
};

/// The hand of a simulated participant: `--hand study` with a size, and a tremor of 8 to 12 Hz.
struct ModelHand {
  double size = 1.0;
  double tremor = 0.025;   ///< rms of its speed [m/s]
  std::uint64_t seed = 1;  ///< of the tremor's frequencies and phases
};
/// A hand of random size and tremor, (Y6).
ModelHand random_hand(std::uint64_t seed);

/// Differences from the usual simulation of a scene, to test explanations of a study's result.
struct SceneVariation {
  /// Standard deviations of the hand's place along each axis of its plane [m] and of its direction
  /// [rad], drawn for each moment. The jets stay, and so does the pressure on the skin: only the
  /// places of the hand move under it.
  double place = 0.0, turn = 0.0;
  bool opposed_foci = false;  ///< whether every second focus of AM is modulated half a period late
  SkinEdges edges = SkinEdges::None;
};

/// Percepts of one scene with each method, moment by moment.
struct ScenePercepts {
  std::vector<StimulusPercept> am, pro_stm;
};
/// Simulates a scene on a hand, not in real time, until it has settled, and then computes percepts
/// of `moments` moments with both methods. @param settings scene, hand and position of the jets are
/// replaced.
/// @param sound acoustic pressure of a focal point at intensity 1 [Pa, rms]. @param progress called
/// after each moment; returns false to stop.
ScenePercepts feel_scene(PipelineSettings settings, const std::string& scene, const ModelHand& hand,
                         double sound, int moments, const SceneVariation& variation,
                         const std::function<bool()>& progress);

}  // namespace prostm
