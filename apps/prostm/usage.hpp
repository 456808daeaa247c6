#pragma once
/// Messages about a command line that cannot be parsed, and help on request.

#include <string>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace prostm::app {

/// One sentence about what is wrong with the command line, with the help page to read.
/// @param program the parser after it threw `error`.
std::string usage_sentence(const CLI::App& program, const CLI::ParseError& error);

/// The help page of a command, or of the whole program for an empty name.
/// @throws InputError for a command that is unknown.
std::string help_page(const CLI::App& program, const std::string& command);

}  // namespace prostm::app
