#pragma once
/// The controls that can be turned during a run: one table, with bounds and help.

#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "prostm/pipeline/settings.hpp"

namespace prostm {

/// The settings that a live run can change between two steps.
struct LiveSettings {
  PipelineSettings pipeline;
  std::string source = "scripted";   ///< of the hands, one of `sources`
  std::vector<std::string> sources;  ///< those that there are: "scripted", "recording", "leap", …
  std::uint64_t version = 0;         ///< a number that tells who asked for them, and when
};

enum class ControlKind { Number, Choice, Switch };

struct ControlChoice {
  std::string_view value, label;
};

/// Values are numbers: of a choice its place in the list, of a switch 0 or 1.
struct RunControl {
  std::string_view id, group, label, help, unit;
  ControlKind kind = ControlKind::Number;
  double low = 0.0, high = 1.0, step = 1.0;  ///< of a number, in `unit`
  std::span<const ControlChoice> choices;
  double (*get)(const LiveSettings&) = nullptr;
  void (*set)(LiveSettings&, double) = nullptr;
  /// Whether it does anything as things are.
  bool (*enabled)(const LiveSettings&) = nullptr;
  /// Whether a choice is there, by its place; nullptr: all are.
  bool (*available)(const LiveSettings&, std::size_t) = nullptr;
};

/// In the order in which to show them.
std::span<const RunControl> run_controls();

/// Returns the place of a control in run_controls(); −1 if the id is unknown.
int control_index(std::string_view id);

/// The value that a page asks for.
using ControlValue = std::variant<double, bool, std::string>;

/// The number of a value. @throws InputError with a sentence: of the wrong kind, out of bounds, no
/// choice, or one that is not there.
double control_number(const RunControl& control, const ControlValue& value,
                      const LiveSettings& settings);

}  // namespace prostm
