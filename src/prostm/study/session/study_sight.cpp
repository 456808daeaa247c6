#include "prostm/study/session/study_sight.hpp"

#include <fmt/chrono.h>

#include <cmath>

#include "prostm/study/session/detail/rounded.hpp"

namespace prostm {

nlohmann::ordered_json played_json(const StudyPlayed& played) {
  return {{"speed_m_s", study::rounded(played.speed, 4)},
          {"period_ms", study::rounded(1e3 * played.period, 4)},
          {"changed_paths", played.changed}};
}

std::string utc_text(double seconds) {
  const auto whole = static_cast<std::time_t>(std::floor(seconds));
  const int milliseconds = static_cast<int>(1e3 * (seconds - std::floor(seconds)));
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", fmt::gmtime(whole), milliseconds);
}

}  // namespace prostm
