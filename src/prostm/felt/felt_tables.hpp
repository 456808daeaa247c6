#pragma once
/// The skins that plans are fitted to, and their tables, computed on demand.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "prostm/acoustics/skin/skin_model.hpp"
#include "prostm/felt/felt_loss.hpp"
#include "prostm/felt/focus_response.hpp"

namespace prostm {

/// Number of skins that plans are fitted to.
inline constexpr std::size_t kFeltSkins = 3;
inline constexpr std::size_t kNominalSkin = 0;  ///< index of the nominal skin among them
/// Returns these skins: nominal, with 0.7 times, and with 1.3 times the nominal wave speed.
std::vector<SkinSettings> felt_skins();

/// Cache of the last few tables. Only construction allocates.
class FeltTables {
 public:
  FeltTables();

  /// Returns the tables of the first `skins` of felt_skins(), at most all, for a focus and a period
  /// [s]. They stay valid until the cache is filled with others. @param sigma σ of the focus [m],
  /// rounded to 0.2 mm.
  std::span<const FocusResponse<float>> of(double sigma, double period,
                                           std::size_t skins = kFeltSkins);

 private:
  struct Entry {
    double sigma = 0.0, period = 0.0;  // [m], [s]
    std::size_t made = 0;              // skins whose tables are made
    FeltSkins<float> skins;
  };
  Entry& entry_of(double sigma, double period);

  std::vector<SkinModel> models_;
  FocusResponseMaker maker_;
  std::array<Entry, 24> entries_;
  std::size_t oldest_ = 0;
};

}  // namespace prostm
