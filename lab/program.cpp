#include "program.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <stdexcept>

#include "prostm/core/input_error.hpp"

namespace prostm::bench {

struct Program::Parser {
  explicit Parser(const std::string& help) : app(help) {}

  template <class T>
  CLI::Option* add(const std::string& name, T& value, const std::string& help) {
    return app.add_option(name, value, help)->capture_default_str();
  }
  template <class T>
  void add_list(const std::string& name, std::vector<T>& values, const std::string& help) {
    CLI::Option* option = app.add_option(name, values, help);
    if (!values.empty()) option->capture_default_str();
  }

  CLI::App app;
};

Program::Program(const std::string& help) : parser_(std::make_unique<Parser>(help)) {}

Program::~Program() = default;

void Program::option(const std::string& name, std::string& value, const std::string& help) {
  parser_->add(name, value, help);
}

void Program::option(const std::string& name, int& value, const std::string& help) {
  parser_->add(name, value, help);
}

void Program::option(const std::string& name, double& value, const std::string& help) {
  parser_->add(name, value, help);
}

void Program::option(const std::string& name, std::vector<std::string>& values,
                     const std::string& help) {
  parser_->add_list(name, values, help);
}

void Program::option(const std::string& name, std::vector<int>& values, const std::string& help) {
  parser_->add_list(name, values, help);
}

void Program::option(const std::string& name, std::vector<double>& values,
                     const std::string& help) {
  parser_->add_list(name, values, help);
}

void Program::option(const std::string& name, int& value, const std::string& help, int low,
                     int high) {
  parser_->add(name, value, help)->check(CLI::Range(low, high));
}

void Program::option(const std::string& name, double& value, const std::string& help, double low,
                     double high) {
  parser_->add(name, value, help)->check(CLI::Range(low, high));
}

void Program::flag(const std::string& name, bool& value, const std::string& help) {
  parser_->app.add_flag(name, value, help);
}

int Program::run(int argc, char** argv, const std::function<std::vector<Row>()>& measure) {
  std::string json;
  option("--json", json, "write the rows as JSON");
  try {
    parser_->app.parse(argc, argv);
    return print_and_write(measure(), json);
  } catch (const CLI::CallForHelp&) {
    fmt::print("{}", parser_->app.help());
    return 0;
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "{}: {}\n", argv[0], error.what());
  } catch (const InputError& error) {
    fmt::print(stderr, "{}: {}\n", argv[0], error.what());
  } catch (const std::invalid_argument& error) {  // a name or a setting
    fmt::print(stderr, "{}: {}\n", argv[0], error.what());
  }
  return 2;
}

}  // namespace prostm::bench
