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

FeltTables::FeltTables() {
  for (const SkinSettings& skin : felt_skins()) models_.emplace_back(skin);
  for (Entry& entry : entries_) entry.skins.resize(kFeltSkins);
}

/// Returns the entry of a focus and a period, which replaces the oldest unless it exists.
FeltTables::Entry& FeltTables::entry_of(double sigma, double period) {
  for (Entry& entry : entries_)
    if (entry.sigma == sigma && entry.period == period) return entry;
  Entry& entry = entries_[oldest_];
  oldest_ = (oldest_ + 1) % entries_.size();
  entry.sigma = sigma;
  entry.period = period;
  entry.made = 0;
  return entry;
}

std::span<const FocusResponse<float>> FeltTables::of(double sigma, double period,
                                                     std::size_t skins) {
  const double rounded = kSigmaStep * std::max(1.0, std::round(sigma / kSigmaStep));
  Entry& entry = entry_of(rounded, period);
  for (; entry.made < skins; ++entry.made)
    maker_.make(models_[entry.made], rounded, period, entry.skins[entry.made]);
  return std::span(entry.skins).first(skins);
}

}  // namespace prostm
