#pragma once
/// Single keys from the terminal, without Enter.

namespace prostm::app {

/// Reads keys as they are pressed, where standard input is a terminal and the program is in its
/// foreground; signals from the keyboard stay signals. The terminal is as before after this is
/// gone, and after any signal that can be caught ends the program. One at a time.
class TerminalKeys {
 public:
  TerminalKeys();
  ~TerminalKeys();
  TerminalKeys(const TerminalKeys&) = delete;
  TerminalKeys& operator=(const TerminalKeys&) = delete;

  /// Whether keys could be read when this was made.
  bool available() const { return available_; }
  /// Returns the oldest key that was pressed and not read; 0 without one. Does not wait.
  char next();

 private:
  bool available_ = false;
};

}  // namespace prostm::app
