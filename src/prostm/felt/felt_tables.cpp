#include "prostm/felt/felt_tables.hpp"

#include <algorithm>
#include <cmath>

namespace prostm {
namespace {

constexpr std::array<double, kFeltSkins> kSpeeds = {1.0, 0.7, 1.3};  // relative to the nominal ones
constexpr double kSigmaStep = 0.2e-3;                                // [m]

}  // namespace

std::vector<SkinSettings> felt_skins() {
  std::vector<SkinSettings> skins;
  for (const double speed : kSpeeds) {
    SkinSettings& skin = skins.emplace_back();
    skin.slow_speed *= speed;
    skin.fast_speed *= speed;
  }
  return skins;
}

FeltTables::FeltTables(std::size_t skins) {
  const std::vector<SkinSettings> settings = felt_skins();
  for (std::size_t s = 0; s < skins; ++s) models_.emplace_back(settings[s]);
  for (Entry& entry : entries_) entry.skins.resize(skins);
}

const FeltSkins<float>& FeltTables::of(double sigma, double period) {
  const double rounded = kSigmaStep * std::max(1.0, std::round(sigma / kSigmaStep));
  for (const Entry& entry : entries_) {
    if (entry.sigma == rounded && entry.period == period) return entry.skins;
  }
  Entry& made = entries_[oldest_];
  oldest_ = (oldest_ + 1) % entries_.size();
  made.sigma = rounded;
  made.period = period;
  for (std::size_t s = 0; s < models_.size(); ++s)
    maker_.make(models_[s], rounded, period, made.skins[s]);
  return made.skins;
}

}  // namespace prostm
