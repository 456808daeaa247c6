#include "prostm/stimulus/stimulus.hpp"

#include <algorithm>

namespace prostm {

ScenePlace place_under(const Palm& palm) {
  return {palm.centre.head<2>(), palm.yaw, std::clamp(palm.size, 0.7, 1.3)};
}

}  // namespace prostm
