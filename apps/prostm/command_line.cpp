#include "command_line.hpp"

#include <CLI/CLI.hpp>

#include "prostm/core/input_error.hpp"
#include "usage.hpp"

namespace prostm::app {
namespace {

/// Returns a whole number without leading zeros: 010 is ten. The parser would read it as octal, so
/// that participant 010 would be participant 8.
std::string decimal(std::string text) {
  const std::size_t sign = text.find_first_of("+-") == 0 ? 1 : 0;
  const bool is_decimal = text.find_first_not_of("0123456789", sign) == std::string::npos;
  while (is_decimal && text.size() > sign + 1 && text[sign] == '0') text.erase(sign, 1);
  return text;
}

}  // namespace

Option Option::required() const {
  return Option(*option_->required());
}

Option Option::needs(Option other) const {
  return Option(*option_->needs(other.option_));
}

void Option::exclude(Option other) const {
  option_->excludes(other.option_);
}

Option Option::type_name(const std::string& name) const {
  return Option(*option_->type_name(name));
}

Option Option::show_default() const {
  return Option(*option_->capture_default_str());
}

Option Option::show_default(const std::string& text) const {
  return Option(*option_->default_str(text));
}

Option Option::each(const std::function<void(const std::string&)>& take) const {
  return Option(*option_->each(take));
}

Option Option::repeatable() const {
  return Option(*option_->expected(1)->allow_extra_args(false)->take_all());
}

Command Command::add_command(const std::string& name, const std::string& help) const {
  return Command(*parser_->add_subcommand(name, help));
}

Option Command::add_option(const std::string& name, OptionValue value,
                           const std::string& help) const {
  CLI::Option* option = std::visit(
      [&](auto variable) { return parser_->add_option(name, variable.get(), help); }, value);
  const std::string type = option->get_type_name();
  if (type == "INT" || type == "UINT") option->transform(decimal);
  return Option(*option);
}

Option Command::add_option(const std::string& name,
                           const std::function<void(const std::string&)>& take,
                           const std::string& help) const {
  return Option(*parser_->add_option_function<std::string>(name, take, help));
}

Option Command::add_flag(const std::string& name, bool& value, const std::string& help) const {
  return Option(*parser_->add_flag(name, value, help));
}

Option Command::add_default_flag(const std::string& name, const std::string& help) const {
  return Option(*parser_->add_flag_callback(
      name, [] {}, help));
}

Option Command::option(const std::string& name) const {
  return Option(*parser_->get_option(name));
}

void Command::footer(const std::string& text) const {
  parser_->footer(text);
}

void Command::group(const std::string& title) const {
  parser_->group(title);
}

void Command::callback(const std::function<void()>& parsed) const {
  parser_->callback(parsed);
}

void Command::require_command() const {
  parser_->require_subcommand(1);
}

void Command::accept_any_words() const {
  parser_->prefix_command();
}

std::string Command::name() const {
  return parser_->get_name();
}

std::vector<Command> Command::commands() const {
  std::vector<Command> commands;
  for (CLI::App* command : parser_->get_subcommands({})) commands.emplace_back(*command);
  return commands;
}

std::string Command::help_page(const std::string& command) const {
  return app::help_page(*parser_, command);
}

CommandLine::CommandLine(const std::string& help, const std::string& version)
    : parser_(std::make_unique<CLI::App>(help)) {
  parser_->set_version_flag("--version", version);
  parser_->require_subcommand(1);
}

CommandLine::~CommandLine() = default;

bool CommandLine::parse(int argc, char** argv) const {
  try {
    parser_->parse(argc, argv);
    return true;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != static_cast<int>(CLI::ExitCodes::Success))
      throw InputError(usage_sentence(*parser_, error));
    parser_->exit(error);
    return false;
  }
}

}  // namespace prostm::app
