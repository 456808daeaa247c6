/// The options of prostm bench.

#include "add_options.hpp"
#include "common.hpp"

namespace prostm::app {
namespace {

void add_bench(Command app, Work& work) {
  auto command = app.add_command("bench", "the paper's Table I on recorded fields");
  auto o = std::make_shared<BenchOptionsGiven>();
  add_common(command, o->common);
  add_input(command, o->common.files, "files", o->files,
            "recordings (.h5) of prostm capture or prostm run --record")
      .required();
  command.add_option("--repeats", o->repeats, "runs of each field, of which the median counts")
      .show_default();
  command.footer("Example:\n  prostm bench one-plume.h5 --json table1.json");
  set_work(command, work, o->common.files, [o] { return bench_command(*o); });
}

}  // namespace

void add_bench_commands(Command app, Work& work) {
  add_bench(app, work);
}

}  // namespace prostm::app
