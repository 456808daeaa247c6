/// Whole commands on large input, program start and files included.

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "program.hpp"
#include "prostm/core/file/file.hpp"
#include "prostm/core/random.hpp"
#include "prostm/core/stage_timer.hpp"

namespace prostm::bench {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string program = PROSTM_PROGRAM;
  std::string against;
  int rounds = 5;
};

/// A folder for the files of the commands, removed at the end.
class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "prostm-bench-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw InputError(name + " cannot be made");
    path_ = name;
  }
  ~Folder() { fs::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  fs::path path_;
};

/// Writes a ring of pressure of 22 mm radius as a square of doubles.
void write_ring(const std::string& path, int side, double cell) {
  std::string header =
      fmt::format("{{'descr': '<f8', 'fortran_order': False, 'shape': ({0}, {0}), }}", side);
  header.resize(117, ' ');
  std::string bytes =
      std::string("\x93NUMPY\x01\x00", 8) + std::string("\x76\x00", 2) + header + "\n";
  for (int row = 0; row < side; ++row) {
    for (int col = 0; col < side; ++col) {
      const double middle = 0.5 * (side - 1);
      const double r = cell * std::hypot(row - middle, col - middle);
      const double pressure = std::exp(-std::pow((r - 22e-3) / 5e-3, 2));
      char value[sizeof pressure];
      std::memcpy(value, &pressure, sizeof pressure);
      bytes.append(value, sizeof value);
    }
  }
  write_file(path, bytes);
}

void write_answers(const std::string& path, int participants, int answers) {
  Random random(1);
  std::string text = "participant,method,scene,correct\n";
  for (int p = 0; p < participants; ++p) {
    for (int i = 0; i < answers; ++i) {
      text += fmt::format("p{},{},{},{}\n", p, i % 2 == 0 ? "am" : "pro-stm",
                          i / 2 % 2 == 0 ? "one" : "four", random.uniform(0.0, 1.0) < 0.7 ? 1 : 0);
    }
  }
  write_file(path, text);
}

/// Runs a program without output. @return the time that it took [s]
/// @throws InputError if it fails.
double time_of(const std::string& program, const std::vector<std::string>& arguments) {
  std::vector<char*> argv = {const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  posix_spawn_file_actions_t quiet;
  posix_spawn_file_actions_init(&quiet);
  posix_spawn_file_actions_addopen(&quiet, 1, "/dev/null", O_WRONLY, 0);
  StageTimer timer;
  pid_t child = 0;
  const int wrong = posix_spawn(&child, program.c_str(), &quiet, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&quiet);
  int status = 0;
  if (wrong != 0 || waitpid(child, &status, 0) != child || status != 0)
    throw InputError(fmt::format("{} {} failed", program, fmt::join(arguments, " ")));
  return timer.seconds();
}

struct Command {
  std::string name;
  std::vector<std::string> arguments;
};

/// Writes the input of all commands.
std::vector<Command> commands(const Folder& folder, const std::string& program) {
  std::vector<Command> out;
  const auto add_plan = [&](int side, double cell_mm, const std::vector<std::string>& more) {
    const std::string ring = folder.file(fmt::format("ring{}.npy", side));
    write_ring(ring, side, 1e-3 * cell_mm);
    Command command{fmt::format("plan of {0} × {0}", side),
                    {"plan", ring, "--cell-mm", fmt::format("{}", cell_mm)}};
    for (const std::string& word : more) {
      command.arguments.push_back(word);
      command.name += " " + word;
    }
    out.push_back(command);
  };
  const auto add_field = [&](int side, double cell_mm) {
    const std::string ring = folder.file(fmt::format("ring{}.npy", side));
    const std::string plan = folder.file(fmt::format("ring{}.plan.json", side));
    write_ring(ring, side, 1e-3 * cell_mm);
    const std::string cell = fmt::format("{}", cell_mm);
    time_of(program, {"plan", ring, "--cell-mm", cell, "--json", plan});
    out.push_back({fmt::format("field of {0} × {0} of {1} mm", side, cell),
                   {"field", plan, "--field", ring, "--cell-mm", cell}});
  };
  add_plan(1000, 0.15, {});
  add_plan(64, 2.0, {"--array", "usx"});
  add_field(64, 2.0);
  add_field(128, 1.0);
  add_field(400, 0.35);
  const std::string answers = folder.file("answers.csv");
  write_answers(answers, 200, 500);
  out.push_back({"study analyse, 200 people × 500 answers", {"study", "analyse", answers}});
  return out;
}

std::vector<Row> measure(const Options& options) {
  const Folder folder;
  std::vector<Row> rows;
  for (const Command& command : commands(folder, options.program)) {
    Distribution ours, theirs;
    for (int round = 0; round < options.rounds; ++round) {
      ours.add(time_of(options.program, command.arguments));
      if (!options.against.empty()) theirs.add(time_of(options.against, command.arguments));
    }
    Row row{"commands/" + command.name, "s", ours.summary(), "", 0.0};
    if (!options.against.empty()) {
      row.baseline = "the other program";
      row.baseline_p50 = theirs.summary().p50;
    }
    rows.push_back(row);
  }
  return rows;
}

}  // namespace
}  // namespace prostm::bench

int main(int argc, char** argv) {
  using namespace prostm::bench;
  Program program("Whole commands on large input: time from program start to end");
  Options options;
  program.option("--program", options.program, "path of the prostm to measure");
  program.option("--against", options.against, "path of another prostm, measured in turn");
  program.option("--rounds", options.rounds, "runs of each command", 1, 100);
  return program.run(argc, argv, [&] { return measure(options); });
}
