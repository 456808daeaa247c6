#include "prostm/device/device_kinds.hpp"

#include <gmock/gmock.h>

#include "prostm/core/input_error.hpp"
#include "prostm/device/autd3/autd3_array.hpp"

namespace prostm {
namespace {

TEST(DeviceNamed, AcceptsAnAddressOnlyForKindsThatHaveOne) {
  EXPECT_STREQ(device_named("sim").kind->name, "sim");
  EXPECT_EQ(device_named("sim").address, "");
  EXPECT_THROW(device_named("sim://127.0.0.1"), std::invalid_argument);
}

TEST(DeviceKind, DescribesAutd3WithoutConnecting) {
  DeviceSetup setup{.array = autd3_array()};
  const DeviceKind& kind = *device_named("autd3://127.0.0.1:9").kind;
  EXPECT_STREQ(kind.array, "autd3");
  EXPECT_EQ(kind.transducers(setup).position.size(), 249U);
  const DeviceInfo info = kind.info(setup);
  EXPECT_EQ(info.max_foci, 4);
  EXPECT_DOUBLE_EQ(info.emission_rate(), 40e3);
  EXPECT_TRUE(info.comes_back);
  setup.settings.of<Autd3Settings>().weights = false;
  setup.foci = 8;
  EXPECT_EQ(kind.info(setup).max_foci, 8);
  setup.address = "127.0.0.1:99999";
  EXPECT_THROW(kind.make(setup), InputError);
  setup.address = "127.0.0.1:1";
  const DeviceFinding finding = kind.look(setup);
  EXPECT_FALSE(finding.found);
  EXPECT_THAT(finding.words, testing::HasSubstr("start AUTD3's simulator"));
}

TEST(Autd3Units, AreReadFromAFileOrRejected) {
  const auto refusal = [](const std::string& units) {
    try {
      autd3_units_from_json(R"({"format": "prostm-autd3/1", "units": )" + units + "}", "u.json");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refusal(R"([{"position_mm": [0, 0, 0]}])"), "");
  EXPECT_THAT(refusal("[]"), testing::HasSubstr("it must have 1 to 64"));
  EXPECT_THAT(refusal(R"([{"position_mm": [0, 0, 3000]}])"), testing::HasSubstr("2000"));
  EXPECT_THAT(refusal(R"([{"position_mm": [0, 0, 0], "quaternion": [0, 0, 0, 2]}])"),
              testing::HasSubstr("has the length 2"));
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

TEST(DeviceKinds, ShowTheirNamesWithAnAddress) {
  for (const DeviceKind& kind : device_kinds()) {
    const std::string form = form_of(kind);
    EXPECT_EQ(form.substr(0, form.find("://")), kind.name);
    EXPECT_EQ(form.find("://") != std::string::npos, kind.address != nullptr) << form;
  }
}

TEST(DeviceNamed, ExplainsHowToGetUltraleapSupportWithoutTheSdk) {
  for (const DeviceKind& kind : device_kinds()) {
    if (std::string(kind.name) != "ultraleap") continue;
    ASSERT_NE(kind.look, nullptr);
    EXPECT_THAT(kind.tried, testing::HasSubstr("never"));
    if (kind.is_built()) GTEST_SKIP() << "this build has the SDK";
    EXPECT_EQ(kind.info, nullptr);
    const DeviceFinding finding = kind.look({.array = usx_array()});
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
