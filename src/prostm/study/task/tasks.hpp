#pragma once
/// The tasks that prostm has.

#include <span>

namespace prostm {

class Task;
using Tasks = std::span<const Task* const>;  ///< a table of tasks, none of which is null

/// One interval: is it the scene that is asked for?
const Task& identification();
/// Two intervals, the level's and the standard's: which?
const Task& forced_choice();
/// One interval at a level: yes or no.
const Task& judgement();
/// The level is tuned until it feels like the standard.
const Task& adjustment();

/// All of them; the first is the one of a protocol that names none.
Tasks study_tasks();

}  // namespace prostm
