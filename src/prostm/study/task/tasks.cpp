#include "prostm/study/task/tasks.hpp"

#include <array>

namespace prostm {

Tasks study_tasks() {
  static const std::array kTasks = {&identification(), &forced_choice(), &judgement(),
                                    &adjustment()};
  return kTasks;
}

}  // namespace prostm
