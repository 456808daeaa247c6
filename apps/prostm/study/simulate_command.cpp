#include <fmt/format.h>

#include <filesystem>
#include <mutex>

#include "common.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/core/require.hpp"
#include "prostm/core/stage_timer.hpp"
#include "study/simulated_study.hpp"

namespace prostm::app {
namespace {

std::string share_text(const SimulatedShare& share) {
  return fmt::format("{:5.1f} ({:.0f} to {:.0f})", 100.0 * share.mean, 100.0 * share.interval.low,
                     100.0 * share.interval.high);
}

void print_table(std::FILE* out, const std::vector<ObserverRow>& rows,
                 const std::vector<Answer>& people) {
  const auto print = [&](const std::string& name, const std::string& method,
                         const std::array<SimulatedShare, 3>& share, const std::string& end) {
    fmt::print(out, "  {:<9} {:<8} {:<19} {:<19} {:<19} {}\n", name, method, share_text(share[0]),
               share_text(share[1]), share_text(share[2]), end);
  };
  fmt::print(out, "\n  {:<9} {:<8} {:<19} {:<19} {:<19} {:>6}{}\n", "observer", "method",
             "one-plume %", "four-plumes %", "both %", "d′", people.empty() ? "" : "   log L");
  for (const ObserverRow& row : rows) {
    print(row.observer, row.method, row.share,
          fmt::format("{:>6.2f}", row.d_prime) +
              (row.log_likelihood ? fmt::format(" {:>7.1f}", *row.log_likelihood) : ""));
  }
  if (people.empty()) return;
  for (const StudyMethod& method : kStudyMethods)
    print("people", method.name, shares_of(answers_with(people, method.name)), "");
}

void check(const SimulateOptionsGiven& given) {
  validate(given.shape);
  require_between("--studies", given.studies, 1, 100'000);
  require_between("--hands", given.hands, 1, 100);
  require_between("--noise", given.noise, 0.01, 100.0);
  require_between("--seed", given.seed, 0, 1'000'000'000);
}

/// Returns the scores of the paper's participants; none if their file is missing.
std::vector<Answer> people_of(const SimulateOptionsGiven& given) {
  const std::string file = given.paper_data.value_or(kPaperData) + "/fig4.json";
  if (!given.paper_data && !std::filesystem::exists(file)) return {};
  Files files = given.files;
  if (!given.paper_data) files.reads("--paper-data", file);
  files.check();
  return answers_from_paper(read_file(file), file);
}

void write_answers(const SimulateOptionsGiven& given, const std::vector<ObserverRow>& rows) {
  if (given.answers.empty()) return;
  Random random(static_cast<std::uint64_t>(given.seed));
  std::vector<Answer> answers;
  for (const ObserverRow& row : rows) {
    if (row.observer != "skin") continue;
    const std::vector<Answer> of = simulate_study(row.pool, given.shape, row.method, random);
    answers.insert(answers.end(), of.begin(), of.end());
  }
  write_file(given.answers, tidy_csv(answers));
}

/// Computes the percepts of both scenes on all hands; of fewer hands after a signal.
std::vector<HandPercepts> feel(const SimulateOptionsGiven& given, const PipelineSettings& settings,
                               const Interrupt& interrupt) {
  const StageTimer timer;
  Progress progress("feeling");
  std::mutex one_line;
  return feel_hands(given, settings, [&](int done, int all) {
    const std::lock_guard lock(one_line);
    const double left = timer.seconds() * (all - done) / done;
    progress.show(done, all, fmt::format("moments, {:.0f} s left", left).c_str());
    return !interrupt.requested();
  });
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
  const Interrupt interrupt;
  fmt::print(out,
             "These answers are of models, never of people; no model was fitted to the paper's "
             "scores.\n");
  std::fflush(out);
  const std::vector<HandPercepts> hands = feel(given, settings, interrupt);
  if (interrupt.requested()) {
    fmt::print(out, "Stopped before all hands had felt the scenes: nothing was simulated.\n");
    return interrupt.status();
  }
  const std::vector<ObserverRow> rows = observer_rows(hands, given, people);
  print_table(out, rows, people);
  const std::string strength = about_strength(rows, hands);
  const std::string sensation = about_sensation(hands, given.sound);
  fmt::print(out,
             "\nIn the paper people had {:.0f} % with am and {:.0f} % with pro-stm.{}\n{}\n{}\n",
             100.0 * kStudyMethods[0].of_people, 100.0 * kStudyMethods[1].of_people,
             people.empty() ? fmt::format(" The participants' scores, {}/fig4.json, were not "
                                          "found, so likelihoods are missing (--paper-data).",
                                          kPaperData)
                            : std::string(),
             strength, sensation);
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
                          {"words", strength},
                          {"sensation_words", sensation}});
  say_written(out, given.json);
  return 0;
}

}  // namespace prostm::app
