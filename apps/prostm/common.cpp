#include "common.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <limits>
#include <new>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <thread>

#include "prostm/commit.hpp"
#include "prostm/core/file/file.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/core/stage_timer.hpp"
#include "prostm/core/text/json.hpp"
#include "prostm/core/text/lower_case.hpp"
#include "prostm/core/text/nearest_name.hpp"
#include "prostm/device/device_kinds.hpp"
#include "prostm/device/realtime_limits.hpp"
#include "prostm/device/simulated/simulated_array.hpp"
#include "prostm/io/array_file.hpp"
#include "prostm/io/hand/hand_file.hpp"
#include "prostm/io/hand/pose_file.hpp"
#include "prostm/pipeline/realtime/verdict.hpp"
#include "prostm/track/live/leap_client.hpp"
#include "prostm/track/live/openxr_hands.hpp"
#include "prostm/track/live/page_hand.hpp"

namespace prostm::app {
namespace {

/// Checks the files that the settings name, with those of the command.
void check_files_of(const PipelineSettings& settings, const CommonOptions& options) {
  Files files = options.files;
  const std::string where = " (in " + options.settings_file + ")";
  if (names_json(settings.array)) files.reads("--array" + where, settings.array);
  if (names_json(settings.tracker)) files.reads("--tracker" + where, settings.tracker);
  for (const SettingsGroup& group : settings_groups(settings)) {
    for (const auto& [name, file] : files_of(group.read))
      files.reads("[" + group.name + "] " + name + where, file);
  }
  files.check();
}

/// Returns a setting with the name and unit of the option that sets it. @param factor the setting's
/// unit in units of the option.
Setting as_option(const SettingsGroup& group, std::string_view setting, const char* option,
                  const char* unit = "", double factor = 1.0) {
  const std::vector<SettingRow> rows = setting_rows(group.read);
  Setting out = std::ranges::find_if(rows, [&](const SettingRow& row) {
                  return row.setting.name == setting;
                })->setting;
  out.name = option;
  out.unit = unit;
  out.least *= factor;
  out.most *= factor;
  return out;
}

/// Checks the bounds of options that correspond to settings; messages name the options.
void check_bounds(const CommonOptions& options, const PipelineSettings& settings) {
  const SettingsGroup plan = group_of("plan", settings.plan);
  if (options.paths) require_bounds(as_option(plan, "paths", "--paths"), *options.paths);
  if (options.budget_ms)
    require_bounds(as_option(plan, "budget", "--budget-ms", "ms", 1e3), *options.budget_ms);
  if (options.grid) {
    const SettingsGroup fluid = group_of("fluid", settings.fluid);
    require_bounds(as_option(fluid, "cells", "--grid"), *options.grid);
  }
  if (options.seed) require_bounds(as_option(plan, "seed", "--seed"), *options.seed);
}

/// Sets the transducers: those of the device unless others are chosen.
/// @throws InputError for another built-in array than the device's.
void settle_array(PipelineSettings& settings, bool is_chosen) {
  const DeviceKind& kind = *device_named(settings.device).kind;
  if (!is_chosen && kind.array != nullptr) settings.array = kind.array;
  settings.transducers = array_from_name(settings.array);
  if (!is_chosen && kind.transducers != nullptr)
    settings.transducers = kind.transducers(settings.device_setup());
  if (kind.array == nullptr || settings.array == kind.array || names_json(settings.array)) return;
  throw InputError(
      fmt::format("--array {} contradicts --device {}, whose transducers are {}; leave --array "
                  "out, or give a file (.json) with those of your units",
                  settings.array, settings.device, kind.array));
}

}  // namespace

std::string doubt_of_array(const PipelineSettings& settings) {
  const DeviceKind& kind = *device_named(settings.device).kind;
  if (kind.array == nullptr || settings.array == kind.array) return {};
  const std::size_t of_unit = array_from_name(kind.array).position.size(),
                    given = settings.transducers.position.size();
  if (given % of_unit == 0) return {};
  return fmt::format(
      "{} has {} transducers, but the units of --device {} have {} each: focal points may not be "
      "as "
      "wide as the planner assumes.",
      settings.array, given, settings.device, of_unit);
}

PipelineSettings make_settings(const CommonOptions& options,
                               const std::optional<std::string>& scene, bool plays) {
  PipelineSettings settings;
  GivenSettings given;
  if (!options.settings_file.empty())
    given = read_settings(options.settings_file, settings_groups(settings));
  for (const std::string& sentence : given.warnings) warn(sentence);
  if (options.world) settings.world = *options.world;
  const WorldKind& world = world_named(settings.world);
  if (settings.world != PipelineSettings().world && !given.has("pipeline.scene"))
    choose_world(world, settings);
  if (scene) settings.scene = *scene;
  if (options.device) settings.device = *options.device;
  if (options.array) settings.array = *options.array;
  if (options.tracker) settings.tracker = *options.tracker;
  if (!options.settings_file.empty()) check_files_of(settings, options);
  const bool is_array_chosen = options.array || given.has("pipeline.array");
  if (plays) {
    settle_array(settings, is_array_chosen);
  } else {
    settings.transducers = array_from_name(settings.array);
  }
  settings.X_DT = tracker_pose_from_name(settings.tracker);
  check_bounds(options, settings);
  if (options.seed) settings.plan.seed = settings.scripted_hand.seed = *options.seed;
  if (options.method) settings.method = from_name<Method>(*options.method, "--method");
  const bool is_am = settings.method == Method::Am;
  const bool gives_width =
      given.has("pipeline.array_width") || given.has(is_am ? "am.sigma" : "plan.sigma");
  if (!gives_width && (plays || options.array)) settings.array_width = true;
  if (options.preset) settings.plan.preset = from_name<Preset>(*options.preset, "--preset");
  if (options.paths) settings.plan.paths = settings.am.foci = settings.emit.foci = *options.paths;
  if (options.budget_ms) settings.plan.budget = 1e-3 * *options.budget_ms;
  if (options.grid) settings.fluid.cells = *options.grid;
  if (is_am && (options.preset || options.budget_ms)) {
    throw InputError("--preset and --budget-ms belong to --method pro-stm; am has neither");
  }
  return settings;
}

void obey_lock_memory(bool asked, std::FILE* out) {
  if (!asked) return;
  fmt::print(out, "{}\n{}\n",
             lock_memory() ? "All memory is locked: none of it can be swapped out."
                           : memory_sentence(false),
             priority_sentence(realtime_limits().priority));
  std::fflush(out);
}

bool names_json(const std::string& name) {
  return name.ends_with(".json");
}

bool names_tracker(const std::string& hand) {
  return hand == "openxr" || hand.starts_with("leap:");
}

bool names_recording(const std::string& hand) {
  return hand != "scripted" && hand != "study" && hand != "page" && !names_tracker(hand);
}

std::string hint_for_hand(const std::string& hand) {
  const std::string word = lower_case(hand);
  const bool is_file = word.find_first_of("./") != word.npos;
  if (!is_file && word.find("leap") != word.npos)
    return "; did you mean \"leap://127.0.0.1:6437\"?";
  return did_you_mean(hand, {"scripted", "study", "page", "openxr"});
}

FocusMethod solver_of(const std::string& name) {
  return from_name<FocusMethod>(name, "--solver");
}

void settle_hand(const std::string& hand, std::optional<double> size, PipelineSettings& settings) {
  if (hand == "study") {
    if (size) settings.study_hand.size = *size;
    require_bounds(settings.study_hand);
    settings.jets.place = JetPlace::Hand;
  } else if (size) {
    throw InputError("--hand-size belongs to --hand study; --hand " + hand + " has its own size");
  }
}

std::unique_ptr<HandSource> make_hands(const std::string& name, const PipelineSettings& settings) {
  if (name == "scripted") return make_scripted_hand(settings.scripted_hand, settings.track);
  if (name == "study") return make_study_hand(settings.study_hand);
  if (!names_recording(name)) {
    if (!settings.devices.of<SimulatedArraySettings>().realtime) {
      throw InputError("--hand " + name +
                       " is live, so it needs prostm run in real time, without "
                       "--as-fast-as-possible and --stepped");
    }
    if (name == "page") return make_absent_hand();
    return make_live_hand(
        name == "openxr" ? make_openxr_tracker() : make_leap_tracker(leap_address(name)),
        settings.track);
  }
  // in real time a recording is played like a tracker, of which only past frames are known
  const auto make = settings.devices.of<SimulatedArraySettings>().realtime ? make_replayed_hand
                                                                           : make_recorded_hand;
  Progress progress("reading " + name);
  HandRecording recording = read_hand_recording(name, [&](std::size_t done, std::size_t all) {
    progress.show(1e-6 * static_cast<double>(done), 1e-6 * static_cast<double>(all), "MB");
  });
  return make(std::move(recording), settings.track, true, 1.0 / settings.world_rate);
}

void check_mode(const PipelineSettings& settings, RunMode mode) {
  const DeviceInfo device = settings.device_info();
  const std::string problem = mode_problem(device, mode);
  if (!problem.empty()) throw InputError("--device " + settings.device + problem);
}

bool never_came(const std::optional<TrackerStatus>& tracker) {
  return tracker && tracker->frames == 0;
}

namespace {

/// True also for a failure to create a thread, which needs memory for its stack.
bool lacks_memory(const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) return true;
  const auto* system = dynamic_cast<const std::system_error*>(&error);
  return system != nullptr && (system->code() == std::errc::resource_unavailable_try_again ||
                               system->code() == std::errc::not_enough_memory);
}

}  // namespace

