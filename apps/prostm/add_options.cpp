#include "add_options.hpp"

#include "common.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/device/device_kinds.hpp"
#include "prostm/figure/figures.hpp"
#include "prostm/pipeline/world_kinds.hpp"
#include "prostm/plan/preset.hpp"

namespace prostm::app {

void add_json(CLI::App& command, Files& files, std::string& json) {
  add_output(command, files, "--json", json, check_json_output,
             "write the result as JSON; - is standard output");
}

void add_common(CLI::App& command, CommonOptions& o) {
  add_input(command, o.files, "--settings", o.settings_file,
            "settings of any stage, a TOML file (docs/reference/files.md)");
  add_json(command, o.files, o.json);
  command.add_option("--seed", o.seed, "random seed");
  add_name(command, "--preset", o.preset, preset_choices());
  command.add_option("--paths", o.paths, "number of focal points, 1 to 8");
  command.add_option("--budget-ms", o.budget_ms,
                     "time budget for each plan of preset best; 0: a fixed amount of work");
  add_name(command, "--method", o.method,
           "pro-stm (default): paths, or am: foci that stand still, modulated (docs/guides/am.md)");
}

void add_array(CLI::App& command, CommonOptions& o, const std::string& help) {
  add_input_or_name(command, o.files, "--array", o.array, names_json, help);
}

void add_device(CLI::App& command, CommonOptions& o) {
  std::string forms;
  for (const DeviceKind& kind : device_kinds()) {
    if (kind.is_built()) forms += (forms.empty() ? "" : ", ") + form_of(kind);
  }
  add_name(command, "--device", o.device,
           "output device: " + forms + "; default: sim; see prostm devices");
}

void add_lock_memory(CLI::App& command, bool& lock_memory) {
  command.add_flag("--lock-memory", lock_memory,
                   "keep all memory from being swapped out, and print whether this and real-time "
                   "priority are allowed");
}

CLI::Option* add_figure(CLI::App& command, CommonOptions& o, const std::string& help) {
  return add_output(command, o.files, "--figure", o.figure, prostm::check_figure, help);
}

void add_field_file(CLI::App& command, prostm::FieldFileOptions& o, CLI::Option* of) {
  auto* cell =
      command.add_option("--cell-mm", o.cell_mm, "edge of a cell of a .npy, .npz or .png field");
  auto* width = command.add_option("--width-mm", o.width_mm, "instead: width of the whole field");
  width->excludes(cell);
  auto* invert = command.add_flag("--invert", o.invert, "the .png field is drawn black on white");
  auto* frame = command.add_option("--frame", o.frame,
                                   "frame of a .h5 recording (default: 0) or of a 3-D array");
  auto* variable =
      add_name(command, "--variable", o.variable, "array of a .npz file that holds several");
  if (of == nullptr) return;
  for (CLI::Option* option : {cell, width, invert, frame, variable}) option->needs(of);
}

void add_hand(CLI::App& command, CommonOptions& common, std::string& hand,
              std::optional<double>& hand_size) {
  add_input_or_name(
      command, common.files, "--hand", hand, names_recording,
      "a recording (.hands.jsonl, or Leap JSON), scripted, study, leap://HOST:PORT, openxr, or "
      "page (docs/guides/hands.md)",
      hint_for_hand)
      ->capture_default_str();
  command.add_option("--hand-size", hand_size,
                     "with --hand study: all lengths over those of an average hand, 0.7 to 1.3");
  add_input_or_name(command, common.files, "--tracker", common.tracker, names_json,
                    "pose of the tracker: centre (default), ultraleap-kit or another kit, or a "
                    "pose file (.json)");
}

void add_pipeline(CLI::App& command, CommonOptions& common, std::optional<std::string>& scene,
                  std::string& hand, std::optional<double>& hand_size) {
  add_common(command, common);
  add_name(command, "--world", common.world,
           "source of the pressure on the hands: " + world_choices());
  add_name(command, "--scene", scene, scene_choices());
  add_hand(command, common, hand, hand_size);
  command.add_option("--grid", common.grid, "cells along each edge of the fluid's box");
  add_array(command, common);
}

std::array<CLI::Option*, 2> add_address(CLI::App& command, RunOptionsGiven& o) {
  auto* port =
      command.add_option("--view-port", o.view_port,
                         "port of the page, 0 for any; default: 8470, or the next free one");
  auto* address =
      command
          .add_option("--view-address", o.view_address,
                      "address to serve the page on; default: 127.0.0.1, this machine alone")
          ->type_name("ADDRESS");
  return {port, address};
}

void add_unbuilt(CLI::App& app, const std::string& name, const std::string& help) {
  auto* command = app.add_subcommand(name, help + " (not built yet)");
  command->prefix_command();
  command->callback([name, parent = app.get_name()] {
    throw InputError("prostm " + (parent.empty() ? "" : parent + ' ') + name +
                     " is not built yet in this version");
  });
}

}  // namespace prostm::app
