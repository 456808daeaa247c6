/// The options of prostm study.

#include "add_options.hpp"
#include "common.hpp"
#include "prostm/figure/figures.hpp"
#include "prostm/plan/preset.hpp"
#include "study/study_plan.hpp"

namespace prostm::app {
namespace {

void add_study_run(Command study, Work& work) {
  auto command = study.add_command("run", "lead a participant through a protocol");
  auto o = std::make_shared<StudyRunOptionsGiven>();
  RunOptionsGiven& run = o->run;
  add_input(command, run.common.files, "protocol", o->protocol,
            "what is presented and asked (.toml, docs/study/study.md)")
      .required();
  command.add_option("--participant", o->participant, "number of the participant, from 1")
      .type_name("NUMBER")
      .required();
  command.add_option("--answers", o->folder, "folder of the response files")
      .type_name("FOLDER")
      .show_default();
  command
      .add_option(
          "--replaces", o->replaces,
          "replace this participant, with the same methods and orders; analyse then leaves the "
          "replaced one out")
      .type_name("NUMBER");
  command.add_flag("--resume", o->resume, "resume the session of a participant who has begun");
  command.add_flag("--take-over", o->take_over,
                   "replace the lock file of a run on another machine that has ended");
  command.add_option("--rehearse", o->rehearse,
                     "rehearse without a person: answer so many trials at random (0: all); the "
                     "file's name begins with rehearsal");
  command.add_flag(
      "--as-fast-as-possible", o->as_fast_as_possible,
      "with --rehearse: a simulated clock, without pages; the device must not keep its "
      "own time");
  command
      .add_option("--markers", o->markers,
                  "send a marker when each stimulus begins and ends: udp://HOST:PORT or "
                  "serial:///dev/ttyUSB0:BAUD (docs/study/study.md); may be given 8 times")
      .type_name("ADDRESS")
      .repeatable();
  run.hand = "study";
  add_hand(command, run.common, run.hand, run.hand_size);
  add_input(command, run.common.files, "--settings", run.common.settings_file,
            "settings that all methods begin with, a TOML file (docs/reference/files.md)");
  add_device(command, run.common);
  add_array(command, run.common);
  add_lock_memory(command, run.lock_memory);
  add_address(command, run);
  command.footer(
      "Example:\n  prostm study run data/protocols/one-plume-or-four.toml --participant 1 --hand "
      "leap://127.0.0.1:6437");
  set_work(command, work, o->run.common.files, [o] { return study_run_command(*o); });
}

void add_study_check(Command study, Work& work) {
  auto command = study.add_command(
      "check",
      "validate a protocol and print what is presented; every level must be played as written");
  auto o = std::make_shared<StudyCheckOptionsGiven>();
  add_input(command, o->common.files, "protocol", o->protocol,
            "what is presented and asked (.toml, docs/study/study.md)")
      .required();
  add_input(command, o->common.files, "--settings", o->common.settings_file,
            "settings that all methods begin with, a TOML file (docs/reference/files.md)");
  add_device(command, o->common);
  add_array(command, o->common);
  add_json(command, o->common.files, o->common.json);
  command.footer("Example:\n  prostm study check data/protocols/continuity.toml");
  set_work(command, work, o->common.files, [o] { return study_check_command(*o); });
}

void add_status(Command study, Work& work) {
  auto command = study.add_command("status", "show how full each group is, and who took part");
  auto o = std::make_shared<StudyStatusOptionsGiven>();
  command
      .add_option("answers", o->answers, "folders of prostm study run --answers, or files in them")
      .type_name("FOLDER|INPUT")
      .show_default();
  add_json(command, o->files, o->json);
  command.footer("Example:\n  prostm study status answers");
  set_work(command, work, o->files, [o] { return study_status_command(*o); });
}

/// Adds the options for reading files of answers.
void add_reading(Command command, ReadingSettings& reading) {
  command
      .add_option("--columns", reading.columns,
                  "names of a table's columns, as correct=key_resp.corr,participant=subject; "
                  "NAME:=VALUE for all rows")
      .type_name("NAME=COLUMN,…");
  command
      .add_option(
          "--prefix",
          [&reading](const std::string& name) {
            reading.prefix = from_name<IdPrefix>(name, "--prefix");
          },
          "prefix of participants' names: folder or file, which keeps equal numbers in different "
          "files apart; none, one name is one person")
      .type_name("none|folder|file");
  command
      .add_option(
          "--rename", reading.rename,
          "change a name, as participant:01=1, method:A=am or scene:S1=one-plume; may be given "
          "several times")
      .type_name("KIND:OLD=NEW")
      .repeatable();
  command.add_flag("--merge-spellings", reading.merge_spellings,
                   "treat names that differ only in spelling (01 and 1) as the same");
  command.add_flag("--pool", reading.pool, "pool answers to different stimuli with the same name");
}

void add_analyse(Command study, Work& work) {
  auto command =
      study.add_command("analyse", "analyse answers: shares or thresholds, intervals and tests");
  auto o = std::make_shared<PlannedAnalyseOptionsGiven>();
  add_input(
      command, o->files, "answers", o->answers,
      "participants' files of prostm study run (.jsonl), tables of answers (.csv, .tsv, .txt; "
      "docs/study/study-files.md), or the scores of the paper's Fig. 4 (.json)")
      .required();
  add_input(command, o->files, "--plan", o->plan,
            "run the tests of this plan of prostm study preregister first; everything else is "
            "exploratory");
  add_reading(command, o->reading);
  command.add_option("--chance", o->settings.chance, "share of right answers by guessing")
      .show_default();
  command
      .add_option("--level", o->settings.level,
                  "confidence level of intervals; tests use 1 minus it")
      .show_default();
  command
      .add_option("--equivalence", o->settings.equivalence,
                  "test whether differences of shares are within ± SHARE: the smallest difference "
                  "of interest, as 0.1")
      .type_name("SHARE");
  add_name(command, "--ties", o->ties,
           "ties in a table of paired comparisons (a, b, preferred): half counts each as half a "
           "preference for both; omit leaves them out; default: refuse");
  command.add_option("--seed", o->settings.seed, "random seed for splits of many participants")
      .show_default();
  command.add_option("--guess", o->settings.guess,
                     "share of right answers at low levels; default: --chance, or 0 where "
                     "no answer is wrong");
  command.add_option("--lapse", o->settings.lapse,
                     "share of wrong answers at high levels; default: 0.02");
  command.add_flag("--fit-lapse", o->settings.fit_lapse,
                   "fit the lapse share to the answers, from 0 to 0.2");
  add_json(command, o->files, o->json);
  add_output(command, o->files, "--figure", o->figure, check_figure,
             "shares as the paper's Fig. 4, or psychometric functions where answers have levels "
             "(.png, .svg or .pdf)");
  add_output(command, o->files, "--tidy", o->tidy, check_csv_output,
             "write the answers as a table (.csv) for other programs (docs/study/study.md)");
  command.footer(
      "Example:\n  prostm study analyse data/made-up-answers.csv --figure answers.svg --tidy "
      "tidy.csv");
  set_work(command, work, o->files,
           [o] { return o->plan.empty() ? analyse_command(*o) : planned_analyse_command(*o); });
}

/// Adds the rules by which a plan leaves answers out.
void add_exclusions(Command command, Exclusions& rules) {
  command.add_flag("--exclude-incomplete", rules.incomplete,
                   "leave out participants who do not finish their session");
  command.add_flag("--exclude-overridden", rules.overridden_gate,
                   "leave out trials that are presented although the gate does not pass");
  command.add_flag("--exclude-failed-practice", rules.failed_practice,
                   "leave out participants who do not reach the criterion of the practice");
  command
      .add_option("--exclude-wrong-checks", rules.wrong_checks_above,
                  "leave out participants with a larger share of wrong answers to catch and "
                  "attention trials")
      .type_name("SHARE");
  command
      .add_option("--exclude-below", rules.response_below,
                  "leave out trials with a response time below this")
      .type_name("SECONDS");
  command
      .add_option("--exclude-above", rules.response_above,
                  "leave out trials with a response time above this")
      .type_name("SECONDS");
}

void add_preregister(Command study, Work& work) {
  auto command =
      study.add_command("preregister", "write the plan of an analysis before the first answer");
  auto o = std::make_shared<PreregisterOptionsGiven>();
  add_input(command, o->common.files, "protocols", o->protocols,
            "the protocols that are presented (.toml, docs/study/study.md)")
      .required();
  command.add_option("-o,--out", o->out, "the plan (.jsonl, docs/study/study-files.md)")
      .type_name("OUTPUT")
      .each([o = o.get()](const std::string& path) {
        o->common.files.writes("--out", path, check_writable);
      })
      .required();
  command
      .add_option("--answers", o->answers,
                  "folder of the response files; it must not have answers yet")
      .type_name("FOLDER")
      .show_default();
  add_name(command, "--test", o->test, "of all comparisons, over participants: t or permutation")
      .show_default();
  command.add_option("--alpha", o->plan.alpha, "significance level, two-sided").show_default();
  add_name(command, "--correction", o->correction, "for the number of comparisons: holm or none")
      .show_default();
  command
      .add_option("--equivalence", o->plan.equivalence,
                  "test whether differences are within ± BOUND, in the unit of the measure")
      .type_name("BOUND");
  command.add_flag("--each-scene", o->each_scene, "compare in each scene, too");
  command.add_option("--participants", o->participants,
                     "planned number of participants; default: that of the protocols");
  command.add_option("--chance", o->plan.chance, "share of right answers by guessing")
      .show_default();
  add_exclusions(command, o->plan.exclusions);
  command
      .add_option("--note", o->plan.notes,
                  "a hypothesis or another decision; may be given several times")
      .type_name("TEXT")
      .repeatable();
  add_hand(command, o->common, o->hand, o->hand_size);
  add_input(command, o->common.files, "--settings", o->common.settings_file,
            "settings that all methods begin with, a TOML file (docs/reference/files.md)");
  add_device(command, o->common);
  add_array(command, o->common);
  command.footer(
      "Example:\n  prostm study preregister data/protocols/one-plume-or-four.toml -o plan.jsonl "
      "--equivalence 0.1");
  set_work(command, work, o->common.files, [o] { return preregister_command(*o); });
}

void add_power(Command study, Work& work) {
  auto command =
      study.add_command("power", "number of participants for a planned comparison of two methods");
  auto o = std::make_shared<PowerOptionsGiven>();
  auto first =
      command.add_option("--first", o->first, "assumed share of right answers with one method")
          .type_name("SHARE");
  auto second =
      command.add_option("--second", o->second, "assumed share with the other").type_name("SHARE");
  command
      .add_option("--d", o->design.d,
                  "assume this effect size instead: d between participants, d_z within")
      .excludes(first, second);
  add_name(command, "--methods", o->methods,
           "between: each participant has one method; within: both")
      .show_default();
  command.add_option("--trials", o->trials, "trials of each participant with each method")
      .show_default("16");
  command
      .add_option("--correlation", o->correlation,
                  "correlation of two answers of a person with a method, 0.001 to 0.9: how much "
                  "people differ")
      .show_default("0.1");
  command
      .add_option("--alike", o->alike,
                  "with --methods within, correlation of a person's shares with both methods, 0 to "
                  "0.99")
      .show_default("0.5");
  command.add_option("--participants", o->participants,
                     "print the power of this number, per method or in total");
  command.add_option("--alpha", o->design.alpha, "significance level of the two-sided t test")
      .show_default();
  command.add_option("--studies", o->studies, "number of simulated studies").show_default();
  command.add_option("--seed", o->seed, "random seed of the studies").show_default();
  add_json(command, o->files, o->json);
  command.footer(
      "Example:\n  prostm study power --first 0.6 --second 0.75 --trials 16 --participants 20");
  set_work(command, work, o->files, [o] { return power_command(*o); });
}

void add_simulate(Command study, Work& work) {
  auto command = study.add_command(
      "simulate",
      "simulate the paper's study with model observers in place of people; takes a minute");
  auto o = std::make_shared<SimulateOptionsGiven>();
  command
      .add_option("--participants", o->shape.participants,
                  "number of participants with each method")
      .show_default();
  command
      .add_option("--trials", o->shape.trials, "trials of each participant, half with each scene")
      .show_default();
  command.add_option("--studies", o->studies, "number of simulated studies for the intervals")
      .show_default();
  command
      .add_option("--hands", o->hands,
                  "number of hands, of different size and tremor, to draw participants from")
      .show_default();
  add_name(command, "--preset", o->preset,
           "of pro-stm: " +
               listed(std::vector<std::string>(kNames<Preset>.begin(), kNames<Preset>.end())))
      .show_default();
  command.add_option("--noise", o->noise, "factor on the observers' own noise").show_default();
  command.add_option("--grid", o->grid, "cells along each edge of the fluid's box").show_default();
  command.add_option("--seed", o->seed, "random seed of hands and answers").show_default();
  command
      .add_option("--paper-data", o->paper_data,
                  "folder with the paper's scores, fig4.json; default: " + std::string(kPaperData) +
                      ", if it is there")
      .type_name("FOLDER")
      .each([o = o.get()](const std::string& folder) {
        o->files.reads("--paper-data", folder + "/fig4.json");
      });
  add_output(command, o->files, "--answers", o->answers, check_writable,
             "the answers of one simulated study of the observer skin (.csv), as prostm study "
             "analyse reads them");
  add_json(command, o->files, o->json);
  command.footer("Example:\n  prostm study simulate --hands 1 --grid 32 --answers model.csv");
  set_work(command, work, o->files, [o] { return simulate_command(*o); });
}

}  // namespace

void add_study(Command app, Work& work) {
  auto study = app.add_command("study", "a perceptual study, from its trials to its figures");
  study.require_command();
  add_study_check(study, work);
  add_study_run(study, work);
  add_status(study, work);
  add_analyse(study, work);
  add_preregister(study, work);
  add_power(study, work);
  add_simulate(study, work);
}

}  // namespace prostm::app