std::string sentence_of(const std::exception_ptr& failure) {
  try {
    std::rethrow_exception(failure);
  } catch (const InputError& error) {
    return error.what();
  } catch (const std::invalid_argument& error) {
    return error.what();
  } catch (const std::exception& error) {
    if (!lacks_memory(error)) return std::string("unexpected: ") + error.what();
    return "there is not enough memory for this; free some, raise its limit (ulimit -v), or ask "
           "for "
           "less, such as a smaller --grid or field";
  } catch (...) {
    return "unexpected: something that is no std::exception was thrown";
  }
}

int tell(const std::exception_ptr& failure) {
  std::fprintf(stderr, "prostm: %s\n", sentence_of(failure).c_str());
  try {
    std::rethrow_exception(failure);
  } catch (const InputError&) {
    return kBadInput;
  } catch (const std::invalid_argument&) {
    return kBadInput;
  } catch (const std::exception& error) {
    return lacks_memory(error) ? kBadInput : 1;
  } catch (...) {
    return 1;
  }
}

void warn(const std::string& sentence) {
  std::fprintf(stderr, "prostm: warning: %s\n", sentence.c_str());
}

void warn_of(const HandSource& hands) {
  if (hands.reading() == nullptr) return;
  for (const std::string& sentence : unusual_in(*hands.reading())) warn(sentence);
}

