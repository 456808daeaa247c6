#include "interrupt.hpp"

#include <unistd.h>

#include <atomic>
#include <csignal>

namespace prostm::app {
namespace {

std::atomic<int> interrupt{0};  // the signal's number; set by the handler alone
std::atomic<void (*)()> tidy_up{nullptr};

void tidy() {
  if (void (*const function)() = tidy_up.load()) function();
}

void on_signal(int signal) {
  if (interrupt.exchange(signal) == 0) return;
  tidy();
  _exit(128 + signal);
}

/// Tidies up, and lets the fault end the program as it would have.
void on_fault(int signal) {
  std::signal(signal, SIG_DFL);
  tidy();
  std::raise(signal);
}

}  // namespace

Interrupt::Interrupt() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  if (std::signal(SIGHUP, on_signal) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
}

bool Interrupt::requested() const {
  return interrupt.load() != 0;
}

int Interrupt::status() const {
  return requested() ? 128 + interrupt.load() : 0;
}

void before_sudden_end(void (*function)()) {
  tidy_up = function;
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) {
    const auto before = std::signal(signal, on_fault);
    // a sanitizer's handler stays
    if (before != SIG_DFL && before != on_fault) std::signal(signal, before);
  }
}

}  // namespace prostm::app
