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

TEST(DeviceKinds, SayHowTheyAreNamedWithAnAddress) {
  for (const DeviceKind& kind : device_kinds()) {
    const std::string form = form_of(kind);
    EXPECT_EQ(form.substr(0, form.find("://")), kind.name);
    EXPECT_EQ(form.find("://") != std::string::npos, kind.address != nullptr) << form;
  }
}

}  // namespace
}  // namespace prostm
