// Silence after the program dies, by each of two independent mechanisms.
#include <fcntl.h>

#include "autd3_stand_in.hpp"
#include "prostm/device/autd3/detail/autd3_session.hpp"
#include "support/eventually.hpp"

namespace prostm {
namespace {

using test::Circles;
using test::now_s;
using test::sleep_s;
using test::StandIn;

constexpr double kSilence = 0.100;  // [s] after the death

enum class Plays { Stream, Loop };

/// A separate program that drives the units.
class Driver {
 public:
  Driver(const Autd3Setup& setup, Plays plays) {
    std::array<int, 2> pipe{};
    if (::pipe(pipe.data()) != 0) throw std::runtime_error("no pipe");
    process_ = ::fork();
    if (process_ == 0) {
      ::close(pipe[0]);
      // retries if the link was too slow for a moment
      for (int trial = 0; trial < 20; ++trial) {
        try {
          drive(setup, plays, pipe[1]);
        } catch (const std::exception& error) {
          std::printf("%s\n", error.what());
          std::fflush(stdout);
        }
      }
      ::_exit(1);
    }
    ::close(pipe[1]);
    if (::read(pipe[0], &link_, sizeof(link_)) != sizeof(link_)) link_ = 0;
    ::close(pipe[0]);
  }
  ~Driver() {
    kill(SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }
  void kill(int signal) { ::kill(process_, signal); }
  pid_t link() const { return link_; }

 private:
  [[noreturn]] static void drive(const Autd3Setup& setup, Plays plays, int pipe) {
    Autd3Array array(setup);
    Circles source(setup.foci, array.info().sample_rate);
    if (plays == Plays::Stream) {
      array.start(source);
    } else {
      std::vector<FocusSample> loop(static_cast<std::size_t>(100 * setup.foci));
      source.fill(0, loop);
      array.load_segment(loop, setup.foci);
    }
    const pid_t link = array.link_process();
    if (::write(pipe, &link, sizeof(link)) != sizeof(link)) ::_exit(1);
    for (;;) sleep_s(1.0);
  }
  pid_t process_ = 0, link_ = 0;
};

/// Time from `death` until the units are silent and stay so [s].
double silent_after(StandIn& server, double death) {
  sleep_s(0.4);
  const nlohmann::json report = server.report();
  EXPECT_EQ(report["sounds"], false);
  return report["last_sound"].get<double>() - death;
}

TEST(Autd3Silence, FollowsWhenTheProgramIsKilled) {
  for (const Plays plays : {Plays::Stream, Plays::Loop}) {
    StandIn server;
    Driver driver(server.setup(), plays);
    ASSERT_GT(server.wait_until_it(true), 0.0);
    sleep_s(0.2);
    const double death = now_s();
    driver.kill(SIGKILL);
    const double silent = silent_after(server, death);
    EXPECT_LT(silent, kSilence);
    std::printf("killed while %s plays: last sound %.1f ms later\n",
                plays == Plays::Stream ? "a stream" : "a loop", 1e3 * silent);
    EXPECT_EQ(server.report()["goodbyes"], 1);
  }
}

TEST(Autd3Silence, FollowsFromTheUnitsAloneWhenAllIsKilled) {
  for (const Plays plays : {Plays::Stream, Plays::Loop}) {
    StandIn server;
    Driver driver(server.setup(), plays);
    ASSERT_GT(server.wait_until_it(true), 0.0);
    ASSERT_GT(driver.link(), 0);
    sleep_s(0.2);
    const nlohmann::json before = server.report();
    const double death = now_s();
    ::kill(driver.link(), SIGKILL);
    driver.kill(SIGKILL);
    const double silent = silent_after(server, death);
    EXPECT_LT(silent, kSilence);
    const nlohmann::json report = server.report();
    EXPECT_EQ(report["clears"], before["clears"]);
    std::printf("killed with its link while %s plays: last sound %.1f ms later\n",
                plays == Plays::Stream ? "a stream" : "a loop", 1e3 * silent);
  }
}

TEST(Autd3Silence, FollowsFromTheLinkAloneWhenTheProgramIsKilled) {
  const double silent = test::best_of(3, kSilence, [] {
    StandIn server;
    Driver driver(server.setup(), Plays::Stream);
    EXPECT_GT(server.wait_until_it(true), 0.0);
    server.say("modulation 0");
    sleep_s(0.2);
    const double death = now_s();
    driver.kill(SIGKILL);
    return silent_after(server, death);
  });
  EXPECT_LT(silent, kSilence);
  std::printf("killed without modulation: last sound %.1f ms later\n", 1e3 * silent);
}

TEST(Autd3Silence, FollowsWhenTheLinkIsKilledAndTheOutputResumes) {
  for (const int signal : {SIGKILL, SIGSTOP}) {
    StandIn server;
    Autd3Array array(server.setup());
    Circles source(4, array.info().sample_rate);
    const test::StopAtEnd stop(array);
    ASSERT_EQ(array.start(source), DeviceStatus::Running);
    double silent = 0.0;
    const double again = test::best_of(3, 1.0, [&] {
      EXPECT_GT(server.wait_until_it(true), 0.0);
      const pid_t link = array.link_process();
      const double death = now_s();
      ::kill(link, signal);
      silent = server.wait_until_it(false) - death;
      EXPECT_LT(silent, kSilence);
      const double sounds = server.wait_until_it(true) - death;
      EXPECT_TRUE(test::eventually([&] { return array.status() == DeviceStatus::Running; }));
      EXPECT_NE(array.link_process(), link);
      return sounds;
    });
    EXPECT_LT(again, 1.0);
    std::printf("link %s: silent %.1f ms later, sounds %.0f ms later\n",
                signal == SIGKILL ? "killed" : "stopped", 1e3 * silent, 1e3 * again);
  }
}

TEST(Autd3Silence, ReplacesAFrameThatIsTooLate) {
  StandIn server;
  autd3::Session session(server.setup().address, {Pose::Identity()});
  const auto now = [] { return autd3::Session::Clock::now(); };
  ASSERT_TRUE(session.open(std::chrono::seconds(2)) && session.prepare(nullptr));
  autd3::nop(session.frame(0));
  ASSERT_TRUE(session.exchange_for_all(now() + std::chrono::seconds(1)));
  // as if the link's process had stalled
  const std::int64_t frames = server.report()["frames"];
  EXPECT_FALSE(session.exchange_for_all(now() - std::chrono::microseconds(1)));
  EXPECT_NE(session.problem().find("is lost"), std::string::npos) << session.problem();
  const nlohmann::json report = server.report();
  EXPECT_EQ(report["frames"], frames + 1) << "one frame clears the units";
  EXPECT_EQ(report["goodbyes"], 1);
}

TEST(Autd3Silence, IsNotCausedBySignalsToTheLink) {
  StandIn server;
  Autd3Array array(server.setup(1));
  const pid_t link = array.link_process();
  Circles source(1, array.info().sample_rate);
  const test::StopAtEnd stop(array);
  ASSERT_EQ(array.start(source), DeviceStatus::Running);
  ASSERT_GT(server.wait_until_it(true), 0.0);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) ::kill(link, signal);
  sleep_s(0.2);
  EXPECT_EQ(array.link_process(), link);
  EXPECT_EQ(array.status(), DeviceStatus::Running);
  EXPECT_EQ(server.report()["connections"], 1);
}

TEST(Autd3Silence, IsReachedByARampWhenTheArrayStops) {
  StandIn server;
  Autd3Array array(server.setup());
  Circles source(4, array.info().sample_rate);
  const test::StopAtEnd stop(array);
  ASSERT_EQ(array.start(source), DeviceStatus::Running);
  ASSERT_GT(server.wait_until_it(true), 0.0);
  array.stop();
  const nlohmann::json report = server.report();
  EXPECT_EQ(report["sounds"], false);
  EXPECT_EQ(report["goodbyes"], 1);
  EXPECT_EQ(report["connected"], false);
  EXPECT_EQ(array.link_process(), 0);
  // no process is left behind
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), 0);
  // and the array plays again
  ASSERT_EQ(array.start(source), DeviceStatus::Running);
  EXPECT_GT(server.wait_until_it(true), 0.0);
}

}  // namespace
}  // namespace prostm
