#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <filesystem>

#include "common.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/core/require.hpp"
#include "prostm/core/stage_timer.hpp"
#include "prostm/core/worker_pool.hpp"
#include "prostm/study/percepts.hpp"

namespace prostm::app {
namespace {

constexpr int kMoments = 10;  // of each scene and hand: half for training, half for trials

/// One kind of model, and what it takes from a percept.
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

/// One method, by the name that answers have.
struct StudyMethod {
  const char* name;
  std::vector<StimulusPercept> ScenePercepts::*percepts;
  double of_people;  ///< share of right answers in the paper
};
constexpr std::array kMethods = {StudyMethod{"am", &ScenePercepts::am, 0.61},
                                 StudyMethod{"pro-stm", &ScenePercepts::pro_stm, 0.76}};

using HandPercepts = std::array<ScenePercepts, 2>;  ///< of each of kStudyScenes

/// Both scenes on all hands; fewer when a signal comes.
class Rendering {
 public:
  Rendering(const SimulateOptionsGiven& given, const PipelineSettings& settings)
      : given_(given), settings_(settings) {}

  std::vector<HandPercepts> all() {
    std::vector<HandPercepts> out(static_cast<std::size_t>(given_.hands));
    WorkerPool pool(2);  // a scene each
    for (std::size_t hand = 0; hand < out.size() && !interrupt_.requested(); ++hand) {
      std::array<std::exception_ptr, 2> failure;
      const ModelHand of = random_hand(static_cast<std::uint64_t>(given_.seed) * 1000 +
                                       static_cast<std::uint64_t>(hand));
      pool.run(2, [&](int scene) {
        const auto s = static_cast<std::size_t>(scene);
        try {
          out[hand][s] = feel_scene(settings_, kStudyScenes[s], of, kMoments,
                                    [&] { return go_on(scene == 0); });
        } catch (...) {
          failure[s] = std::current_exception();
        }
      });
      for (const std::exception_ptr& f : failure) {
        if (f) std::rethrow_exception(f);
      }
    }
    progress_.clear();
    return out;
  }
  const Interrupt& interrupt() const { return interrupt_; }

 private:
  /// @param shows whether this thread may write.
  bool go_on(bool shows) {
    const int done = ++done_, all = 2 * kMoments * given_.hands;
    const double left = timer_.seconds() * (all - done) / done;
    if (shows) progress_.show(done, all, fmt::format("moments, {:.0f} s left", left).c_str());
    return !interrupt_.requested();
  }

