#include "add_options.hpp"

#include <utility>

#include "common.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/device/device_kinds.hpp"
#include "prostm/figure/figures.hpp"
#include "prostm/pipeline/world_kinds.hpp"
#include "prostm/plan/preset.hpp"

namespace prostm::app {

void set_work(Command command, Work& work, const Files& files, std::function<int()> run) {
  command.callback([&work, &files, run = std::move(run)] { work = {&files, run}; });
}

Option add_input(Command command, Files& files, const std::string& name, OptionValue value,
                 const std::string& help) {
  return command.add_option(name, value, help)
      .type_name("INPUT")
      .each([&files, name](const std::string& path) { files.reads(name, path); });
}

Option add_input_or_name(Command command, Files& files, const std::string& name, OptionValue value,
                         bool (*is_file)(const std::string&), const std::string& help,
                         std::string (*hint)(const std::string&)) {
  return command.add_option(name, value, help)
      .type_name("NAME|INPUT")
      .each([&files, name, is_file, hint](const std::string& path) {
        if (is_file(path)) files.reads(name, path, hint != nullptr ? hint(path) : std::string());
      });
}

Option add_output(Command command, Files& files, const std::string& name, OptionValue value,
                  Files::Check check, const std::string& help) {
  return command.add_option(name, value, help)
      .type_name("OUTPUT")
      .each([&files, name, check](const std::string& path) { files.writes(name, path, check); });
}

Option add_name(Command command, const std::string& name, OptionValue value,
                const std::string& help) {
  return command.add_option(name, value, help).type_name("NAME");
}

void add_json(Command command, Files& files, std::string& json) {
  add_output(command, files, "--json", json, check_json_output,
             "write the result as JSON; - is standard output");
}

void add_common(Command command, CommonOptions& o) {
  add_input(command, o.files, "--settings", o.settings_file,
            "settings of any stage, a TOML file (docs/reference/files.md)");
  add_json(command, o.files, o.json);
  command.add_option("--seed", o.seed, "random seed");
  add_name(command, "--preset", o.preset, preset_choices());
  command.add_option("--paths", o.paths, "number of focal points, 1 to 8");
  command.add_option("--budget-ms", o.budget_ms,
                     "time budget for each plan of preset best or felt; 0: a fixed amount of work");
  add_name(command, "--method", o.method,
           "pro-stm (default): paths, or am: foci that stand still, modulated (docs/guides/am.md)");
}

void add_array(Command command, CommonOptions& o, const std::string& help) {
  add_input_or_name(command, o.files, "--array", o.array, names_json, help);
}

void add_device(Command command, CommonOptions& o) {
  std::string forms;
  for (const DeviceKind& kind : device_kinds()) {
    if (kind.is_built()) forms += (forms.empty() ? "" : ", ") + form_of(kind);
  }
  add_name(command, "--device", o.device,
           "output device: " + forms + "; default: sim; see prostm devices");
}

void add_lock_memory(Command command, bool& lock_memory) {
  command.add_flag("--lock-memory", lock_memory,
                   "keep all memory from being swapped out, and print whether this and real-time "
                   "priority are allowed");
}

Option add_figure(Command command, CommonOptions& o, const std::string& help) {
  return add_output(command, o.files, "--figure", o.figure, prostm::check_figure, help);
}

void add_field_file(Command command, prostm::FieldFileOptions& o, std::optional<Option> of) {
  auto cell =
      command.add_option("--cell-mm", o.cell_mm, "edge of a cell of a .npy, .npz or .png field");
  auto width = command.add_option("--width-mm", o.width_mm, "instead: width of the whole field");
  width.excludes(cell);
  auto invert = command.add_flag("--invert", o.invert, "the .png field is drawn black on white");
  auto frame = command.add_option("--frame", o.frame,
                                  "frame of a .h5 recording (default: 0) or of a 3-D array");
  auto variable =
      add_name(command, "--variable", o.variable, "array of a .npz file that holds several");
  if (!of) return;
  for (Option option : {cell, width, invert, frame, variable}) option.needs(*of);
}

void add_hand(Command command, CommonOptions& common, std::string& hand,
              std::optional<double>& hand_size) {
  add_input_or_name(
      command, common.files, "--hand", hand, names_recording,
      "a recording (.hands.jsonl, or Leap JSON), scripted, study, leap://HOST:PORT, openxr, or "
      "page (docs/guides/hands.md)",
      hint_for_hand)
      .show_default();
  command.add_option("--hand-size", hand_size,
                     "with --hand study: all lengths over those of an average hand, 0.7 to 1.3");
  add_input_or_name(command, common.files, "--tracker", common.tracker, names_json,
                    "pose of the tracker: centre (default), ultraleap-kit or another kit, or a "
                    "pose file (.json)");
}

void add_pipeline(Command command, CommonOptions& common, std::optional<std::string>& scene,
                  std::string& hand, std::optional<double>& hand_size) {
  add_common(command, common);
  add_name(command, "--world", common.world,
           "source of the pressure on the hands: " + world_choices());
  add_name(command, "--scene", scene, scene_choices());
  add_hand(command, common, hand, hand_size);
  command.add_option("--grid", common.grid, "cells along each edge of the fluid's box");
  add_array(command, common);
}

std::array<Option, 3> add_address(Command command, RunOptionsGiven& o) {
  auto port =
      command.add_option("--view-port", o.view_port,
                         "port of the page, 0 for any; default: 8470, or the next free one");
  auto address =
      command
          .add_option("--view-address", o.view_address,
                      "address to serve the page on; default: 127.0.0.1, this machine alone")
          .type_name("ADDRESS");
  auto host = command
                  .add_option("--view-host", o.view_hosts,
                              "name of this machine, or of a proxy, under which the page may be "
                              "opened; may be given several times")
                  .type_name("NAME")
                  .repeatable();
  return {port, address, host};
}

void add_unbuilt(Command app, const std::string& name, const std::string& help) {
  auto command = app.add_command(name, help + " (not built yet)");
  command.accept_any_words();
  command.callback([name, parent = app.name()] {
    throw InputError("prostm " + (parent.empty() ? "" : parent + ' ') + name +
                     " is not built yet in this version");
  });
}

}  // namespace prostm::app
