#pragma once
/// Reports mutes of a run on its terminal, and sets them by keys.

#include <memory>
#include <optional>
#include <string>

#include "prostm/emit/mute.hpp"
#include "run/terminal_keys.hpp"

namespace prostm::app {

class MuteWatch {
 public:
  /// @param keys whether the keys m and space mute.
  MuteWatch(std::shared_ptr<Mute> mute, bool keys);

  /// Returns a sentence about the keys, for the start; nothing without a terminal.
  std::optional<std::string> help() const;
  /// Reads the keys. @return a sentence about a change, if any.
  std::optional<std::string> look();

 private:
  std::shared_ptr<Mute> mute_;
  std::optional<TerminalKeys> keys_;
  double looked_ = 0.0;  // [s]
  bool calibrating_ = false, by_person_ = false, hot_ = false;
};

}  // namespace prostm::app