std::FILE* prose(const std::string& json_option) {
  return json_option == "-" ? stderr : stdout;
}

void say_written(std::FILE* out, const std::string& path) {
  if (!path.empty() && path != "-") fmt::print(out, "wrote {}\n", path);
}

void flush(std::FILE* out) {
  const int error = std::fflush(out) == 0 ? 0 : errno;
  if (error == 0 && std::ferror(out) == 0) return;
  std::clearerr(out);  // reported once
  throw InputError(
      fmt::format("standard {} cannot be written ({})", out == stdout ? "output" : "error",
                  error != 0 ? std::generic_category().message(error) : "a write before failed"));
}

void write_json(const std::string& json_option, nlohmann::ordered_json value) {
  if (json_option.empty()) return;
  if (value.is_object()) value["prostm"] = version_text();
  write_file(json_option, to_text(value));
}

void pause(double seconds) {
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

nlohmann::ordered_json device_json(const DeviceInfo& device) {
  return {{"name", device.name},
          {"sample_rate_hz", device.sample_rate},
          {"block_ms", 1e3 * device.block_time()}};
}

nlohmann::ordered_json to_json(const Summary& s, double unit) {
  if (s.n == 0)
    return {{"n", 0}, {"mean", nullptr}, {"p50", nullptr}, {"p99", nullptr}, {"max", nullptr}};
  return {{"n", s.n},
          {"mean", s.mean * unit},
          {"p50", s.p50 * unit},
          {"p99", s.p99 * unit},
          {"max", s.max * unit}};
}

void print_warnings(std::FILE* out, const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) fmt::print(out, "warning: {}\n", warning);
}

std::string thousandths(double value) {
  return fmt::format("{:.3f}", std::round(1e3 * value) / 1e3 + 0.0);  // -0 + 0 is 0
}

std::string felt_words(const PipelineSettings& settings) {
  const bool am = settings.method == Method::Am;
  if (!am && settings.plan.traits().chooses_by_percept) {
    return fmt::format(
        "number of paths, points and pressures chosen by what the model of the skin feels "
        "(plan.strength_weight {:g}); nobody has felt it",
        settings.plan.strength_weight);
  }
  if (!am || settings.am.felt_weight == 0.0) return {};
  return fmt::format(
      "pressures and phases chosen by what the model of the skin feels (am.felt_weight {:g}); "
      "nobody has felt it",
      settings.am.felt_weight);
}

void print_metrics(std::FILE* out, const std::string& heading,
                   const std::vector<MetricsRow>& rows) {
  std::vector<const Quantity<Metrics>*> columns;
  for (const Quantity<Metrics>& metric : quantities<Metrics>()) {
    if (std::ranges::any_of(rows, [&](const MetricsRow& row) {
          return std::isfinite(value_of(metric, row.metrics));
        })) {
      columns.push_back(&metric);
    }
  }
  fmt::print(out, "  {:<44}", heading);
  for (const Quantity<Metrics>* column : columns) fmt::print(out, " {:>7}", column->label);
  for (const MetricsRow& row : rows) {
    fmt::print(out, "\n  {:<44}", row.name);
    for (const Quantity<Metrics>* column : columns) {
      const double value = value_of(*column, row.metrics);
      fmt::print(out, " {:>7}", std::isfinite(value) ? thousandths(value) : "–");
    }
  }
  fmt::print(out, "\n");
}

}  // namespace prostm::app
