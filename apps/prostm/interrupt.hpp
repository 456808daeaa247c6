#pragma once
/// Signals that end a command early, but not before its results are kept.

namespace prostm::app {

/// From construction on, Ctrl-C (SIGINT), SIGTERM and a terminal that goes (SIGHUP, unless it is
/// ignored, as under nohup) only set a flag; a second one ends the program at once. And a reader of
/// the output that goes is an error of writing, no signal.
class Interrupt {
 public:
  Interrupt();
  bool requested() const;
  /// Exit status of a command that was cut short but kept its results: 128 and the signal's number;
  /// 0 where there was none.
  int status() const;
};

/// Sets the function that is called before a signal ends the program at once, null for none. It may
/// only do what a signal handler may.
void before_sudden_end(void (*tidy)());

}  // namespace prostm::app
