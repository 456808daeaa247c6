#include "prostm/pipeline/realtime/cores.hpp"

#if defined(__linux__)
#include <sched.h>
#endif

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <string>
#include <thread>

namespace prostm {
namespace {

namespace fs = std::filesystem;

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// Cores of a group of v2, whose cpu.max is "max 100000" or "150000 100000".
double of_v2(const fs::path& group) {
  std::ifstream file(group / "cpu.max");
  double quota = 0.0, period = 0.0;  // "max" is not a number
  return file >> quota >> period && quota > 0.0 && period > 0.0 ? quota / period : kNoLimit;
}

/// Cores of a group of v1, whose quota is -1 without a limit.
double of_v1(const fs::path& group) {
  std::ifstream quota_file(group / "cpu.cfs_quota_us"), period_file(group / "cpu.cfs_period_us");
  double quota = 0.0, period = 0.0;
  const bool known = static_cast<bool>(quota_file >> quota) && (period_file >> period);
  return known && quota > 0.0 && period > 0.0 ? quota / period : kNoLimit;
}

/// The smallest limit of `path` and all groups above it. In a container the path may be the host's
/// and not exist; the root always exists.
template <class Limit>
double least_above(const fs::path& mount, const fs::path& path, Limit&& limit) {
  double least = limit(mount);
  fs::path group = mount;
  for (const fs::path& part : path.relative_path()) least = std::min(least, limit(group /= part));
  return least;
}

}  // namespace

double cgroup_cores(const fs::path& root) {
  const fs::path mounts = root / "sys/fs/cgroup";
  std::ifstream groups(root / "proc/self/cgroup");
  double least = kNoLimit;
  // "0::/path" of v2, "4:cpu,cpuacct:/path" of v1
  for (std::string line; std::getline(groups, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == line.npos || second == line.npos) continue;
    const std::string names = line.substr(first + 1, second - first - 1);
    const fs::path path = line.substr(second + 1);
    if (names.empty()) {
      for (const char* mount : {"", "unified"})
        least = std::min(least, least_above(mounts / mount, path, of_v2));
    } else if (("," + names + ",").find(",cpu,") != std::string::npos) {
      for (const std::string& mount : {names, std::string("cpu")})
        least = std::min(least, least_above(mounts / mount, path, of_v1));
    }
  }
  return least;
}

int usable_cores() {
  int cores = static_cast<int>(std::thread::hardware_concurrency());
#if defined(__linux__)
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof set, &set) == 0) cores = CPU_COUNT(&set);
  const double allowed = cgroup_cores();
  if (std::isfinite(allowed)) cores = std::min(cores, static_cast<int>(std::ceil(allowed)));
#endif
  return std::max(1, cores);
}

}  // namespace prostm
