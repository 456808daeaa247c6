#pragma once
/// Signals that end a command early, but not before its results are kept.

#include <string>

namespace prostm::app {

/// From construction on, every signal by which a person, a shell or a batch system ends a program
/// only sets a flag; a second one ends the program at once. These are SIGINT (Ctrl-C), SIGTERM,
/// SIGHUP (the terminal is gone), SIGUSR1, SIGUSR2 and SIGALRM (warnings of batch systems before
/// they kill), and SIGXCPU (ulimit -t). Those that are ignored stay so, as SIGHUP under nohup, but
/// for SIGINT and SIGTERM. A reader of the output that goes is an error of writing, no signal.
class Interrupt {
 public:
  Interrupt();
  bool requested() const;
  /// Signal that ended the command, as words: "Ctrl-C (SIGINT)", "SIGUSR1"; empty where nothing
  /// did.
  std::string cause() const;
  /// Exit status of a command that was cut short but kept its results: 128 and the signal's number;
  /// 0 where there was none.
  int status() const;
};

/// Sets the function that is called before a signal ends the program at once, null for none. It may
/// only do what a signal handler may.
void before_sudden_end(void (*tidy)());

}  // namespace prostm::app
