#include "study/simulated_study.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <exception>

#include "prostm/acoustics/skin/sensation_level.hpp"
#include "prostm/core/worker_pool.hpp"
#include "prostm/psychophysics/observer.hpp"

namespace prostm::app {
namespace {

constexpr int kMoments = 10;  // moments per scene and hand: half for training, half for trials

/// One kind of model observer, and the features it takes from a percept.
struct Observer {
  const char* name;
  ObserverNoise noise;
  Percept (*feels)(const StimulusPercept&);
};

std::vector<Observer> observers(double factor) {
  const ObserverNoise of_places{factor * kTouchNoise, factor * kStrengthNoise};
  return {{"skin", of_places, [](const StimulusPercept& p) { return p.skin; }},
          {"field", of_places, [](const StimulusPercept& p) { return p.field; }},
          {"strength", {factor * kStrengthNoise, 0.0}, [](const StimulusPercept& p) {
             return Percept{p.strength};
           }}};
}

std::vector<ModelParticipant> pool_of(const Observer& observer, const StudyMethod& method,
                                      const std::vector<HandPercepts>& hands) {
  std::vector<ModelParticipant> pool;
  for (const HandPercepts& hand : hands) {
    FeltScenes felt;
    for (std::size_t s = 0; s < felt.size(); ++s) {
      for (const StimulusPercept& moment : hand[s].*method.percepts)
        felt[s].push_back(observer.feels(moment));
    }
    pool.push_back(observe(felt, observer.noise, kObserverLapse));
  }
  return pool;
}

/// Mean of a strength over all hands and moments of a scene [m].
double mean_strength(const std::vector<HandPercepts>& hands, const StudyMethod& method,
                     std::size_t scene, double (*strength)(const StimulusPercept&)) {
  double sum = 0.0;
  for (const HandPercepts& hand : hands) {
    for (const StimulusPercept& moment : hand[scene].*method.percepts) sum += strength(moment);
  }
  return sum / (kMoments * static_cast<double>(hands.size()));
}

double of_whole_skin(const StimulusPercept& moment) {
  return moment.strength;
}
double of_strongest_place(const StimulusPercept& moment) {
  return moment.by_model[static_cast<std::size_t>(PerceptModel::Peak)].strength;
}

nlohmann::ordered_json shares_json(const std::array<SimulatedShare, 3>& shares) {
  const std::array names = {kStudyScenes[0], kStudyScenes[1], "both"};
  nlohmann::ordered_json out;
  for (std::size_t s = 0; s < names.size(); ++s)
    out[names[s]] = {{"right", shares[s].mean},
                     {"interval", {shares[s].interval.low, shares[s].interval.high}}};
  return out;
}

ObserverRow row_of(const std::string& observer, const std::string& method,
                   std::vector<ModelParticipant> pool, const SimulateOptionsGiven& given,
                   const std::vector<Answer>& people) {
  ObserverRow row{observer, method, {}, 0.0, {}, std::move(pool)};
  row.share =
      simulate_shares(row.pool, given.shape, given.studies, static_cast<std::uint64_t>(given.seed));
  for (const ModelParticipant& who : row.pool)
    row.d_prime += who.d_prime / static_cast<double>(row.pool.size());
  if (!people.empty()) row.log_likelihood = log_likelihood(row.pool, answers_with(people, method));
  return row;
}

}  // namespace

std::vector<HandPercepts> feel_hands(const SimulateOptionsGiven& given,
                                     const PipelineSettings& settings,
                                     const std::function<bool(int done, int all)>& go_on,
                                     const SceneVariation& variation) {
  std::vector<HandPercepts> out;
  std::atomic<int> done{0};
  std::atomic<bool> ended{false};
  const auto count = [&] {
    if (!go_on(++done, 2 * kMoments * given.hands)) ended = true;
    return !ended;
  };
  WorkerPool pool(2);  // a scene each
  for (int h = 0; h < given.hands && !ended; ++h) {
    std::array<std::exception_ptr, 2> failure;
    const ModelHand of =
        random_hand(static_cast<std::uint64_t>(given.seed) * 1000 + static_cast<std::uint64_t>(h));
    HandPercepts& hand = out.emplace_back();
    pool.run(2, [&](int scene) {
      const auto s = static_cast<std::size_t>(scene);
      try {
        hand[s] =
            feel_scene(settings, kStudyScenes[s], of, given.sound, kMoments, variation, count);
      } catch (...) {
        failure[s] = std::current_exception();
      }
    });
    for (const std::exception_ptr& f : failure) {
      if (f) std::rethrow_exception(f);
    }
  }
  return out;
}

std::vector<Answer> answers_with(const std::vector<Answer>& answers, const std::string& method) {
  std::vector<Answer> out;
  for (const Answer& answer : answers) {
    if (answer.method == method) out.push_back(answer);
  }
  return out;
}

std::vector<ObserverRow> observer_rows(const std::vector<HandPercepts>& hands,
                                       const SimulateOptionsGiven& given,
                                       const std::vector<Answer>& people) {
  std::vector<ObserverRow> rows;
  for (const Observer& observer : observers(given.noise)) {
    for (const StudyMethod& method : kStudyMethods)
      rows.push_back(
          row_of(observer.name, method.name, pool_of(observer, method, hands), given, people));
  }
  for (const StudyMethod& method : kStudyMethods)
    rows.push_back(row_of("guess", method.name, {{0.0, {{{0.5}, {0.5}}}}}, given, people));
  return rows;
}

std::array<SimulatedShare, 3> shares_of(const std::vector<Answer>& answers) {
  std::array<Proportion, 3> right;
  for (const Answer& answer : answers) {
    for (const std::size_t s : {answer.scene == kStudyScenes[0] ? 0U : 1U, 2U}) {
      ++right[s].trials;
      right[s].successes += answer.correct ? 1 : 0;
    }
  }
  std::array<SimulatedShare, 3> out;
  for (std::size_t s = 0; s < out.size(); ++s)
    out[s] = {right[s].value(), wilson_interval(right[s])};
  return out;
}

std::string about_strength(const std::vector<ObserverRow>& rows,
                           const std::vector<HandPercepts>& hands) {
  constexpr double kCue = 0.525;  // share of right answers above which strength is a cue
  std::vector<std::string> said;
  bool is_cue = false;
  for (const StudyMethod& method : kStudyMethods) {
    const auto row = std::ranges::find_if(rows, [&](const ObserverRow& r) {
      return r.observer == "strength" && r.method == method.name;
    });
    const double right = row->share[2].mean;
    said.push_back(
        fmt::format("{:.1f} % right with {} (four plumes feel {:.2f} times as strong as one)",
                    100.0 * right, method.name,
                    mean_strength(hands, method, 1, of_whole_skin) /
                        mean_strength(hands, method, 0, of_whole_skin)));
    is_cue = is_cue || right > kCue;
  }
  return fmt::format(
      "Strength alone gives {}, guessing 50 %: {}.", fmt::join(said, " and "),
      is_cue ? "the scenes are not equally strong, and strength is a cue" : "strength is no cue");
}

std::string about_sensation(const std::vector<HandPercepts>& hands, double sound) {
  std::vector<std::string> said;
  for (const StudyMethod& method : kStudyMethods) {
    const auto level = [&](std::size_t scene) {
      return decibels(mean_strength(hands, method, scene, of_strongest_place), kTouchThreshold);
    };
    said.push_back(fmt::format("{:.0f} dB (one plume) and {:.0f} dB (four) with {}", level(0),
                               level(1), method.name));
  }
  return fmt::format(
      "With {:.0f} Pa rms at intensity 1, the sensation levels of the strongest places are {}; "
      "these observers have no threshold.",
      sound, fmt::join(said, ", "));
}

nlohmann::ordered_json rows_json(const std::vector<ObserverRow>& rows) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const ObserverRow& row : rows) {
    nlohmann::ordered_json& json = out.emplace_back();
    json = {{"observer", row.observer}, {"method", row.method}, {"d_prime", row.d_prime}};
    json.update(shares_json(row.share));
    if (row.log_likelihood) json["log_likelihood"] = *row.log_likelihood;
  }
  return out;
}

nlohmann::ordered_json people_json(const std::vector<Answer>& people) {
  nlohmann::ordered_json out;
  for (const StudyMethod& method : kStudyMethods) {
    out[method.name] = {{"paper", method.of_people}};
    if (!people.empty())
      out[method.name].update(shares_json(shares_of(answers_with(people, method.name))));
  }
  return out;
}

}  // namespace prostm::app
