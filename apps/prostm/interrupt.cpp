#include "interrupt.hpp"

#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>

namespace prostm::app {
namespace {

struct NamedSignal {
  int number;
  const char* words;
  bool may_be_ignored = true;
};
constexpr std::array<NamedSignal, 7> kSignals{{{SIGINT, "Ctrl-C (SIGINT)", false},
                                               {SIGTERM, "SIGTERM", false},
                                               {SIGHUP, "SIGHUP (the terminal is gone)"},
                                               {SIGUSR1, "SIGUSR1"},
                                               {SIGUSR2, "SIGUSR2"},
                                               {SIGALRM, "SIGALRM"},
                                               {SIGXCPU, "SIGXCPU (the limit of processor time)"}}};

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

/// Cleans up, and then lets the fault end the program as usual.
void on_fault(int signal) {
  std::signal(signal, SIG_DFL);
  tidy();
  std::raise(signal);
}

}  // namespace

Interrupt::Interrupt() {
  for (const NamedSignal& one : kSignals) {
    const bool was_ignored = std::signal(one.number, on_signal) == SIG_IGN;
    if (was_ignored && one.may_be_ignored) std::signal(one.number, SIG_IGN);
  }
  std::signal(SIGPIPE, SIG_IGN);
}

bool Interrupt::requested() const {
  return interrupt.load() != 0;
}

std::string Interrupt::cause() const {
  for (const NamedSignal& one : kSignals)
    if (one.number == interrupt.load()) return one.words;
  return {};
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
