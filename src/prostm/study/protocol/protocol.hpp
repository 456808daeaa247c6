#pragma once
/// The protocol of a study: stimuli, repetitions, order and questions.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "prostm/core/settings.hpp"
#include "prostm/pipeline/settings.hpp"
#include "prostm/study/protocol/level.hpp"

namespace prostm {

class Task;

/// Assignment of methods to participants.
enum class MethodsOf : std::uint8_t {
  Between,  ///< each participant gets one method
  Within    ///< each participant gets all methods, one after the other
};
template <>
inline constexpr std::array<std::string_view, 2> kNames<MethodsOf> = {"between", "within"};

/// How the scene in question is drawn.
enum class Questions : std::uint8_t {
  Random,   ///< independently for each trial, as in the paper
  Balanced  ///< among the trials of each scene, all scenes are asked for equally often, within one
};
template <>
inline constexpr std::array<std::string_view, 2> kNames<Questions> = {"random", "balanced"};

enum class GateUse : std::uint8_t {
  Required,  ///< a trial waits until the gate passes or the experimenter overrides it
  Noted,     ///< its verdict is recorded only
  Off
};
template <>
inline constexpr std::array<std::string_view, 3> kNames<GateUse> = {"required", "noted", "off"};

/// Who enters answers.
enum class AnswersFrom : std::uint8_t { Experimenter, Participant };
template <>
inline constexpr std::array<std::string_view, 2> kNames<AnswersFrom> = {"experimenter",
                                                                        "participant"};

/// [study]
struct StudySettings {
  std::string title;
  int participants = 16;  ///< planned participants; the order is balanced over them
  MethodsOf methods = MethodsOf::Between;
  int seed = 1;               ///< seed of all orders
  bool blind = true;          ///< the experimenter does not see what is presented
  bool demographics = false;  ///< asks for age range, writing hand and experience; never for a name
  std::string consent;        ///< text of the consent form; empty: consent is given on paper

  void visit(SettingsReader& v) const;
  void visit(SettingsWriter& v);
};

/// [training], before the trials of each method
struct TrainingSettings {
  double seconds = 120.0;
  bool picture = true;  ///< the participant sees the simulation in three dimensions

  void visit(SettingsReader& v) const;
  void visit(SettingsWriter& v);
};

/// [practice], after the training of each method
struct PracticeSettings {
  int trials = 0;      ///< largest number; 0: no practice
  double right = 0.8;  ///< it ends at this share of right answers; 0: after all `trials`
  int window = 10;     ///< the last answers of which the share is taken

  void visit(SettingsReader& v) const;
  void visit(SettingsWriter& v);
};

/// [trials]
struct TrialSettings {
  const Task* task = nullptr;  ///< the participant's task; set when the protocol is read
  int repeats = 8;  ///< trials of each scene with each method; staircases end by their own rule
  Questions questions = Questions::Random;
  AnswersFrom answers = AnswersFrom::Experimenter;
  bool noise = false;           ///< the participant's page plays noise that masks the array's sound
  bool feedback = false;        ///< tells the participant whether the answer was right
  int break_every = 0;          ///< trials; 0: no breaks
  double rest = 1.0;            ///< still air before each trial [s]
  double settle = 2.0;          ///< silence after `rest`, while the smoke develops [s]
  double time_limit = 0.0;      ///< longest stimulus [s]; 0: until the answer
  bool fixed_duration = false;  ///< the answer is taken after the stimulus, which it cannot end
  int catch_every = 0;          ///< trials, among which one catch trial is given; 0: none
  int attention_every = 0;      ///< the same for attention trials
  /// Largest relative difference in rendered force between the scenes of a method that is
  /// tolerated: the Weber fraction of touch (docs/design/study.md).
  double strength = 0.2;
  GateUse gate = GateUse::Required;

  /// Visits all settings except the task, which protocol_file.hpp reads.
  void visit(SettingsReader& v) const;
  void visit(SettingsWriter& v);
};

/// [markers], docs/study/study-files.md
struct MarkerSettings {
  bool conditions = false;  ///< markers include method and scene, even in a blind study

  void visit(SettingsReader& v) const;
  void visit(SettingsWriter& v);
};
/// Largest number of conditions with their own codes.
inline constexpr std::size_t kMostMarkedConditions = 239;

/// A stimulus and the question about it: a [scene.NAME] of the protocol.
struct StudyScene {
  std::string name;      ///< name of one of the world's scenes
  std::string question;  ///< the question, as shown and read aloud

  void visit(SettingsReader& v) const;
  void visit(SettingsWriter& v);
};

/// A rendering method: a [method.NAME] of the protocol, which holds groups of settings.
struct StudyMethod {
  std::string name;
  PipelineSettings settings;  ///< of its trials, except the scene
};

struct Protocol {
  StudySettings study;
  TrainingSettings training;
  PracticeSettings practice;
  TrialSettings trials;
  MarkerSettings markers;
  LevelSettings level;               ///< for tasks with levels
  std::vector<StudyMethod> methods;  ///< in the order of the file, like scenes; without `standard`
  std::vector<StudyScene> scenes;
  std::optional<StudyMethod> standard;  ///< the method in level.against, if set
  std::vector<std::string> warnings;    ///< a sentence for each setting that has been replaced
};

}  // namespace prostm
