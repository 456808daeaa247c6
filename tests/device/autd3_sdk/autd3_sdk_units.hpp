#pragma once
/// The stand-in for a chain of AUTD3 units, in a separate process.

#include <sys/types.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace prostm::test {

/// Starts the program on a free port of ::1, and stops it on destruction.
class SdkUnits {
 public:
  explicit SdkUnits(const std::vector<std::string>& options = {});
  ~SdkUnits();
  SdkUnits(const SdkUnits&) = delete;
  SdkUnits& operator=(const SdkUnits&) = delete;

  /// Its address without autd3-sdk://.
  std::string address() const { return "[::1]:" + std::to_string(port_); }
  int port() const { return port_; }
  /// Sends a command line and returns the answer.
  nlohmann::json tell(const std::string& line);
  nlohmann::json report() { return tell("report"); }

 private:
  nlohmann::json read_line();
  pid_t process_ = -1;
  int in_ = -1, out_ = -1;
  int port_ = 0;
};

}  // namespace prostm::test
