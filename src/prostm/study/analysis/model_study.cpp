#include "prostm/study/analysis/model_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <map>
#include <numeric>
#include <stdexcept>

#include "prostm/core/distribution.hpp"
#include "prostm/core/require.hpp"

namespace prostm {
namespace {

constexpr int kThresholds = 15;  // participants of one hand, at equally likely thresholds

/// Right and wrong answers of one participant in each scene.
using Score = std::array<Proportion, 2>;

std::size_t scene_index(const std::string& name) {
  const auto found = std::ranges::find(kStudyScenes, name);
  if (found == kStudyScenes.end())
    throw std::invalid_argument("no model observer knows the scene " + name);
  return static_cast<std::size_t>(found - kStudyScenes.begin());
}

std::map<std::string, Score> scores_of(std::span<const Answer> answers) {
  std::map<std::string, Score> out;
  for (const Answer& answer : answers) {
    Proportion& of = out[answer.participant][scene_index(answer.scene)];
    ++of.trials;
    of.successes += answer.correct ? 1 : 0;
  }
  return out;
}

/// The trials of a participant: scene and question, with all combinations as equally frequent as
/// the number of trials allows.
std::vector<std::pair<std::size_t, std::size_t>> shuffled_trials(int trials, Random& random) {
  std::vector<std::pair<std::size_t, std::size_t>> out;
  for (int i = 0; i < trials; ++i) {
    const auto k = static_cast<std::size_t>(i);
    out.emplace_back(k % 2, k / 2 % 2);
  }
  random.shuffle(out);
  return out;
}

template <class Value>
const Value& drawn(std::span<const Value> from, Random& random) {
  return from[static_cast<std::size_t>(random.below(static_cast<int>(from.size())))];
}

Percept mean_of(std::span<const Percept> all) {
  Percept out(all.front().size());
  for (const Percept& one : all) {
    for (std::size_t i = 0; i < out.size(); ++i) out[i] += one[i] / static_cast<double>(all.size());
  }
  return out;
}

/// Means of the training moments, and the moments of trials.
struct SplitScenes {
  std::array<Percept, 2> known;
  FeltScenes trials;
  std::size_t in_trial;
};

SplitScenes split(const FeltScenes& felt, std::size_t in_trial) {
  SplitScenes out{{}, {}, in_trial};
  for (std::size_t s = 0; s < felt.size(); ++s) {
    if (felt[s].size() < 2 * in_trial)
      throw std::invalid_argument(fmt::format("{} moments of {} must be at least {}",
                                              felt[s].size(), kStudyScenes[s], 2 * in_trial));
    std::vector<Percept> training;
    for (std::size_t i = 0; i < felt[s].size(); ++i)
      (i % 2 == 0 ? training : out.trials[s]).push_back(felt[s][i]);
    out.known[s] = mean_of(training);
  }
  return out;
}

/// Adds the probability of a right answer in each trial. @param evidence returns the evidence for
/// the second scene, in standard deviations.
template <class Evidence>
void add_trials(const SplitScenes& scenes, double lapse, ModelParticipant& out,
                const Evidence& evidence) {
  for (std::size_t s = 0; s < scenes.trials.size(); ++s) {
    for (std::size_t i = 0; i + scenes.in_trial <= scenes.trials[s].size(); ++i) {
      const double for_second =
          evidence(mean_of(std::span(scenes.trials[s]).subspan(i, scenes.in_trial)));
      out.right[s].push_back(chance_of_right(s == 1 ? for_second : -for_second, lapse));
    }
  }
}

/// Simulates an observer of one number with noise of this standard deviation.
ModelParticipant observe_number(const FeltScenes& felt, double noise, double lapse,
                                std::size_t in_trial) {
  const SplitScenes scenes = split(felt, in_trial);
  const double first = scenes.known[0].front(), second = scenes.known[1].front();
  ModelParticipant out;
  out.d_prime = std::abs(second - first) / noise;
  add_trials(scenes, lapse, out, [&](const Percept& trial) {
    const double over = (trial.front() - 0.5 * (first + second)) / noise;
    return second >= first ? over : -over;
  });
  return out;
}

}  // namespace

double ModelParticipant::mean_right(std::size_t scene) const {
  const std::vector<double>& p = right[scene];
  return std::accumulate(p.begin(), p.end(), 0.0) / static_cast<double>(p.size());
}

ModelParticipant observe(const FeltScenes& felt, const ObserverNoise& noise, double lapse,
                         std::size_t in_trial) {
  const SplitScenes scenes = split(felt, in_trial);
  const TemplateObserver observer(scenes.known[0], scenes.known[1], noise);
  ModelParticipant out;
  out.d_prime = observer.d_prime();
  add_trials(scenes, lapse, out, [&](const Percept& trial) { return observer.evidence(trial); });
  return out;
}

std::vector<ModelParticipant> observe_as(const Observer& observer,
                                         const std::array<std::vector<ModelPercept>, 2>& felt,
                                         double lapse, std::size_t in_trial) {
  FeltScenes numbers;
  double strength = 0.0;
  for (std::size_t s = 0; s < felt.size(); ++s) {
    for (const ModelPercept& moment : felt[s]) {
      numbers[s].push_back(observer.readout() == Readout::Template ? moment.places
                                                                   : Percept{moment.dip});
      strength += moment.strength / static_cast<double>(2 * felt[s].size());
    }
  }
  std::vector<ModelParticipant> out;
  for (int i = 0; i < kThresholds; ++i) {
    const double quantile = (i + 0.5) / kThresholds;
    const double z = boost::math::quantile(boost::math::normal(), quantile);
    const double own =
        observer.parameters().threshold * std::pow(10.0, kThresholdSpread * z / 20.0);
    const double weak = strength > 0.0 ? own / strength : 0.0;
    const double noise = observer.parameters().noise * std::hypot(1.0, weak);
    out.push_back(observer.readout() == Readout::Template
                      ? observe(numbers, {noise, kStrengthNoise}, lapse, in_trial)
                      : observe_number(numbers, noise, lapse, in_trial));
  }
  return out;
}

void validate(const StudyShape& shape) {
  require_between("participants", shape.participants, 2, 1000);
  require_between("trials", shape.trials, 2, 1000);
  if (shape.trials % 2 != 0)
    throw std::invalid_argument(
        fmt::format("trials = {} must be even: half of them have each scene", shape.trials));
}

std::vector<Answer> simulate_study(std::span<const ModelParticipant> pool, const StudyShape& shape,
                                   const std::string& method, Random& random) {
  std::vector<Answer> out;
  for (int i = 1; i <= shape.participants; ++i) {
    const ModelParticipant& who = drawn(pool, random);
    const std::string name = fmt::format("model-{}-{}", method, i);
    int trial = 0;
    for (const auto& [scene, question] : shuffled_trials(shape.trials, random)) {
      const double p = drawn(std::span<const double>(who.right[scene]), random);
      const bool correct = random.uniform() < p;
      out.push_back({.participant = name,
                     .method = method,
                     .scene = kStudyScenes[scene],
                     .correct = correct,
                     .question = kStudyScenes[question],
                     .yes = (scene == question) == correct,
                     .trial = std::to_string(++trial)});
    }
  }
  return out;
}

std::array<SimulatedShare, 3> simulate_shares(std::span<const ModelParticipant> pool,
                                              const StudyShape& shape, int studies,
                                              std::uint64_t seed) {
  Random random(seed);
  std::array<std::vector<double>, 3> shares;
  for (int study = 0; study < studies; ++study) {
    Score right{};
    for (const Answer& answer : simulate_study(pool, shape, "", random)) {
      Proportion& of = right[scene_index(answer.scene)];
      ++of.trials;
      of.successes += answer.correct ? 1 : 0;
    }
    for (std::size_t s = 0; s < right.size(); ++s) shares[s].push_back(right[s].value());
    shares[2].push_back(0.5 * (right[0].value() + right[1].value()));
  }
  std::array<SimulatedShare, 3> out;
  for (const ModelParticipant& who : pool) {
    for (std::size_t s = 0; s < 2; ++s)
      out[s].mean += who.mean_right(s) / static_cast<double>(pool.size());
  }
  out[2].mean = 0.5 * (out[0].mean + out[1].mean);
  for (std::size_t s = 0; s < out.size(); ++s)
    out[s].interval = {quantile(shares[s], 0.025), quantile(shares[s], 0.975)};
  return out;
}

double log_likelihood(std::span<const ModelParticipant> pool, std::span<const Answer> answers) {
  double sum = 0.0;
  for (const auto& [name, score] : scores_of(answers)) {
    double chance = 0.0;
    for (const ModelParticipant& who : pool) {
      double product = 1.0;
      for (std::size_t s = 0; s < score.size(); ++s) {
        const boost::math::binomial of(score[s].trials, who.mean_right(s));
        product *= boost::math::pdf(of, score[s].successes);
      }
      chance += product / static_cast<double>(pool.size());
    }
    sum += std::log(chance);
  }
  return sum;
}

}  // namespace prostm
