#include "prostm/pipeline/realtime/cores.hpp"

#include <gtest/gtest.h>
#include <sched.h>

#include <cmath>
#include <fstream>
#include <string>
#include <thread>

namespace prostm {
namespace {

namespace fs = std::filesystem;

/// A file system that has only the files of control groups.
class ControlGroups : public ::testing::Test {
 protected:
  ControlGroups() {
    fs::remove_all(root_);
    write("proc/self/cgroup", "");
  }
  ~ControlGroups() override { fs::remove_all(root_); }

  void write(const std::string& path, const std::string& text) {
    fs::create_directories((root_ / path).parent_path());
    std::ofstream(root_ / path) << text;
  }

  const fs::path root_ =
      fs::path(testing::TempDir()) /
      (std::string("groups-") + testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(ControlGroups, MissingLimitsAreInfinite) {
  EXPECT_TRUE(std::isinf(cgroup_cores(root_)));
  EXPECT_TRUE(std::isinf(cgroup_cores(root_ / "nowhere")));
  write("proc/self/cgroup", "0::/a\n");
  write("sys/fs/cgroup/a/cpu.max", "max 100000\n");
  EXPECT_TRUE(std::isinf(cgroup_cores(root_)));
}

TEST_F(ControlGroups, TheSmallestQuotaOfV2Applies) {
  write("proc/self/cgroup", "0::/a/b\n");
  write("sys/fs/cgroup/a/cpu.max", "150000 100000\n");
  write("sys/fs/cgroup/a/b/cpu.max", "400000 100000\n");
  EXPECT_DOUBLE_EQ(cgroup_cores(root_), 1.5);
}

// a container has its own group as the root
TEST_F(ControlGroups, TheRootAppliesIfThePathIsTheHosts) {
  write("proc/self/cgroup", "0::/kubepods/pod1\n");
  write("sys/fs/cgroup/cpu.max", "50000 100000\n");
  EXPECT_DOUBLE_EQ(cgroup_cores(root_), 0.5);
}

TEST_F(ControlGroups, QuotasOfV1Apply) {
  write("proc/self/cgroup", "5:devices:/x\n4:cpu,cpuacct:/a\n0::/\n");
  write("sys/fs/cgroup/cpu,cpuacct/cpu.cfs_quota_us", "-1\n");
  write("sys/fs/cgroup/cpu,cpuacct/cpu.cfs_period_us", "100000\n");
  write("sys/fs/cgroup/cpu,cpuacct/a/cpu.cfs_quota_us", "200000\n");
  write("sys/fs/cgroup/cpu,cpuacct/a/cpu.cfs_period_us", "100000\n");
  EXPECT_DOUBLE_EQ(cgroup_cores(root_), 2.0);
}

TEST(Cores, FollowTheAffinity) {
  EXPECT_GE(usable_cores(), 1);
  std::jthread([] {
    cpu_set_t all, one;
    ASSERT_EQ(sched_getaffinity(0, sizeof all, &all), 0);
    CPU_ZERO(&one);
    for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
      if (!CPU_ISSET(cpu, &all)) continue;
      CPU_SET(cpu, &one);
      break;
    }
    ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
    EXPECT_EQ(usable_cores(), 1);
  });
}

}  // namespace
}  // namespace prostm
