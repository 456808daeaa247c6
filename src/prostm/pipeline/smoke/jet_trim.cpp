#include "prostm/pipeline/smoke/jet_trim.hpp"

#include <algorithm>
#include <cmath>

namespace prostm {
namespace {

template <class Settings, class Visitor>
void list(Settings& s, Visitor& v) {
  v.field(
      {.name = "place", .help = "position of the jets: over the array, or under the first palm"},
      s.place);
  v.field({"trim_rate", "1/s", 0, 5, "rate at which the pressures of jets are equalised; 0: off"},
          s.trim_rate);
  v.field({"trim_limit", "", 0, 0.9, "largest distance of a jet's gain from 1"}, s.trim_limit);
}

/// Index of the jet nearest to a point in x and y.
std::size_t nearest(std::span<const SmokeJet> jets, const Vec2& p) {
  std::size_t best = 0;
  for (std::size_t q = 1; q < jets.size(); ++q) {
    if ((jets[q].centre - p).squaredNorm() < (jets[best].centre - p).squaredNorm()) best = q;
  }
  return best;
}

}  // namespace

void JetSettings::visit(SettingsReader& v) const {
  list(*this, v);
}
void JetSettings::visit(SettingsWriter& v) {
  list(*this, v);
}

JetTrim::JetTrim(const JetSettings& settings, std::size_t jets)
    : settings_(settings), gains_(jets, 1.0), pressed_(jets) {
  require_bounds(settings);
}

bool JetTrim::update(const TargetFrame& target, std::span<const SmokeJet> jets,
                     double dt) noexcept {
  if (settings_.trim_rate == 0.0 || jets.size() < 2) return false;
  std::fill(pressed_.begin(), pressed_.end(), 0.0);
  for (const TargetField& patch : target.patches) {
    for (std::size_t cell = 0; cell < patch.size(); ++cell) {
      if (patch.pressure[cell] <= 0.0) continue;
      const Vec2 x = patch.position(cell);
      const Vec3 p_D = patch.X_DP * Vec3(x.x(), x.y(), patch.height[cell]);
      double& most = pressed_[nearest(jets, p_D.head<2>())];
      most = std::max(most, patch.pressure[cell]);
    }
  }
  double mean = 0.0, squares = 0.0;
  for (const double p : pressed_) {
    if (p <= 0.0) return false;
    mean += p / static_cast<double>(jets.size());
  }
  for (std::size_t q = 0; q < gains_.size(); ++q) {
    const double gain =
        gains_[q] * std::exp(settings_.trim_rate * dt * (mean - pressed_[q]) / mean);
    gains_[q] = std::clamp(gain, 1.0 - settings_.trim_limit, 1.0 + settings_.trim_limit);
    squares += gains_[q] * gains_[q];
  }
  const double scale = std::sqrt(static_cast<double>(gains_.size()) / squares);
  for (double& gain : gains_) gain *= scale;
  return true;
}

}  // namespace prostm
