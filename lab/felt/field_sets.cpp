#include "felt/field_sets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "prostm/core/input_error.hpp"
#include "prostm/core/segment_distance.hpp"
#include "prostm/fields/felt_fields.hpp"
#include "prostm/fields/fields.hpp"
#include "prostm/pipeline/pipeline.hpp"

namespace prostm::bench {
namespace {

constexpr std::uint64_t kTuningSeed = 1, kScoutSeed = 101, kNewSeed = 201, kDrawnSeed = 401,
                        kRedrawnSeed = 501;

std::vector<NamedField> gallery() {
  constexpr int kCells = 54;  // per edge of the raster; each of 3 mm
  constexpr int kFrames = 3;
  std::vector<NamedField> out;
  for (const fields::Pattern pattern : fields::kPatterns) {
    for (int i = 0; i < kFrames; ++i) {
      const int frame = (2 * i + 1) * fields::kFrames / (2 * kFrames);
      out.push_back({fmt::format("{} {}", fields::to_string(pattern), frame),
                     fields::make(pattern, frame, kCells)});
    }
  }
  return out;
}

template <class Kinds>
std::vector<NamedField> generated(const Kinds& kinds, std::uint64_t first_seed, int seeds) {
  std::vector<NamedField> out;
  for (const fields::FeltKind kind : kinds) {
    for (int i = 0; i < seeds; ++i) {
      const std::uint64_t seed = first_seed + static_cast<std::uint64_t>(i);
      const auto outline = i % 2 == 0 ? fields::Outline::Hand : fields::Outline::Palm;
      out.push_back(
          {fmt::format("{} {} {}", fields::to_string(kind), fields::to_string(outline), seed),
           fields::felt_field(kind, seed, outline)});
    }
  }
  return out;
}

/// Returns fields of four jets of smoke on the study hand, after the flow has settled.
std::vector<NamedField> plumes() {
  constexpr double kStep = 0.02;                          // [s]
  constexpr int kSettle = 250, kApart = 30, kFields = 4;  // [steps]
  PipelineSettings settings;
  settings.scene = "four-plumes";
  settings.world_rate = 1.0 / kStep;
  settings.world_steps_per_plan = 1;
  settings.jets.place = JetPlace::Hand;
  WorldStage stage(settings, make_study_hand({}));
  WorldFrame frame;
  std::vector<NamedField> out;
  for (int step = 1; step <= kSettle + kApart * (kFields - 1); ++step) {
    stage.run(step, step * kStep, kStep, frame);
    if (step < kSettle || (step - kSettle) % kApart != 0) continue;
    if (frame.target.patches.empty()) throw InputError("the study's hand has no target");
    out.push_back({fmt::format("four plumes at {:.1f} s", step * kStep), frame.target.patches[0]});
  }
  return out;
}

/// Returns plain shapes of 6 mm (σ) on the palm of the hand.
std::vector<NamedField> shapes() {
  constexpr double kWidth = 6e-3, kRadius = 22e-3, kHalf = 22e-3;
  const Vec2 palm(0.0, -0.040), across(kHalf, 0.0), up(0.0, kHalf);
  const std::array<std::pair<const char*, std::function<double(const Vec2&)>>, 4> kShapes{{
      {"ring", [](const Vec2& x) { return x.norm() - kRadius; }},
      {"line", [&](const Vec2& x) { return std::sqrt(segment_distance2(x, -across, across)); }},
      {"point", [](const Vec2& x) { return x.norm(); }},
      {"letter T",
       [&](const Vec2& x) {
         return std::sqrt(std::min(segment_distance2(x, up - across, up + across),
                                   segment_distance2(x, -up, up)));
       }},
  }};
  std::vector<NamedField> out;
  for (const auto& [name, far] : kShapes) {
    TargetField field = fields::felt_field(fields::FeltKind::Plume, 1, fields::Outline::Hand);
    for (std::size_t i = 0; i < field.size(); ++i) {
      const double z = far(field.position(i) - palm) / kWidth;
      field.pressure[i] = field.skin[i] != 0 ? std::exp(-0.5 * z * z) : 0.0;
    }
    out.push_back({name, field});
  }
  return out;
}

std::vector<NamedField> whole_set(SetName set) {
  switch (set) {
    case SetName::Tuning:
      return generated(fields::kFeltKinds, kTuningSeed, 2);
    case SetName::Gallery:
      return gallery();
    case SetName::Scout:
      return generated(fields::kFeltKinds, kScoutSeed, 2);
    case SetName::Plumes:
      return plumes();
    case SetName::Drawn:
      return generated(fields::kDrawnKinds, kDrawnSeed, 24);
    case SetName::Redrawn:
      return generated(fields::kDrawnKinds, kRedrawnSeed, 24);
    case SetName::Shapes:
      return shapes();
    case SetName::New:
      break;
  }
  return generated(fields::kUnseenKinds, kNewSeed, 3);
}

}  // namespace

std::vector<NamedField> field_set(SetName set, int most) {
  std::vector<NamedField> all = whole_set(set);
  const auto size = all.size(), wanted = static_cast<std::size_t>(most);
  if (most == 0 || wanted >= size) return all;
  std::vector<NamedField> some;
  for (std::size_t i = 0; i < wanted; ++i) some.push_back(all[(2 * i + 1) * size / (2 * wanted)]);
  return some;
}

}  // namespace prostm::bench
