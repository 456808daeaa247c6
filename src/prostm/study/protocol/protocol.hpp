#pragma once
/// The protocol of a study: what is presented, how often, in what order, and what is asked.

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

/// Who gets which methods.
enum class MethodsOf : std::uint8_t {
  Between,  ///< each participant has one
  Within    ///< each participant has all, one after the other
};
template <>
inline constexpr std::array<std::string_view, 2> kNames<MethodsOf> = {"between", "within"};

/// How the scenes that are asked for are drawn.
enum class Questions : std::uint8_t {
  Random,   ///< for each trial anew, as in the paper
  Balanced  ///< of each scene's trials the same number asks for each scene, up to one
};
template <>
inline constexpr std::array<std::string_view, 2> kNames<Questions> = {"random", "balanced"};

enum class GateUse : std::uint8_t {
  Required,  ///< a trial waits until the gate passes, or the experimenter goes on without
  Noted,     ///< its verdict is written down
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
  int participants = 16;  ///< that are planned: over them the order is balanced
  MethodsOf methods = MethodsOf::Between;
  int seed = 1;               ///< of all orders
  bool blind = true;          ///< the experimenter does not see what is presented
  bool demographics = false;  ///< asks for an age range, a hand and experience; never for a name
  std::string consent;        ///< the text to agree to; empty: that is done on paper

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

/// [trials]
struct TrialSettings {
  const Task* task = nullptr;  ///< of the participant; set by whoever reads the protocol
  int repeats = 8;             ///< of each scene, with each method; staircases end by themselves
  Questions questions = Questions::Random;
  AnswersFrom answers = AnswersFrom::Experimenter;
  bool noise = false;       ///< the participant's page plays noise, which masks the array's sound
  bool feedback = false;    ///< tells the participant whether the answer was right
  int break_every = 0;      ///< trials; 0: no breaks
  double rest = 1.0;        ///< still air before each trial [s]
  double settle = 2.0;      ///< silence after it, in which the smoke develops [s]
  double time_limit = 0.0;  ///< of the stimulus, which then ends; 0: until the answer [s]
  /// Difference in rendered force between the scenes of a method that is let pass: the Weber
  /// fraction of touch (docs/design/study.md).
  double strength = 0.2;
  GateUse gate = GateUse::Required;

  /// Visits all but the task, which protocol_file.hpp names.
  void visit(SettingsReader& v) const;
  void visit(SettingsWriter& v);
};

/// [markers], docs/study/study-files.md
struct MarkerSettings {
  bool conditions = false;  ///< markers tell method and scene, also in a blind study

  void visit(SettingsReader& v) const;
  void visit(SettingsWriter& v);
};
/// Conditions that have codes of their own.
inline constexpr std::size_t kMostMarkedConditions = 239;

/// A stimulus that is presented, and asked for: a [scene.NAME] of the protocol.
struct StudyScene {
  std::string name;      ///< of the world's scenes
  std::string question;  ///< in words, as it is read and shown

  void visit(SettingsReader& v) const;
  void visit(SettingsWriter& v);
};

/// How it is rendered: a [method.NAME] of the protocol, which holds groups of settings.
struct StudyMethod {
  std::string name;
  PipelineSettings settings;  ///< of its trials, but for the scene
};

struct Protocol {
  StudySettings study;
  TrainingSettings training;
  TrialSettings trials;
  MarkerSettings markers;
  LevelSettings level;               ///< of tasks that have levels
  std::vector<StudyMethod> methods;  ///< as they stand in the file, as do scenes; `standard` aside
  std::vector<StudyScene> scenes;
  std::optional<StudyMethod> standard;  ///< that a level is compared with, where level.against is
};

}  // namespace prostm
