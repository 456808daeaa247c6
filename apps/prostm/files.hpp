#pragma once
/// The files that a command line names: what may be read, and what may be written.

#include <string>
#include <vector>

#include "prostm/core/file/file.hpp"

namespace prostm::app {

/// Every file that a command reads or writes, checked together before it does anything: an output
/// that is an input or another output would destroy it. Options register their files as they are
/// parsed (see main.cpp), and settings those that they name (see make_settings).
class Files {
 public:
  using Check = void (*)(const std::string& path);

  /// @param option names the file in messages, e.g. "--hand". @param hint the end of the sentence
  /// about a file that cannot be read: what may have been meant instead.
  void reads(const std::string& option, const std::string& path, std::string hint = {});
  /// @param also a further check before the work. @param of prefix of an input's option; the output
  /// may be that input's file, which the command updates.
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
    std::string hint;
  };
  std::vector<Entry> entries_;
};

/// Checks a file for JSON. @throws InputError: it cannot be written, or its name ends like another
/// kind of file.
void check_json_output(const std::string& path);
/// The same for a table, whose name must end in .csv.
void check_csv_output(const std::string& path);
/// The same for a pose file, whose name must end in .json: --tracker takes no other.
void check_pose_output(const std::string& path);

}  // namespace prostm::app
