#include "run/terminal_keys.hpp"

#include <fcntl.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <atomic>

#include "interrupt.hpp"

namespace prostm::app {
namespace {

constexpr unsigned char kEscape = 0x1b;

termios before;  // of the terminal; written before `changed` is set
std::atomic<bool> changed{false};

/// A program in the background is stopped if it reads from its terminal or changes it.
bool in_foreground() {
  return tcgetpgrp(STDIN_FILENO) == getpgrp();
}

void restore() {
  if (changed.exchange(false) && in_foreground()) tcsetattr(STDIN_FILENO, TCSANOW, &before);
}

/// Makes the terminal pass keys on at once and not echo them. False if it cannot.
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

std::optional<unsigned char> TerminalKeys::next_byte() {
  if (!available_ || !in_foreground()) return std::nullopt;
  // after the program was suspended, the terminal has the shell's settings
  if (!take_terminal()) return std::nullopt;
  pollfd waiting{STDIN_FILENO, POLLIN, 0};
  if (poll(&waiting, 1, 0) != 1 || (waiting.revents & POLLIN) == 0) return std::nullopt;
  unsigned char byte = 0;
  if (read(STDIN_FILENO, &byte, 1) != 1) return std::nullopt;
  return byte;
}

/// Skips the rest of an escape sequence: "[" or "O", parameters and a letter, or the key with Alt.
void TerminalKeys::skip_sequence() {
  std::optional<unsigned char> byte = next_byte();
  if (byte != '[' && byte != 'O') return;
  do {
    byte = next_byte();
  } while (byte && (*byte < 0x40 || *byte > 0x7e));
}

/// Reads the rest of a character in UTF-8; nothing for invalid bytes.
std::optional<char32_t> TerminalKeys::character(unsigned char first) {
  if (first < 0x80) return first;
  const int following = first >= 0xf0 ? 3 : first >= 0xe0 ? 2 : first >= 0xc0 ? 1 : 0;
  if (following == 0) return std::nullopt;
  char32_t code = first & (0x3fU >> following);
  for (int i = 0; i < following; ++i) {
    const std::optional<unsigned char> byte = next_byte();
    if (!byte || (*byte & 0xc0U) != 0x80U) return std::nullopt;
    code = code << 6U | (*byte & 0x3fU);
  }
  return code;
}

std::optional<char32_t> TerminalKeys::next() {
  while (const std::optional<unsigned char> byte = next_byte()) {
    if (byte == kEscape) {
      skip_sequence();
    } else if (const std::optional<char32_t> typed = character(*byte)) {
      return typed;
    }
  }
  return std::nullopt;
}

}  // namespace prostm::app
