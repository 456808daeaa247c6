#pragma once
/// Judges plans by the array's own field, and by its percept on several skins.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "felt/disturbances.hpp"
#include "felt/field_sets.hpp"
#include "felt/played.hpp"
#include "felt/skins.hpp"
#include "felt/ways.hpp"
#include "prostm/psychophysics/percept_model.hpp"
#include "prostm/score/score.hpp"

namespace prostm::bench {

/// The scores of one plan on one field.
struct Judged {
  Metrics felt;                                    ///< of the map √e on the first skin
  Metrics envelope;                                ///< of the largest pressure over the loop
  double intensity = 0.0;                          ///< √E on the first skin [m]
  double strongest = 0.0;                          ///< largest √e on the first skin [m]
  std::array<double, kReadouts.size()> readout{};  ///< S_8.5 of each
  std::vector<double> skin;                        ///< S_8.5 of √e on each skin
  std::vector<double> disturbed;  ///< the same under each disturbance; empty for a control
  int ghosts = 0, crossings = 0, long_paths = 0;
  /// By each percept model on the first skin: S_8.5 of its map, and its strength in its unit.
  std::array<double, kPerceptModels> model_skill{}, model_strength{};
  std::vector<double> percept;  ///< the map √e [m]
};

/// Judges plans on fields that share one raster. Serves one thread.
class Judge {
 public:
  /// @param raster rows, columns, cells and skin of all targets to come. @pre `skins` is not empty.
  Judge(const TransducerArray& array, const TargetField& raster, const std::vector<Skin>& skins,
        const std::vector<Disturbed>& disturbances);

  /// @param seed of random disturbances. @param is_control whether to skip disturbances.
  /// @throws InputError as Player::play() does.
  Judged judge(const Plan& plan, const TargetField& target, std::uint64_t seed,
               bool is_control = false);

 private:
  /// @param drives of the judged plan.
  double mean_skill(const std::vector<Play>& plays, const TargetField& target,
                    const LoopDriveResult& drives);

  Player player_;
  std::vector<FeelLoop> feel_;
  std::vector<Disturbed> disturbances_;
};

/// The results of every way on every field of a set: [way][field].
using Results = std::vector<std::vector<Judged>>;

class Kept;

/// Judges all ways on all fields, several fields at once. @param threads ≥ 1. @param kept cache of
/// earlier judgements; new ones are added and written. @throws InputError as Judge::judge() does,
/// with the names of the field and the way.
Results judge_all(const TransducerArray& array, const std::vector<NamedField>& fields,
                  const std::vector<Way>& ways, const std::vector<Skin>& skins,
                  const std::vector<Disturbed>& disturbances, int threads, Kept& kept);

}  // namespace prostm::bench
