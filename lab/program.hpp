#pragma once
/// The main() of benchmarks and labs that have options.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "report.hpp"

namespace prostm::bench {

/// The options of a program, and its rows. Options keep their values as defaults, which --help
/// shows.
class Program {
 public:
  explicit Program(const std::string& help);
  ~Program();

  /// Adds an option, or, if the name has no dashes, the arguments that no option takes.
  void option(const std::string& name, std::string& value, const std::string& help);
  void option(const std::string& name, int& value, const std::string& help);
  void option(const std::string& name, double& value, const std::string& help);
  void option(const std::string& name, std::vector<std::string>& values, const std::string& help);
  void option(const std::string& name, std::vector<int>& values, const std::string& help);
  void option(const std::string& name, std::vector<double>& values, const std::string& help);
  /// Adds an option with bounds, inclusive.
  void option(const std::string& name, int& value, const std::string& help, int low, int high);
  void option(const std::string& name, double& value, const std::string& help, double low,
              double high);
  void flag(const std::string& name, bool& value, const std::string& help);

  /// Reads the options and --json FILE; prints and writes the rows that `measure` returns.
  /// @return 0, or 2 after a message about bad input.
  int run(int argc, char** argv, const std::function<std::vector<Row>()>& measure);

 private:
  struct Parser;
  std::unique_ptr<Parser> parser_;
};

}  // namespace prostm::bench
