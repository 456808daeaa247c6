#pragma once
/// The processor that this process may use.

#include <filesystem>

namespace prostm {

/// Cores that this process may use: those of its affinity mask (as taskset and cpusets set it), and
/// no more than the processor time of its control groups allows, rounded up. At least 1.
int usable_cores();

/// Processor time a second that the control groups of this process allow, in cores, by the files
/// below `root`: cpu.max of cgroups v2, cpu.cfs_quota_us of v1, of the process's group and of all
/// groups above it. Infinity without a limit.
double cgroup_cores(const std::filesystem::path& root = "/");

}  // namespace prostm
