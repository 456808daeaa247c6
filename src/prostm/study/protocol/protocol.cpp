#include "prostm/study/protocol/protocol.hpp"

namespace prostm {
namespace {

template <class Settings, class V>
void list_study(Settings& s, V& v) {
  v.field({.name = "title", .help = "title of the study, for its files and pages"}, s.title);
  v.field({.name = "participants",
           .least = 1,
           .most = 10000,
           .help = "planned participants; the order is balanced over them"},
          s.participants);
  v.field({.name = "methods", .help = "each participant gets one method, or all"}, s.methods);
  v.field({.name = "seed", .least = 0, .help = "random seed of the order of methods and trials"},
          s.seed);
  v.field({.name = "blind", .help = "hides the stimuli from the experimenter"}, s.blind);
  v.field({.name = "demographics", .help = "asks for age range, writing hand and experience"},
          s.demographics);
  v.field({.name = "consent", .help = "text of the consent form; empty: consent is given on paper"},
          s.consent);
}

template <class Settings, class V>
void list_training(Settings& s, V& v) {
  v.field({.name = "seconds",
           .unit = "s",
           .least = 0,
           .most = 3600,
           .help = "training before the trials of each method"},
          s.seconds);
  v.field({.name = "picture", .help = "the participant sees the simulation during training"},
          s.picture);
}

template <class Settings, class V>
void list_practice(Settings& s, V& v) {
  v.field({.name = "trials",
           .least = 0,
           .most = 1000,
           .help = "practice trials before the trials of each method, at most; 0 for none"},
          s.trials);
  v.field({.name = "right",
           .least = 0,
           .most = 1,
           .help = "practice ends at this share of right answers; 0 for a fixed number of trials"},
          s.right);
  v.field({.name = "window",
           .least = 1,
           .most = 1000,
           .help = "the last answers of which the share is taken"},
          s.window);
}

template <class Settings, class V>
void list_trials(Settings& s, V& v) {
  v.field({.name = "repeats",
           .least = 1,
           .most = 1000,
           .help = "trials of each scene with each method; staircases end by their own rule"},
          s.repeats);
  v.field({.name = "questions", .help = "drawn for each trial, or balanced over a scene's trials"},
          s.questions);
  v.field({.name = "answers", .help = "who enters them"}, s.answers);
  v.field(
      {.name = "noise", .help = "the participant's page plays noise that masks the array's sound"},
      s.noise);
  v.field({.name = "feedback", .help = "tells the participant whether an answer was right"},
          s.feedback);
  v.field({.name = "break_every", .least = 0, .most = 1000, .help = "trials; 0 for no breaks"},
          s.break_every);
  v.field({.name = "rest",
           .unit = "s",
           .least = 0.1,
           .most = 60,
           .help = "still air before each trial"},
          s.rest);
  v.field({.name = "settle",
           .unit = "s",
           .least = 0.5,
           .most = 60,
           .help = "silence after rest, while the smoke develops"},
          s.settle);
  v.field({.name = "time_limit",
           .unit = "s",
           .least = 0,
           .most = 600,
           .help = "longest stimulus; 0: until the answer"},
          s.time_limit);
  v.field({.name = "fixed_duration",
           .help = "the stimulus lasts its whole time limit or interval, then the answer is taken"},
          s.fixed_duration);
  v.field({.name = "catch_every",
           .least = 0,
           .most = 1000,
           .help = "one catch trial, without a stimulus, in every so many trials; 0 for none"},
          s.catch_every);
  v.field({.name = "attention_every",
           .least = 0,
           .most = 1000,
           .help = "one trial that asks for a certain answer in every so many; 0 for none"},
          s.attention_every);
  v.field({.name = "strength",
           .least = 0,
           .most = 10,
           .help = "tolerated relative difference in strength between the scenes of a method"},
          s.strength);
  v.field({.name = "gate", .help = "whether a trial waits for the stimulus gate"}, s.gate);
}

template <class Settings, class V>
void list_markers(Settings& s, V& v) {
  v.field({.name = "conditions", .help = "markers include the stimulus, even in a blind study"},
          s.conditions);
}

}  // namespace

void StudySettings::visit(SettingsReader& v) const {
  list_study(*this, v);
}
void StudySettings::visit(SettingsWriter& v) {
  list_study(*this, v);
}
void TrainingSettings::visit(SettingsReader& v) const {
  list_training(*this, v);
}
void TrainingSettings::visit(SettingsWriter& v) {
  list_training(*this, v);
}
void PracticeSettings::visit(SettingsReader& v) const {
  list_practice(*this, v);
}
void PracticeSettings::visit(SettingsWriter& v) {
  list_practice(*this, v);
}
void TrialSettings::visit(SettingsReader& v) const {
  list_trials(*this, v);
}
void TrialSettings::visit(SettingsWriter& v) {
  list_trials(*this, v);
}
void MarkerSettings::visit(SettingsReader& v) const {
  list_markers(*this, v);
}
void MarkerSettings::visit(SettingsWriter& v) {
  list_markers(*this, v);
}

void StudyScene::visit(SettingsReader& v) const {
  v.field({.name = "question", .help = "a yes/no question, as shown and read aloud"}, question);
}
void StudyScene::visit(SettingsWriter& v) {
  v.field({.name = "question", .help = "a yes/no question, as shown and read aloud"}, question);
}

}  // namespace prostm
