#pragma once
/// The skins that plans are fitted to, and their tables, computed on demand.

#include <array>
#include <cstddef>
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
  /// @param skins number of skins, the first of felt_skins(), 1 to kFeltSkins.
  explicit FeltTables(std::size_t skins = kFeltSkins);

  /// Returns the tables of these skins for a focus and a period [s]. They stay valid until the
  /// cache is filled with others. @param sigma σ of the focus [m], rounded to 0.2 mm.
  const FeltSkins<float>& of(double sigma, double period);

 private:
  struct Entry {
    double sigma = 0.0, period = 0.0;  // [m], [s]
    FeltSkins<float> skins;
  };
  std::vector<SkinModel> models_;
  FocusResponseMaker maker_;
  std::array<Entry, 12> entries_;
  std::size_t oldest_ = 0;
};

}  // namespace prostm
