/// The options of prostm devices, levels and selftest.

#include "add_options.hpp"
#include "common.hpp"

namespace prostm::app {
namespace {

void add_devices(Command app, Work& work) {
  auto command =
      app.add_command("devices", "list devices and sources of hands: found, missing or not built");
  auto o = std::make_shared<DevicesOptionsGiven>();
  add_name(command, "names", o->names,
           "check only these, also on other machines: a device with its address, "
           "leap://HOST:PORT, or openxr; default: all that this machine has");
  add_json(command, o->files, o->json);
  command.add_flag("--budget", o->budget, "print only a table of what a link to AUTD3 can carry");
  command.footer("Example:\n  prostm devices");
  set_work(command, work, o->files, [o] { return devices_command(*o); });
}

void add_levels(Command app, Work& work) {
  auto command = app.add_command(
      "levels",
      "levels of an array at focal points and at the head, with caps and published limits");
  auto o = std::make_shared<LevelsOptionsGiven>();
  add_array(command, o->common);
  add_input(command, o->common.files, "--settings", o->common.settings_file,
            "settings; the caps are in [safety] (docs/devices/safety.md)");
  add_json(command, o->common.files, o->common.json);
  command.footer("Example:\n  prostm levels --array autd3");
  set_work(command, work, o->common.files, [o] { return levels_command(*o); });
}

void add_selftest(Command app, Work& work) {
  auto command = app.add_command(
      "selftest", "test a connected device with figures for a hand to feel; asks before it plays");
  auto o = std::make_shared<SelftestOptionsGiven>();
  add_input(command, o->common.files, "--settings", o->common.settings_file,
            "settings of any stage, a TOML file (docs/reference/files.md)");
  add_json(command, o->common.files, o->common.json);
  add_device(command, o->common);
  add_array(command, o->common,
            array_choices() + "; default: the device's, or " + array_kinds().front().name);
  add_figure(command, o->common, "a picture of the array, seen from above (.png, .svg or .pdf)");
  command.add_option("--seconds", o->seconds, "duration of each figure, 0.2 to 60").show_default();
  command
      .add_option("--height-mm", o->height_mm, "height of the figures above the array, 50 to 500")
      .show_default();
  command.add_option("--level", o->level, "largest intensity, 0.05 to 1").show_default();
  auto yes = command.add_flag("--yes", o->yes, "play without being asked");
  command.add_flag("--silent", o->silent, "connect, and play nothing").excludes(yes);
  command.footer("Example:\n  prostm selftest --silent --figure array.png");
  set_work(command, work, o->common.files, [o] { return selftest_command(*o); });
}

}  // namespace

void add_devices_commands(Command app, Work& work) {
  add_devices(app, work);
  add_levels(app, work);
  add_selftest(app, work);
}

}  // namespace prostm::app
