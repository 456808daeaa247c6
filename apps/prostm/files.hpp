#pragma once
/// The files that a command line names: what may be read, and what may be written.

#include <string>
#include <vector>

#include "prostm/core/file.hpp"

namespace prostm::app {

/// Every file that a command reads or writes, checked together before it does anything: an output
/// that is an input or another output would destroy it. Options register their files as they are
/// parsed (see main.cpp), and settings those that they name (see make_settings).
class Files {
 public:
  using Check = void (*)(const std::string& path);

  /// @param option names the file in messages, e.g. "--hand". @param names what the option takes
  /// besides files: one of them may have been meant.
  void reads(const std::string& option, const std::string& path,
             std::vector<std::string> names = {});
  /// @param also what else must hold before the work, if anything. @param of how the option of an
  /// input begins that the output may be: a file that the command brings up to date.
  void writes(const std::string& option, const std::string& path, Check also = check_writable,
              const std::string& of = {});
  /// @throws InputError: an input that cannot be read, an output that is another file of the
  /// command, or cannot be written.
  void check() const;
  /// Whether the command writes a file besides standard output.
  bool any_output() const;

 private:
  struct Entry {
    std::string option, path;
    Check check;
    bool output;
    std::string of;
    std::vector<std::string> names;
  };
  std::vector<Entry> entries_;
};

}  // namespace prostm::app
