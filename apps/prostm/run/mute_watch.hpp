#pragma once
/// Mutes of a run, told in its terminal and set by its keys.

#include <memory>
#include <optional>
#include <string>

#include "prostm/emit/mute.hpp"
#include "run/terminal_keys.hpp"

namespace prostm::app {

class MuteWatch {
 public:
  /// @param keys whether m and space are to mute.
  MuteWatch(std::shared_ptr<Mute> mute, bool keys);

  /// Names the keys, for the start; nothing without a terminal.
  std::optional<std::string> help() const;
  /// Reads the keys. @return what is new, in a sentence.
  std::optional<std::string> look();

 private:
  std::shared_ptr<Mute> mute_;
  std::optional<TerminalKeys> keys_;
  double looked_ = 0.0;  // [s]
  bool calibrating_ = false, by_person_ = false, hot_ = false;
};

}  // namespace prostm::app
