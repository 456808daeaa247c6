// The adapter before playback: addresses, kits, errors, the registry.
#include <gmock/gmock.h>

#include "prostm/device/device_kinds.hpp"
#include "ultraleap/listening.hpp"

namespace prostm {
namespace {

using test::setup_of;
using testing::AllOf;
using testing::HasSubstr;
namespace stand_in = test::stand_in;

std::string refusal(const DeviceSetup& setup) {
  try {
    make_ultraleap(setup);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "not refused";
}

TEST(UltraleapAddress, NamesADeviceAndAConnection) {
  EXPECT_EQ(ultraleap_address("").device, "");
  EXPECT_EQ(ultraleap_address("USX:00000001").device, "USX:00000001");
  EXPECT_EQ(ultraleap_address("@direct").connection, "direct");
  const UltraleapAddress both = ultraleap_address("MockDevice:USX@local:/run/ulh");
  EXPECT_EQ(both.device, "MockDevice:USX");
  EXPECT_EQ(both.connection, "local:/run/ulh");
  EXPECT_THROW(ultraleap_address("USX@tcp:1"), std::invalid_argument);
}

TEST(UltraleapKit, KnowsTheTrackersPositions) {
  EXPECT_DOUBLE_EQ(ultraleap_kit("USX", "square")->tracker_y, 0.121);
  EXPECT_DOUBLE_EQ(ultraleap_kit("USI", "")->tracker_y, -0.089);
  EXPECT_DOUBLE_EQ(ultraleap_kit("UHDK5", "Square")->tracker_y, 0.1105);
  EXPECT_DOUBLE_EQ(ultraleap_kit("UHDK5", "Rectangular")->tracker_y, 0.163);
  EXPECT_EQ(ultraleap_kit("Something", ""), nullptr);
}

TEST(UltraleapDecimation, LetsTheEmissionRunAt40KilohertzOrMore) {
  for (double rate = 1e3; rate < 1e5; rate *= 1.01) {
    const int factor = ultraleap_decimation(rate);
    EXPECT_GE(rate * factor, 40e3 * (1.0 - 1e-3)) << rate;
    EXPECT_TRUE(factor == 1 || rate * (factor - 1) < 40e3) << rate;
  }
}

TEST(LookForUltraleap, ListsTheArraysAndTheirUsers) {
  stand_in::Array usi;
  usi.identifier = "USI:7";
  usi.model = "USI";
  stand_in::reset({stand_in::Array{}, usi});
  stand_in::claim("USI:7", "Kiosk");
  DeviceFinding found = look_for_ultraleap(setup_of(4));
  EXPECT_TRUE(found.found);
  EXPECT_THAT(found.words, AllOf(HasSubstr("MockDevice:USX (Stand-in, firmware 3.1.0, its kit's "
                                           "tracker at y = 121 mm), free"),
                                 HasSubstr("y = -89 mm), used by Kiosk")));
  EXPECT_TRUE(look_for_ultraleap(setup_of(4, "MockDevice:USX")).found);
  EXPECT_FALSE(look_for_ultraleap(setup_of(4, "USI:7")).found);
  EXPECT_FALSE(look_for_ultraleap(setup_of(4, "USX:5")).found);
  EXPECT_EQ(stand_in::owner("MockDevice:USX"), "") << "nothing was claimed";
  EXPECT_EQ(stand_in::emitters(), 0);

  stand_in::set_service(false);
  found = look_for_ultraleap(setup_of(4));
  EXPECT_FALSE(found.found);
  EXPECT_THAT(found.words,
              AllOf(HasSubstr("service"), HasSubstr("does not answer (nobody listens)"),
                    HasSubstr("ultraleap://@direct")));
  EXPECT_TRUE(look_for_ultraleap(setup_of(4, "@direct")).found);
  EXPECT_THAT(look_for_ultraleap(setup_of(4, "@far")).words, HasSubstr("must be direct or local"));
  stand_in::reset({});
  EXPECT_THAT(look_for_ultraleap(setup_of(4)).words, HasSubstr("sees no array"));
}

TEST(MakeUltraleap, ExplainsEachErrorInASentence) {
  const std::pair<const char*, const char*> calls[] = {
      {"connect", "service of the Ultraleap Haptics SDK does not answer (told so)"},
      {"addDevice", "'MockDevice:USX' cannot be claimed (told so)"},
      {"setControlPointCount", "does not take 3 focal points (told so): try fewer --paths"},
      {"getEmitterUpdateRate", "does not say its rate (told so)"},
      {"getDeviceUpdateRateLimit", "does not say its fastest rate (told so)"},
      {"getMinimumPointSeparation", "does not say its least separation (told so)"},
      {"setEmissionCallback", "does not take a callback (told so)"},
      {"setCallbackRate", "(told so)"}};
  for (const auto& [call, words] : calls) {
    stand_in::reset({stand_in::Array{}});
    stand_in::refuse(call, "told so");
    EXPECT_THAT(refusal(setup_of(3)), HasSubstr(words)) << call;
    EXPECT_EQ(stand_in::owner("MockDevice:USX"), "") << call;
    EXPECT_EQ(stand_in::emitters(), 0);
  }
  stand_in::reset({stand_in::Array{}});
  EXPECT_THAT(refusal(setup_of(7)), HasSubstr("does not take 7 focal points"));
  EXPECT_THAT(refusal(setup_of(3, "USX:9")), HasSubstr("'USX:9' was not found (no match)"));

  stand_in::Array odd;
  odd.centre = {0.0F, 0.121F, 0.0F};
  stand_in::reset({odd});
  EXPECT_THAT(refusal(setup_of(3)), HasSubstr("is 121 mm from the origin"));
  odd = {};
  odd.streams = false;
  stand_in::reset({odd});
  EXPECT_THAT(refusal(setup_of(3)), HasSubstr("No Ultraleap array that streams"));
  EXPECT_THAT(refusal(setup_of(3, "MockDevice:USX")), HasSubstr("cannot stream"));
  odd = {};
  odd.rates = {500.0F};
  stand_in::reset({odd});
  EXPECT_THAT(refusal(setup_of(1)), HasSubstr("a rate of 500 Hz with 1 focal points"));
}

TEST(MakeUltraleap, ChoosesAmongSeveralArrays) {
  stand_in::Array other;
  other.identifier = "USX:2";
  other.rates = {10e3F, 5e3F};
  stand_in::reset({stand_in::Array{}, other});
  const auto first = make_ultraleap(setup_of(2));
  const auto second = make_ultraleap(setup_of(2, "USX:2"));
  EXPECT_EQ(first->info().name, "Ultraleap MockDevice:USX");
  EXPECT_EQ(second->info().name, "Ultraleap USX:2");
  EXPECT_EQ(second->info().sample_rate, 5e3);
  EXPECT_EQ(second->info().decimation, 8);
  EXPECT_EQ(ultraleap_info(setup_of(2, "USX:2")).sample_rate, 5e3);
  EXPECT_EQ(ultraleap_info(setup_of(2)).sample_rate, 5e3) << "the array opened last";
}

TEST(DeviceKinds, IncludeTheArrayIfTheSdkIsPresent) {
  stand_in::reset({stand_in::Array{}});
  const DeviceName named = device_named("ultraleap://MockDevice:USX");
  EXPECT_TRUE(named.kind->is_built());
  EXPECT_EQ(named.address, "MockDevice:USX");
  EXPECT_THAT(named.kind->tried, HasSubstr("never on real hardware"));
  EXPECT_TRUE(named.kind->look(setup_of(4)).found);
  EXPECT_EQ(make_device("ultraleap://MockDevice:USX", setup_of(2))->info().name,
            "Ultraleap MockDevice:USX");
}

}  // namespace
}  // namespace prostm
