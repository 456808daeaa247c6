#include "prostm/study/task/perception.hpp"

namespace prostm {
namespace {

constexpr double kSlope = 20.0;  // times the range of levels
constexpr double kNoise = 0.02;  // of distances, as a share of the range

}  // namespace

Perception::Perception(const LevelSettings& level, double threshold, double guess,
                       std::uint64_t seed)
    : level_(level), width_(level.range().high - level.range().low), random_(seed) {
  felt_.threshold = level.to_scale(threshold);
  felt_.slope = kSlope / width_;
  felt_.guess = guess;
}

bool Perception::feels(double level) {
  return random_.uniform() < felt_.at(level_.to_scale(level));
}

double Perception::distance(double level) {
  return (level_.to_scale(level) - felt_.threshold) / width_ + kNoise * random_.normal();
}

}  // namespace prostm
