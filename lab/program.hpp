#pragma once
/// The main() of benchmarks that have options.

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "report.hpp"

namespace prostm::bench {

/// Reads the options of `app` and --json FILE; prints and writes the rows that `measure` returns.
/// @return 0, or 2 after a message about bad input.
template <class Measure>
int run(CLI::App& app, int argc, char** argv, Measure measure) {
  std::string json;
  app.add_option("--json", json, "write the rows as JSON");
  try {
    app.parse(argc, argv);
    return print_and_write(measure(), json);
  } catch (const CLI::CallForHelp&) {
    fmt::print("{}", app.help());
    return 0;
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "{}: {}\n", argv[0], error.what());
  } catch (const InputError& error) {
    fmt::print(stderr, "{}: {}\n", argv[0], error.what());
  }
  return 2;
}

}  // namespace prostm::bench
