#pragma once
/// Signals that end a command early, after its results are saved.

#include <string>

namespace prostm::app {

/// From construction on, every signal by which a person, a shell or a batch system ends a program
/// only sets a flag; a second one ends the program at once. These are SIGINT (Ctrl-C), SIGTERM,
/// SIGHUP (the terminal is gone), SIGUSR1, SIGUSR2 and SIGALRM (warnings of batch systems before
/// they kill), and SIGXCPU (ulimit -t). Signals that are already ignored, such as SIGHUP under
/// nohup, stay ignored, except SIGINT and SIGTERM. If the reader of the output goes away, that is a
/// write error, not a signal.
class Interrupt {
 public:
  Interrupt();
  bool requested() const;
  /// Signal that ended the command, as words: "Ctrl-C (SIGINT)", "SIGUSR1"; empty without one.
  std::string cause() const;
  /// Exit status of a command that was cut short but saved its results: 128 plus the signal's
  /// number; 0 without a signal.
  int status() const;
};

/// Sets the function that is called before a signal ends the program at once, null for none. It may
/// only do what a signal handler may.
void before_sudden_end(void (*tidy)());

}  // namespace prostm::app
