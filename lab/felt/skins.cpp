#include "felt/skins.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>

#include "prostm/acoustics/skin/bounded_skin.hpp"
#include "prostm/acoustics/skin/skin_percept.hpp"

namespace prostm::bench {
namespace {

/// A model of the skin that is prepared again only when the loop's period changes.
template <class Model>
class Prepared {
 public:
  explicit Prepared(Model model) : model_(std::move(model)) {}

  const SkinMotion& feel(const PressureLoop& loop) {
    if (loop.period != period_ || loop.samples != samples_) {
      model_.prepare(loop.period, loop.samples);
      period_ = loop.period;
      samples_ = loop.samples;
    }
    model_.respond(loop);
    return model_;
  }

 private:
  Model model_;
  double period_ = 0.0;
  int samples_ = 0;
};

template <class Model>
FeelLoop felt_by(Model model) {
  const auto prepared = std::make_shared<Prepared<Model>>(std::move(model));
  return [prepared](const PressureLoop& loop) -> const SkinMotion& { return prepared->feel(loop); };
}

SkinPatch patch_of(const TargetField& raster) {
  return {raster.rows, raster.cols, raster.cell};
}

Skin half_space(const std::string& name, const SkinSettings& settings) {
  return {name, [settings](const TargetField& raster) {
            return felt_by(SkinResponse(SkinModel(settings), patch_of(raster)));
          }};
}

Skin bounded() {
  return {"bounded", [](const TargetField& raster) {
            return felt_by(BoundedSkin(SkinModel(SkinSettings()), patch_of(raster), raster.skin));
          }};
}

std::vector<double> displacement(const SkinMotion& motion) {
  std::vector<double> out(motion.patch().size(), 0.0);
  for (int n = 1; n <= motion.harmonics(); ++n) {
    const auto field = motion.displacement(n);
    for (std::size_t c = 0; c < out.size(); ++c) out[c] += 0.5 * std::norm(field[c]);
  }
  for (double& value : out) value = std::sqrt(value);
  return out;
}

/// Returns the largest |w| of each cell, sampled eight times per period of the highest harmonic.
std::vector<double> peaks(const SkinMotion& motion) {
  const int harmonics = motion.harmonics(), times = fast_length(8 * harmonics);
  std::vector<std::complex<double>> spectrum(static_cast<std::size_t>(times)), course(spectrum);
  Eigen::FFT<double> fft;
  std::vector<double> out;
  for (std::size_t c = 0; c < motion.patch().size(); ++c) {
    std::fill(spectrum.begin(), spectrum.end(), 0.0);
    for (int n = 1; n <= harmonics; ++n)
      spectrum[static_cast<std::size_t>(n)] =
          static_cast<double>(times) * motion.displacement(n)[c];
    fft.inv(course.data(), spectrum.data(), times);
    double largest = 0.0;
    for (const auto& w : course) largest = std::max(largest, std::abs(w.real()));
    out.push_back(largest);
  }
  return out;
}

std::vector<double> whole_map(Readout readout, const SkinMotion& motion) {
  std::vector<double> out(motion.patch().size());
  switch (readout) {
    case Readout::Peak:
      return peaks(motion);
    case Readout::Displacement:
      return displacement(motion);
    case Readout::Velocity:
      rms_velocity(motion, out);
      return out;
    case Readout::Intensity:
    case Readout::Energy:
      break;
  }
  percept_map(motion, out);
  if (readout == Readout::Energy) {
    for (double& value : out) value *= value;
  }
  return out;
}

SkinSettings scaled(double factor) {
  SkinSettings settings;
  settings.slow_speed *= factor;
  settings.fast_speed *= factor;
  return settings;
}

SkinSettings with_plateau(double speed) {
  SkinSettings settings;
  settings.fast_speed = speed;
  return settings;
}

SkinSettings with_loss(double loss) {
  SkinSettings settings;
  settings.loss = loss;
  return settings;
}

}  // namespace

std::vector<Skin> skins() {
  return {half_space("nominal", SkinSettings()),
          half_space("speeds x 0.7", scaled(0.7)),
          half_space("speeds x 1.3", scaled(1.3)),
          half_space("plateau 5", with_plateau(kSkinFastSpeeds.front())),
          half_space("plateau 10", with_plateau(kSkinFastSpeeds.back())),
          half_space("loss .07", with_loss(kSkinLosses.front())),
          half_space("loss .21", with_loss(kSkinLosses.back())),
          bounded()};
}

std::vector<double> map_of(Readout readout, const SkinMotion& motion, const TargetField& raster) {
  std::vector<double> out = whole_map(readout, motion);
  for (std::size_t c = 0; c < out.size(); ++c) {
    if (raster.skin[c] == 0) out[c] = 0.0;
  }
  return out;
}

}  // namespace prostm::bench
