#pragma once
/// The parser of the command line. Its library, CLI11, is seen by two sources alone: its headers
/// and templates take ten seconds in each.

#include <concepts>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace prostm::app {

template <class... Types>
using ReferenceToOneOf = std::variant<std::reference_wrapper<Types>...>;
/// The variable that an option sets.
using OptionValue =
    ReferenceToOneOf<std::string, std::optional<std::string>, std::vector<std::string>, int,
                     std::optional<int>, std::uint64_t, double, std::optional<double>>;

/// An option of a command; copies are the same option.
class Option {
 public:
  explicit Option(CLI::Option& option) : option_(&option) {}

  Option required() const;
  Option needs(Option other) const;
  template <std::same_as<Option>... Others>
  Option excludes(Others... others) const {
    (exclude(others), ...);
    return *this;
  }
  /// Sets the word that stands for the value on the help page.
  Option type_name(const std::string& name) const;
  /// Shows a default on the help page: the value of the option's variable, or `text`.
  Option show_default() const;
  Option show_default(const std::string& text) const;
  /// Calls a function with each value as it is parsed.
  Option each(const std::function<void(const std::string&)>& take) const;
  /// Lets the option be given several times, each with one value.
  Option repeatable() const;

 private:
  void exclude(Option other) const;

  CLI::Option* option_;
};

/// A command, an inner command or the whole program; copies are the same command.
class Command {
 public:
  explicit Command(CLI::App& parser) : parser_(&parser) {}

  Command add_command(const std::string& name, const std::string& help) const;
  /// Adds an option, or, if the name has no dashes, arguments that no option takes. Whole numbers
  /// are read as decimal.
  Option add_option(const std::string& name, OptionValue value, const std::string& help) const;
  /// Adds an option that hands its value to a function.
  Option add_option(const std::string& name, const std::function<void(const std::string&)>& take,
                    const std::string& help) const;
  Option add_flag(const std::string& name, bool& value, const std::string& help) const;
  /// Adds a flag that asks for what happens anyway.
  Option add_default_flag(const std::string& name, const std::string& help) const;
  /// @pre the option exists.
  Option option(const std::string& name) const;

  /// Sets the end of the help page.
  void footer(const std::string& text) const;
  /// Sets the heading under which the program's help page lists the command.
  void group(const std::string& title) const;
  /// Sets what happens once the command's options are parsed.
  void callback(const std::function<void()>& parsed) const;
  void require_command() const;
  void accept_any_words() const;

  std::string name() const;
  std::vector<Command> commands() const;
  /// The help page of an inner command, or this one's for an empty name.
  /// @throws InputError for a command that is unknown.
  std::string help_page(const std::string& command) const;

 private:
  CLI::App* parser_;
};

/// The whole program's command line.
class CommandLine {
 public:
  /// @param version what --version prints.
  CommandLine(const std::string& help, const std::string& version);
  ~CommandLine();

  Command program() const { return Command(*parser_); }

  /// Parses arguments, and prints what --help and --version ask for. @return whether there is a
  /// command to run. @throws InputError for arguments that no command takes.
  bool parse(int argc, char** argv) const;

 private:
  std::unique_ptr<CLI::App> parser_;
};

}  // namespace prostm::app
