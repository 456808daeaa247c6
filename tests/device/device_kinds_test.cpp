#include "prostm/device/device_kinds.hpp"

#include <gmock/gmock.h>

namespace prostm {
namespace {

TEST(DeviceNamed, TakesAnAddressOnlyWhereThereIsOne) {
  EXPECT_STREQ(device_named("sim").kind->name, "sim");
  EXPECT_EQ(device_named("sim").address, "");
  EXPECT_THROW(device_named("sim://127.0.0.1"), std::invalid_argument);
}

TEST(DeviceNamed, ListsTheDevicesForAnUnknownName) {
  try {
    device_named("simm");
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("'simm' is unknown"),
                                             testing::HasSubstr("it must be sim"),
                                             testing::HasSubstr("did you mean")));
  }
}

TEST(DeviceNamed, SaysHowToGetAnUltraleapArrayWhereTheSdkIsMissing) {
  for (const DeviceKind& kind : device_kinds()) {
    if (std::string(kind.name) != "ultraleap") continue;
    ASSERT_NE(kind.look, nullptr);
    EXPECT_THAT(kind.tried, testing::HasSubstr("never"));
    if (kind.is_built()) GTEST_SKIP() << "this build has the SDK";
    EXPECT_EQ(kind.info, nullptr);
    const DeviceFinding finding = kind.look({.simulated = {}, .array = usx_array(), .medium = {}});
    EXPECT_FALSE(finding.found);
    EXPECT_THAT(finding.words, testing::HasSubstr("-DPROSTM_ULTRALEAP_ROOT"));
    try {
      device_named("ultraleap");
      FAIL();
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("is not in this build"),
                                               testing::HasSubstr("-DPROSTM_ULTRALEAP_ROOT")));
    }
    return;
  }
  FAIL() << "no row";
}

}  // namespace
}  // namespace prostm
