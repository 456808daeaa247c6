#include "prostm/device/autd3_sdk/detail/autd3_sdk_discovery.hpp"

#include <gmock/gmock.h>

#include <chrono>
#include <thread>

#include "device/autd3_sdk/autd3_sdk_units.hpp"
#include "prostm/device/autd3_sdk/autd3_sdk_array.hpp"
#include "prostm/device/autd3_sdk/autd3_sdk_kind.hpp"
#include "prostm/device/autd3_sdk/detail/autd3_sdk_session.hpp"
#include "support/eventually.hpp"
#include "support/stall_watch.hpp"

namespace prostm::sdk {
namespace {

using testing::HasSubstr;

std::string refusal_of(const std::string& address) {
  try {
    group_address(address);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

TEST(SdkAddress, AcceptsAnInterfaceOrAnAddress) {
  const UdpAddress simulator = group_address("[::1]:50000");
  EXPECT_EQ(simulator.port, 50000);
  EXPECT_EQ(simulator.host[15], 1);
  EXPECT_FALSE(simulator.is_multicast());
  EXPECT_EQ(group_address("[::1]").port, kPort);
  const UdpAddress group = group_address("%lo");
  EXPECT_TRUE(group.is_multicast());
  EXPECT_EQ(group.port, kPort);
  EXPECT_NE(group.scope, 0U);
  EXPECT_EQ(group_address("%lo:7").port, 7);
}

TEST(SdkAddress, RejectsOthersWithASentence) {
  EXPECT_THAT(refusal_of("%no-such-card"), HasSubstr("there is no network interface"));
  EXPECT_THAT(refusal_of("eth0"), HasSubstr("%eth0"));
  EXPECT_THAT(refusal_of("127.0.0.1"), HasSubstr("IPv6 address in brackets"));
  EXPECT_THAT(refusal_of("[::1"), HasSubstr("in brackets"));
  EXPECT_THAT(refusal_of("[::1]:0"), HasSubstr("port"));
  EXPECT_THAT(refusal_of("[::1]x"), HasSubstr("port"));
  EXPECT_THAT(refusal_of(""), HasSubstr("must name a network interface"));
}

TEST(SdkDiscovery, NumbersUnitsAlongTheirChain) {
  for (const int count : {1, 2, 3}) {
    test::SdkUnits chain({"--units", std::to_string(count)});
    Session session({.address = chain.address()});
    ASSERT_TRUE(test::eventually([&] { return session.open(); })) << session.problem();
    EXPECT_EQ(session.units(), static_cast<std::size_t>(count));
    EXPECT_EQ(session.firmware(), "CPU 0.10.0, FPGA 0.10.0");
    // again, now that all units have numbers
    ASSERT_TRUE(test::eventually([&] { return session.open(); })) << session.problem();
    session.close();
    const auto report = chain.report();
    EXPECT_EQ(report["protocol_errors"], 0) << report;
    EXPECT_GE(report["clears"], 3 * count);  // found twice, then closed
  }
}

TEST(SdkDiscovery, FindsUnitsThroughLoss) {
  test::SdkUnits chain({"--units", "2"});
  chain.tell("drop 10");
  Session session({.address = chain.address()});
  bool found = false;
  for (int i = 0; i < 5 && !found; ++i) found = session.open();
  EXPECT_TRUE(found) << session.problem();
  EXPECT_EQ(session.units(), 2U);
  EXPECT_EQ(chain.report()["protocol_errors"], 0);
}

TEST(SdkDiscovery, WaitsUntilAllUnitsAreSynchronised) {
  test::SdkUnits chain({"--units", "2"});
  chain.tell("never-ready 1");
  std::jthread later([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(700));
    chain.tell("never-ready 0");
  });
  const auto start = std::chrono::steady_clock::now();
  Session session({.address = chain.address()});
  EXPECT_TRUE(test::eventually([&] { return session.open(); })) << session.problem();
  EXPECT_GT(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(600));
}

TEST(SdkDiscovery, ReportsWhyAUnitRejectsItsNumber) {
  for (int status = 1; status <= 4; ++status) {
    test::SdkUnits chain;
    chain.tell("status 4 " + std::to_string(status));
    Session session({.address = chain.address()});
    EXPECT_FALSE(session.open());
    EXPECT_THAT(session.problem(), HasSubstr(status_words(static_cast<std::uint8_t>(status))));
    EXPECT_THAT(session.problem(), HasSubstr("unit 0"));
  }
}

TEST(SdkDiscovery, ReportsThatNoUnitAnswers) {
  int port = 0;
  { port = test::SdkUnits().port(); }  // a port that is free now
  Session session({.address = "[::1]:" + std::to_string(port)});
  EXPECT_FALSE(session.open());
  EXPECT_THAT(session.problem(), HasSubstr("does not answer; start the AUTD3 SDK's simulator"));
}

TEST(SdkDiscovery, ReportsMoreUnitsThanPoses) {
  test::SdkUnits chain({"--units", "2"});
  Session session({.address = chain.address(), .units = 1});
  EXPECT_FALSE(session.open());
  EXPECT_THAT(session.problem(), HasSubstr("has 2 units, but the settings place 1"));
}

TEST(SdkSession, ExplainsEachError) {
  test::SdkUnits chain;
  Session session({.address = chain.address()});
  ASSERT_TRUE(test::eventually([&] { return session.open(); })) << session.problem();
  for (int error = 1; error <= 0x15; ++error) {
    chain.tell("refuse 3 " + std::to_string(error) + " 1");  // Clear
    EXPECT_FALSE(session.resume());
    EXPECT_THAT(session.problem(), HasSubstr(error_words(static_cast<std::uint8_t>(error))));
    EXPECT_THAT(session.problem(), HasSubstr("autd3-sdk://[::1]:"));
    ASSERT_TRUE(test::eventually([&] { return session.resume(); })) << session.problem();
  }
}

TEST(SdkSession, DropsAUnitThatIsSilentFor100Milliseconds) {
  test::SdkUnits chain;
  Session session({.address = chain.address()});
  ASSERT_TRUE(test::eventually([&] { return session.open(); })) << session.problem();
  chain.tell("cut 300");
  const test::StallWatch stalls;
  const auto start = std::chrono::steady_clock::now();
  EXPECT_FALSE(session.listen(start + std::chrono::seconds(5)));
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  EXPECT_LT(took.count() - stalls.held_up(), 0.25);
  EXPECT_THAT(session.problem(), HasSubstr("unit 0 was silent for 100 ms"));
  std::this_thread::sleep_for(std::chrono::milliseconds(320));
  EXPECT_TRUE(test::eventually([&] { return session.resume(); })) << session.problem();
}

TEST(SdkSession, FollowsTheUnitsClock) {
  test::SdkUnits chain;
  Session session({.address = chain.address()});
  Session::Clock::time_point now;
  std::int64_t first = 0;
  ASSERT_TRUE(test::eventually([&] {
    if (!session.open()) return false;
    now = Session::Clock::now();
    first = session.unit_time(now);
    EXPECT_EQ(session.host_time(first), now);
    return session.listen(now + std::chrono::milliseconds(600));
  })) << session.problem();
  // the unit's clock was set to 0 at discovery
  EXPECT_GT(first, 0);
  EXPECT_LT(first, 5'000'000'000);
  EXPECT_NEAR(static_cast<double>(session.unit_time(now) - first), 0.0, 20e6);
}

TEST(SdkLook, ListsTheUnitsWithoutDisturbingThem) {
  test::SdkUnits chain;
  DeviceSetup setup;
  setup.address = chain.address();
  const DeviceFinding before = autd3_sdk_kind().look(setup);
  EXPECT_TRUE(before.found);
  EXPECT_THAT(before.words, HasSubstr("1 unit answers; firmware 0.10.0"));
  EXPECT_THAT(before.words, testing::Not(HasSubstr("numbered by")));
  Session session({.address = chain.address()});
  ASSERT_TRUE(test::eventually([&] { return session.open(); }));
  const DeviceFinding after = autd3_sdk_kind().look(setup);
  EXPECT_TRUE(after.found);
  EXPECT_THAT(after.words, HasSubstr("numbered by a program that may still run"));
  EXPECT_TRUE(test::eventually([&] { return session.resume(); })) << session.problem();
  EXPECT_EQ(chain.report()["protocol_errors"], 0);
}

TEST(SdkLook, ReportsWhatIsMissing) {
  DeviceSetup setup;
  EXPECT_THAT(autd3_sdk_kind().look(setup).words, HasSubstr("name the network interface"));
  setup.address = "%no-such-card";
  EXPECT_THAT(autd3_sdk_kind().look(setup).words, HasSubstr("there is no network interface"));
  { setup.address = test::SdkUnits().address(); }
  const DeviceFinding nobody = autd3_sdk_kind().look(setup);
  EXPECT_FALSE(nobody.found);
  EXPECT_THAT(nobody.words, HasSubstr("no unit answers"));
  EXPECT_THAT(nobody_words(group_address("%lo")),
              testing::AllOf(HasSubstr("firewall"), HasSubstr("fe80::/10"),
                             HasSubstr("MLD snooping"), HasSubstr("44336")));
}

}  // namespace
}  // namespace prostm::sdk