  const SimulateOptionsGiven& given_;
  const PipelineSettings& settings_;
  const Interrupt interrupt_;
  const StageTimer timer_;
  std::atomic<int> done_{0};
  Progress progress_{"feeling"};
};

/// One line of the table.
struct Row {
  std::string observer, method;
  std::array<SimulatedShare, 3> share;
  double d_prime = 0.0;
  std::optional<double> log_likelihood;
  std::vector<ModelParticipant> pool;
};

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

std::vector<Answer> answers_with(const std::vector<Answer>& answers, const std::string& method) {
  std::vector<Answer> out;
  for (const Answer& answer : answers) {
    if (answer.method == method) out.push_back(answer);
  }
  return out;
}

Row row_of(const std::string& observer, const std::string& method,
           std::vector<ModelParticipant> pool, const SimulateOptionsGiven& given,
           const std::vector<Answer>& people) {
  Row row{observer, method, {}, 0.0, {}, std::move(pool)};
  row.share =
      simulate_shares(row.pool, given.shape, given.studies, static_cast<std::uint64_t>(given.seed));
  for (const ModelParticipant& who : row.pool)
    row.d_prime += who.d_prime / static_cast<double>(row.pool.size());
  if (!people.empty()) row.log_likelihood = log_likelihood(row.pool, answers_with(people, method));
  return row;
}

std::vector<Row> rows_of(const std::vector<HandPercepts>& hands, const SimulateOptionsGiven& given,
                         const std::vector<Answer>& people) {
  std::vector<Row> rows;
  for (const Observer& observer : observers(given.noise)) {
    for (const StudyMethod& method : kMethods)
      rows.push_back(
          row_of(observer.name, method.name, pool_of(observer, method, hands), given, people));
  }
  for (const StudyMethod& method : kMethods)
    rows.push_back(row_of("guess", method.name, {{0.0, {{{0.5}, {0.5}}}}}, given, people));
  return rows;
}

std::string share_text(const SimulatedShare& share) {
  return fmt::format("{:5.1f} ({:.0f} to {:.0f})", 100.0 * share.mean, 100.0 * share.interval.low,
                     100.0 * share.interval.high);
}

/// The scores of people as shares, with Wilson's intervals.
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

void print_table(std::FILE* out, const std::vector<Row>& rows, const std::vector<Answer>& people) {
  const auto print = [&](const std::string& name, const std::string& method,
                         const std::array<SimulatedShare, 3>& share, const std::string& end) {
    fmt::print(out, "  {:<9} {:<8} {:<19} {:<19} {:<19} {}\n", name, method, share_text(share[0]),
               share_text(share[1]), share_text(share[2]), end);
  };
  fmt::print(out, "\n  {:<9} {:<8} {:<19} {:<19} {:<19} {:>6}{}\n", "observer", "method",
             "one-plume %", "four-plumes %", "both %", "d′", people.empty() ? "" : "   log L");
  for (const Row& row : rows) {
    print(row.observer, row.method, row.share,
          fmt::format("{:>6.2f}", row.d_prime) +
              (row.log_likelihood ? fmt::format(" {:>7.1f}", *row.log_likelihood) : ""));
  }
  if (people.empty()) return;
  for (const StudyMethod& method : kMethods)
    print("people", method.name, shares_of(answers_with(people, method.name)), "");
}

/// Mean strength of a scene on all hands [m].
double strength_of(const std::vector<HandPercepts>& hands, const StudyMethod& method,
                   std::size_t scene) {
  double sum = 0.0;
  for (const HandPercepts& hand : hands) {
    for (const StimulusPercept& moment : hand[scene].*method.percepts) sum += moment.strength;
  }
  return sum / (kMoments * static_cast<double>(hands.size()));
}

/// Says how well strength alone tells the scenes apart.
std::string about_strength(const std::vector<Row>& rows, const std::vector<HandPercepts>& hands) {
  constexpr double kCue = 0.525;  // share of right answers above which strength tells
  std::vector<std::string> said;
  bool is_cue = false;
  for (const StudyMethod& method : kMethods) {
    const auto row = std::ranges::find_if(
        rows, [&](const Row& r) { return r.observer == "strength" && r.method == method.name; });
    const double right = row->share[2].mean;
    said.push_back(fmt::format(
        "{:.1f} % right with {} (four plumes feel {:.2f} times as strong as one)", 100.0 * right,
        method.name, strength_of(hands, method, 1) / strength_of(hands, method, 0)));
    is_cue = is_cue || right > kCue;
  }
  return fmt::format(
      "Strength alone gives {}, guessing 50 %: {}.", fmt::join(said, " and "),
      is_cue ? "the scenes are not equally strong, and strength is a cue" : "strength is no cue");
}

nlohmann::ordered_json shares_json(const std::array<SimulatedShare, 3>& shares) {
  const std::array names = {kStudyScenes[0], kStudyScenes[1], "both"};
  nlohmann::ordered_json out;
  for (std::size_t s = 0; s < names.size(); ++s)
    out[names[s]] = {{"right", shares[s].mean},
                     {"interval", {shares[s].interval.low, shares[s].interval.high}}};
  return out;
}

nlohmann::ordered_json rows_json(const std::vector<Row>& rows) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const Row& row : rows) {
    nlohmann::ordered_json& json = out.emplace_back();
    json = {{"observer", row.observer}, {"method", row.method}, {"d_prime", row.d_prime}};
    json.update(shares_json(row.share));
    if (row.log_likelihood) json["log_likelihood"] = *row.log_likelihood;
  }
  return out;
}

