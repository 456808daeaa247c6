#pragma once
/// The tasks of prostm.

#include <span>

namespace prostm {

class Task;
using Tasks = std::span<const Task* const>;  ///< a table of tasks, none of which is null

/// One interval: is it the scene in question?
const Task& identification();
/// Two intervals, one with the level and one with the standard: which is it?
const Task& forced_choice();
/// One interval at a level: yes or no.
const Task& judgement();
/// The level is tuned until it feels like the standard.
const Task& adjustment();

/// All tasks; the first is the default of protocols.
Tasks study_tasks();

}  // namespace prostm
