#pragma once
/// prostm study run --rehearse N --as-fast-as-possible.

#include "options.hpp"

namespace prostm::app {

/// Rehearses a session with a simulated clock, without pages. @return the exit status.
/// @throws InputError: there is no rehearsal, or an option needs the time of the room.
int stepped_session(const StudyRunOptionsGiven& given);

}  // namespace prostm::app
