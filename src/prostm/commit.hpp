#pragma once
#include <string>
#include <string_view>

#include "prostm/version.hpp"

namespace prostm {

/// Returns the first 12 digits of the commit that was built, with "-dirty" behind them if files had
/// been changed since; empty if the sources came without their history.
std::string_view commit();

/// Returns the version and, if it is known, the commit: "0.1.0 (557fe26d2c1a)".
inline std::string version_text() {
  const std::string_view built = commit();
  return built.empty() ? PROSTM_VERSION : std::string(PROSTM_VERSION " (").append(built) + ")";
}

}  // namespace prostm
