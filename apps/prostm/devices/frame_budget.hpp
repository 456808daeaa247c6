#pragma once
/// `prostm devices --budget`.

#include "options.hpp"

namespace prostm::app {

/// Prints what a link to AUTD3 units carries. @return the exit status of the program.
int frame_budget(const DevicesOptionsGiven& options);

}  // namespace prostm::app
