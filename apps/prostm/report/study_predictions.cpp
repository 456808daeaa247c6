#include "report/study_predictions.hpp"

#include <fmt/format.h>

#include <cmath>

#include "prostm/psychophysics/presenter.hpp"

namespace prostm::app {
namespace {

/// χ²/df of participants of a simulated study, the mean of many.
double spread_of(const std::vector<ModelParticipant>& pool, const SimulateOptionsGiven& given) {
  constexpr int kStudies = 200;
  Random random(static_cast<std::uint64_t>(given.seed));
  double sum = 0.0;
  for (int study = 0; study < kStudies; ++study) {
    std::map<std::string, Proportion> people;
    for (const Answer& answer : simulate_study(pool, given.shape, "", random)) {
      Proportion& of = people[answer.participant];
      ++of.trials;
      of.successes += answer.correct ? 1 : 0;
    }
    std::vector<Proportion> all;
    for (const auto& [name, proportion] : people) all.push_back(proportion);
    const auto test = dispersion(all);
    if (test) sum += test->statistic / test->df / kStudies;
  }
  return sum;
}

}  // namespace

StudyPredictions::StudyPredictions(int hands, std::function<bool()> go_on,
                                   const StudyVariation& variation)
    : go_on_(std::move(go_on)), variation_(variation) {
  given_.hands = hands;
  // intensity 1 is a focus at full drive
  const TransducerArray array = at_measured_amplitude(usx_array());
  given_.sound = focus_pressure(array, Medium{}, Vec3(0.0, 0.0, 0.2));
}

void StudyPredictions::feel() {
  if (!hands_.empty()) return;
  PipelineSettings settings;
  settings.plan.preset = Preset::Paper;
  settings.fluid.cells = given_.grid;
  settings.threads = 1;
  settings.transducers = at_measured_amplitude(usx_array());
  if (variation_.apply != nullptr) variation_.apply(settings);
  hands_ = feel_hands(
      given_, settings, [&](int, int) { return go_on_(); }, variation_.scene);
  if (!go_on_()) throw StudyStopped{};
}

std::vector<ModelParticipant> StudyPredictions::pool(const Observer& observer, std::size_t method,
                                                     double adaptation) {
  std::vector<ModelParticipant> out;
  ObserverParameters parameters = observer.parameters();
  if (kStudyMethods[method].percepts == &ScenePercepts::am)
    parameters.threshold *= std::pow(10.0, adaptation / 20.0);
  const Observer adapted(observer.model(), observer.readout(), parameters);
  for (const HandPercepts& hand : hands_) {
    std::array<std::vector<ModelPercept>, 2> felt;
    for (std::size_t s = 0; s < felt.size(); ++s) {
      for (const StimulusPercept& moment : hand[s].*kStudyMethods[method].percepts)
        felt[s].push_back(moment.by_model[static_cast<std::size_t>(observer.model())]);
    }
    for (ModelParticipant& who : observe_as(adapted, felt, kObserverLapse, variation_.in_trial))
      out.push_back(std::move(who));
  }
  return out;
}

const StudyQuantities& StudyPredictions::of(const Observer& observer, double adaptation) {
  const std::string key =
      fmt::format("{} {} {} {}", name_of(observer.model()), name_of(observer.readout()),
                  observer.parameters().threshold, adaptation);
  const auto found = known_.find(key);
  if (found != known_.end()) return found->second;
  feel();
  StudyQuantities out;
  for (std::size_t m = 0; m < kStudyMethods.size(); ++m) {
    const std::string method = kStudyMethods[m].name;
    const std::vector<ModelParticipant> people = pool(observer, m, adaptation);
    std::array<double, 2> right{};
    for (std::size_t s = 0; s < right.size(); ++s) {
      for (const ModelParticipant& who : people)
        right[s] += who.mean_right(s) / static_cast<double>(people.size());
      out[fmt::format("{} {}", method, kStudyScenes[s])] = right[s];
    }
    out[method] = 0.5 * (right[0] + right[1]);
    out[method + " spread"] = spread_of(people, given_);
  }
  out["difference"] = out["pro-stm"] - out["am"];
  return known_.emplace(key, std::move(out)).first->second;
}

std::array<std::array<double, 2>, 2> StudyPredictions::strengths(PerceptModel model) {
  feel();
  std::array<std::array<double, 2>, 2> out{};
  for (std::size_t m = 0; m < kStudyMethods.size(); ++m) {
    for (std::size_t s = 0; s < out[m].size(); ++s) {
      double moments = 0.0;
      for (const HandPercepts& hand : hands_) {
        for (const StimulusPercept& moment : hand[s].*kStudyMethods[m].percepts) {
          out[m][s] += moment.by_model[static_cast<std::size_t>(model)].strength;
          ++moments;
        }
      }
      out[m][s] /= moments;
    }
  }
  return out;
}

}  // namespace prostm::app