/// The paper's shares, and those of its participants where their scores are there.
nlohmann::ordered_json people_json(const std::vector<Answer>& people) {
  nlohmann::ordered_json out;
  for (const StudyMethod& method : kMethods) {
    out[method.name] = {{"paper", method.of_people}};
    if (!people.empty())
      out[method.name].update(shares_json(shares_of(answers_with(people, method.name))));
  }
  return out;
}

void check(const SimulateOptionsGiven& given) {
  validate(given.shape);
  require_between("--studies", given.studies, 1, 100'000);
  require_between("--hands", given.hands, 1, 100);
  require_between("--noise", given.noise, 0.01, 100.0);
  require_between("--seed", given.seed, 0, 1'000'000'000);
}

/// The scores of the paper's participants; none where their file is not.
std::vector<Answer> people_of(const SimulateOptionsGiven& given) {
  const std::string file = given.paper_data.value_or(kPaperData) + "/fig4.json";
  if (!given.paper_data && !std::filesystem::exists(file)) return {};
  Files files = given.files;
  if (!given.paper_data) files.reads("--paper-data", file);
  files.check();
  return answers_from_paper(read_file(file), file);
}

void write_answers(const SimulateOptionsGiven& given, const std::vector<Row>& rows) {
  if (given.answers.empty()) return;
  Random random(static_cast<std::uint64_t>(given.seed));
  std::vector<Answer> answers;
  for (const Row& row : rows) {
    if (row.observer != "skin") continue;
    const std::vector<Answer> of = simulate_study(row.pool, given.shape, row.method, random);
    answers.insert(answers.end(), of.begin(), of.end());
  }
  write_file(given.answers, tidy_csv(answers));
}

}  // namespace

int simulate_command(const SimulateOptionsGiven& given) {
  check(given);
  CommonOptions common;
  common.preset = given.preset;
  common.grid = given.grid;
  PipelineSettings settings = make_settings(common, {}, true);
  settings.threads = 1;
  const std::vector<Answer> people = people_of(given);
  std::FILE* out = prose(given.json);
  Rendering rendering(given, settings);
  fmt::print(out,
             "These answers are of models, never of people; no model was fitted to the paper's "
             "scores.\n");
  std::fflush(out);
  const std::vector<HandPercepts> hands = rendering.all();
  if (rendering.interrupt().requested()) {
    fmt::print(out, "Stopped before all hands had felt the scenes: nothing was simulated.\n");
    return rendering.interrupt().status();
  }
  const std::vector<Row> rows = rows_of(hands, given, people);
  print_table(out, rows, people);
  const std::string strength = about_strength(rows, hands);
  fmt::print(out, "\nIn the paper people had {:.0f} % with am and {:.0f} % with pro-stm.{}\n{}\n",
             100.0 * kMethods[0].of_people, 100.0 * kMethods[1].of_people,
             people.empty() ? fmt::format(" Each one's scores, {}/fig4.json, are not there, so "
                                          "likelihoods are missing (--paper-data).",
                                          kPaperData)
                            : std::string(),
             strength);
  write_answers(given, rows);
  say_written(out, given.answers);
  write_json(given.json, {{"format", "prostm-simulated-study/1"},
                          {"participants", given.shape.participants},
                          {"trials", given.shape.trials},
                          {"studies", given.studies},
                          {"hands", given.hands},
                          {"preset", given.preset},
                          {"grid", given.grid},
                          {"seed", given.seed},
                          {"noise", given.noise},
                          {"rows", rows_json(rows)},
                          {"people", people_json(people)},
                          {"words", strength}});
  say_written(out, given.json);
  return 0;
}

}  // namespace prostm::app
