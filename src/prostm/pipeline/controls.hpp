#pragma once
/// The controls that can be changed during a run, in one table with bounds and help.

#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "prostm/pipeline/settings.hpp"

namespace prostm {

/// The settings of a live run, which can change between two steps.
struct LiveSettings {
  PipelineSettings pipeline;
  std::string source = "scripted";   ///< source of the hands, one of `sources`
  std::vector<std::string> sources;  ///< the available sources: "scripted", "recording", "leap", …
  std::uint64_t version = 0;         ///< identifies the request that set them
};

enum class ControlKind { Number, Choice, Switch };

struct ControlChoice {
  std::string_view value, label;
};

/// A control. Its value is a number: for a choice, the index in the list; for a switch, 0 or 1.
struct RunControl {
  std::string_view id, group, label, help, unit;
  ControlKind kind = ControlKind::Number;
  double low = 0.0, high = 1.0, step = 1.0;  ///< for numbers, in `unit`
  std::span<const ControlChoice> choices;
  double (*get)(const LiveSettings&) = nullptr;
  void (*set)(LiveSettings&, double) = nullptr;
  /// Whether the control has an effect with the current settings.
  bool (*enabled)(const LiveSettings&) = nullptr;
  /// Whether a choice, given by index, is available; nullptr: all are.
  bool (*available)(const LiveSettings&, std::size_t) = nullptr;
};

/// Returns all controls in display order.
std::span<const RunControl> run_controls();

/// Returns the index of a control in run_controls(); −1 if the id is unknown.
int control_index(std::string_view id);

/// A value requested by a page.
using ControlValue = std::variant<double, bool, std::string>;

/// Returns the number of a value. @throws InputError: wrong type, out of bounds, or an unknown or
/// unavailable choice.
double control_number(const RunControl& control, const ControlValue& value,
                      const LiveSettings& settings);

}  // namespace prostm
