#include "felt/judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <list>

#include "felt/kept.hpp"
#include "prostm/acoustics/skin/skin_percept.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/plan/detail/validity.hpp"
#include "prostm/plan/lifted_plan.hpp"
#include "prostm/plan/plan_settings.hpp"
#include "prostm/score/felt.hpp"
#include "prostm/score/physical.hpp"

namespace prostm::bench {
namespace {

double skill_of(const TargetField& target, const std::vector<double>& map) {
  return score_physical(target, map, 0.0).skill_8;
}

int crossings_of(const Plan& plan) {
  int count = 0;
  std::vector<std::vector<Vec2>> loops;
  for (const FocalPath& path : plan.paths) {
    std::vector<Vec2>& loop = loops.emplace_back();
    for (const Vec2& x : path.points) loop.push_back(1e3 * x);
    count += planning::count_self_crossings(loop);
    for (std::size_t k = 0; k + 1 < loops.size(); ++k)
      count += planning::count_crossings(loops[k], loop);
  }
  return count;
}

int long_paths_of(const Plan& plan, const TargetField& target) {
  constexpr double kTolerance = 0.5e-3;  // [m]
  int count = 0;
  for (const FocalPath& path : plan.paths)
    count += skin_length(path, target) > PlanSettings().max_length() + kTolerance ? 1 : 0;
  return count;
}

/// One thread's judges, one for each raster, so that results for a raster are reused.
class Judges {
 public:
  Judges(const TransducerArray& array, const std::vector<Skin>& skins,
         const std::vector<Disturbed>& disturbances)
      : array_(array), skins_(skins), disturbances_(disturbances) {}

  Judge& on(const TargetField& raster) {
    const auto same = [&](const OnRaster& one) {
      return one.rows == raster.rows && one.cols == raster.cols && one.cell == raster.cell &&
             one.skin == raster.skin;
    };
    const auto found = std::find_if(all_.begin(), all_.end(), same);
    if (found != all_.end()) return found->judge;
    all_.push_back({raster.rows, raster.cols, raster.cell, raster.skin,
                    Judge(array_, raster, skins_, disturbances_)});
    return all_.back().judge;
  }

 private:
  struct OnRaster {
    int rows, cols;
    double cell;
    std::vector<std::uint8_t> skin;
    Judge judge;
  };
  const TransducerArray& array_;
  const std::vector<Skin>& skins_;
  const std::vector<Disturbed>& disturbances_;
  std::list<OnRaster> all_;
};

/// Names of the skins and disturbances that a judgement depends on.
std::vector<std::string> names_of(const std::vector<Skin>& skins,
                                  const std::vector<Disturbed>& disturbances, bool is_control) {
  std::vector<std::string> out;
  for (const Skin& skin : skins) out.push_back(skin.name);
  out.emplace_back();
  if (is_control) return out;
  for (const Disturbed& disturbed : disturbances) out.push_back(disturbed.name);
  return out;
}

/// Judges one field in every way. @param seed of its random disturbances.
std::vector<Judged> judge_field(Judges& judges, const NamedField& field,
                                const std::vector<Way>& ways, const std::vector<Skin>& skins,
                                const std::vector<Disturbed>& disturbances, std::uint64_t seed,
                                Kept& kept) {
  std::vector<Judged> out;
  for (const Way& way : ways) {
    const Plan plan = way.plan(field.field);
    const std::string key =
        key_of(plan, field.field, names_of(skins, disturbances, way.is_control), seed);
    if (const std::optional<Judged> found = kept.find(key)) {
      out.push_back(*found);
      continue;
    }
    try {
      out.push_back(judges.on(field.field).judge(plan, field.field, seed, way.is_control));
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}, {}: {}", field.name, way.name, error.what()));
    }
    kept.add(key, out.back());
  }
  return out;
}

}  // namespace

