#pragma once
/// The processor cores available to this process.

#include <filesystem>

namespace prostm {

/// Returns the number of cores that this process may use: those of its affinity mask (set by
/// taskset and cpusets), limited by the processor time of its control groups, rounded up. At least
/// 1.
int usable_cores();

/// Returns the processor time per second that the control groups of this process allow, in cores,
/// read from the files below `root`: cpu.max of cgroups v2, cpu.cfs_quota_us of v1, for the
/// process's group and all its ancestors. Infinity without a limit.
double cgroup_cores(const std::filesystem::path& root = "/");

}  // namespace prostm
