#pragma once
/// Single keys from the terminal, without Enter.

#include <optional>

namespace prostm::app {

/// Reads keys as they are pressed, if standard input is a terminal and the program is in its
/// foreground; keys that send signals still do. The terminal's settings are restored on
/// destruction, and when any signal that can be caught ends the program. At most one object at a
/// time.
class TerminalKeys {
 public:
  TerminalKeys();
  ~TerminalKeys();
  TerminalKeys(const TerminalKeys&) = delete;
  TerminalKeys& operator=(const TerminalKeys&) = delete;

  /// Whether keys could be read at construction.
  bool available() const { return available_; }
  /// Returns the oldest unread character; nothing without one. The terminal
  /// sends UTF-8. The sequences of arrows and other keys without a character are skipped, as are
  /// keys with Alt. Does not wait.
  std::optional<char32_t> next();

 private:
  std::optional<unsigned char> next_byte();
  void skip_sequence();
  std::optional<char32_t> character(unsigned char first);

  bool available_ = false;
};

}  // namespace prostm::app