Judge::Judge(const TransducerArray& array, const TargetField& raster,
             const std::vector<Skin>& skins, const std::vector<Disturbed>& disturbances)
    : player_(array), disturbances_(disturbances) {
  for (const Skin& skin : skins) feel_.push_back(skin.under(raster));
}

Judged Judge::judge(const Plan& plan, const TargetField& target, std::uint64_t seed,
                    bool is_control) {
  Judged out;
  const LoopDriveResult drives = player_.play(plan, target);
  const Pressed pressed = player_.press(drives, target, Vec2::Zero());
  const SkinMotion& motion = feel_[0](pressed.loop());
  out.percept = map_of(Readout::Intensity, motion, target);
  out.felt = score_physical(target, out.percept, 0.0);
  out.envelope = score_physical(target, pressed.envelope, 0.0);
  out.intensity = perceived_intensity(motion);
  out.strongest = *std::ranges::max_element(out.percept);
  for (std::size_t r = 0; r < kReadouts.size(); ++r)
    out.readout[r] = skill_of(target, map_of(kReadouts[r], motion, target));
  const Vibration vibration = vibration_of(motion, pressed.loop());
  for (std::size_t m = 0; m < kPerceptModels; ++m) {
    const auto model = static_cast<PerceptModel>(m);
    const PerceptEnergy energy = percept_energy(model, vibration);
    out.model_skill[m] = skill_of(target, strength_map(model, energy));
    out.model_strength[m] = strength_of(model, vibration.patch, energy);
  }
  for (std::size_t s = 0; s < feel_.size(); ++s) {
    out.skin.push_back(
        s == 0 ? out.felt.skill_8
               : skill_of(target, map_of(Readout::Intensity, feel_[s](pressed.loop()), target)));
  }
  for (const Disturbed& disturbed : disturbances_) {
    if (is_control) break;
    out.disturbed.push_back(mean_skill(disturbed.plays(plan, target, seed), target, drives));
  }
  out.ghosts = ghosts_of(target, out.percept).count;
  out.crossings = crossings_of(plan);
  out.long_paths = long_paths_of(plan, target);
  return out;
}

double Judge::mean_skill(const std::vector<Play>& plays, const TargetField& target,
                         const LoopDriveResult& drives) {
  double sum = 0.0;
  int count = 0;
  for (const Play& play : plays) {
    const std::optional<LoopDriveResult> other =
        play.plan ? std::optional(player_.play(*play.plan, target)) : std::nullopt;
    for (const Vec2& shift : play.shifts) {
      const Pressed pressed = player_.press(other ? *other : drives, target, shift);
      sum += skill_of(target, map_of(Readout::Intensity, feel_[0](pressed.loop()), target));
      ++count;
    }
  }
  return sum / count;
}

Results judge_all(const TransducerArray& array, const std::vector<NamedField>& fields,
                  const std::vector<Way>& ways, const std::vector<Skin>& skins,
                  const std::vector<Disturbed>& disturbances, int threads, Kept& kept) {
  std::vector<std::vector<Judged>> of_field(fields.size());
  std::vector<std::exception_ptr> failed(fields.size());
  std::atomic<std::size_t> next{0};
  WorkerPool pool(threads);
  pool.run(threads, [&](int) {
    Judges judges(array, skins, disturbances);
    for (std::size_t i = next++; i < fields.size(); i = next++) {
      try {
        of_field[i] = judge_field(judges, fields[i], ways, skins, disturbances, i + 1, kept);
        kept.write();
      } catch (...) {
        failed[i] = std::current_exception();
      }
    }
  });
  for (const std::exception_ptr& error : failed) {
    if (error) std::rethrow_exception(error);
  }
  Results out(ways.size());
  for (std::vector<Judged>& field : of_field) {
    for (std::size_t w = 0; w < ways.size(); ++w) out[w].push_back(std::move(field[w]));
  }
  return out;
}

}  // namespace prostm::bench
