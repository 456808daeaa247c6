#include "terminal_keys.hpp"

#include <fcntl.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <atomic>

#include "interrupt.hpp"

namespace prostm::app {
namespace {

termios before;  // of the terminal; written before `changed` is set
std::atomic<bool> changed{false};

/// A program in the background is stopped if it reads from its terminal or changes it.
bool in_foreground() {
  return tcgetpgrp(STDIN_FILENO) == getpgrp();
}

void restore() {
  if (changed.exchange(false) && in_foreground()) tcsetattr(STDIN_FILENO, TCSANOW, &before);
}

/// Keys come at once and are not shown. False if the terminal does not do that.
bool take_terminal() {
  termios now{};
  if (tcgetattr(STDIN_FILENO, &now) != 0) return false;
  if ((now.c_lflag & ICANON) == 0U && changed) return true;
  if (!changed) before = now;
  now.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  changed = true;
  if (tcsetattr(STDIN_FILENO, TCSANOW, &now) == 0) return true;
  changed = false;
  return false;
}

}  // namespace

TerminalKeys::TerminalKeys() {
  if (isatty(STDIN_FILENO) == 0 || !in_foreground()) return;
  before_sudden_end(restore);
  available_ = take_terminal();
}

TerminalKeys::~TerminalKeys() {
  restore();
  if (available_) before_sudden_end(nullptr);
}

char TerminalKeys::next() {
  if (!available_ || !in_foreground()) return 0;
  // after the program was stopped, its terminal is as the shell left it
  if (!take_terminal()) return 0;
  pollfd waiting{STDIN_FILENO, POLLIN, 0};
  if (poll(&waiting, 1, 0) != 1 || (waiting.revents & POLLIN) == 0) return 0;
  char key = 0;
  return read(STDIN_FILENO, &key, 1) == 1 ? key : '\0';
}

}  // namespace prostm::app
