/// The server, tested with pages that are not browsers.

#include "prostm/viewer/server.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <thread>

#include "prostm/core/input_error.hpp"
#include "viewer/view_support.hpp"

namespace prostm {
namespace {

using test::eventually;
using test::get;
using test::Page;
using test::StandIn;
using test::status_of;
using testing::HasSubstr;
using testing::Not;

constexpr std::string_view kIndex = "<!doctype html><title>a page</title>", kScript = "let a = 1;";

std::span<const unsigned char> bytes_of(std::string_view text) {
  return {reinterpret_cast<const unsigned char*>(text.data()), text.size()};
}

std::span<const PageFile> some_files() {
  static const PageFile kFiles[] = {{"/", "text/html; charset=utf-8", bytes_of(kIndex)},
                                    {"/page.js", "text/javascript", bytes_of(kScript)}};
  return kFiles;
}

/// Returns settings to listen on a free port.
ViewSettings anywhere() {
  ViewSettings settings;
  settings.port = 0;
  return settings;
}

class Server : public testing::Test {
 protected:
  StandIn source_;
  ViewServer server_{anywhere(), source_, some_files()};
  int port_ = server_.port();
};

TEST_F(Server, ReportsFailure) {
  EXPECT_NO_THROW(server_.check());
  source_.fails = true;
  get(port_, "/numbers.json");
  EXPECT_TRUE(eventually([&] {
    try {
      server_.check();
      return false;
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "the page's server has failed: the stand-in fell down");
      return true;
    }
  }));
}

// ---- HTTP ----

TEST_F(Server, ServesThePagesFilesByTheirExactPathsOnly) {
  EXPECT_EQ(server_.url(), "http://127.0.0.1:" + std::to_string(port_) + "/");
  EXPECT_TRUE(server_.loopback());
  for (const char* target : {"/", "/index.html", "/?x=1"}) {
    const std::string answer = get(port_, target);
    EXPECT_EQ(status_of(answer), 200) << target;
    EXPECT_THAT(answer, HasSubstr(std::string(kIndex)));
    EXPECT_THAT(answer, HasSubstr("Content-Type: text/html"));
    EXPECT_THAT(answer, HasSubstr("Content-Security-Policy: default-src 'self'"));
  }
  EXPECT_THAT(get(port_, "/page.js"), HasSubstr(std::string(kScript)));
  for (const char* target :
       {"/page.css", "/../page.js", "/./page.js", "//page.js", "/..%2f..%2fetc/passwd",
        "/../../../../etc/passwd", "/%2e%2e/page.js", "/page.js/", "/page.js%00", "/PAGE.JS"}) {
    EXPECT_EQ(status_of(get(port_, target)), 404) << target;
  }
}

TEST_F(Server, HeadHasTheLengthAndNoBody) {
  const std::string answer = get(port_, "/", "", "HEAD");
  EXPECT_EQ(status_of(answer), 200);
  EXPECT_THAT(answer, HasSubstr("Content-Length: " + std::to_string(kIndex.size())));
  EXPECT_THAT(answer, Not(HasSubstr("<title>")));
}

TEST_F(Server, RejectsOtherMethodsBodiesAndMalformedRequests) {
  for (const char* method : {"POST", "PUT", "DELETE", "OPTIONS", "TRACE", "BREW"}) {
    const std::string answer = get(port_, "/", "", method);
    EXPECT_EQ(status_of(answer), 405) << method;
    EXPECT_THAT(answer, HasSubstr("Allow: GET, HEAD"));
  }
  EXPECT_EQ(status_of(test::raw_exchange(
                port_, "GET / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 5\r\n\r\nhello")),
            400);
  EXPECT_EQ(status_of(test::raw_exchange(port_, "nonsense\r\n\r\n")), 400);
  EXPECT_EQ(status_of(test::raw_exchange(port_, std::string("\0\1\2\r\n\r\n", 7))), 400);
  EXPECT_EQ(status_of(get(port_, "/", "X: " + std::string(9000, 'x') + "\r\n")), 431);
  EXPECT_EQ(status_of(test::raw_exchange(port_, "GET / HTTP/1.0\r\n\r\n")), 400);
  EXPECT_EQ(status_of(get(port_, "http://127.0.0.1/")), 400);
}

TEST_F(Server, RejectsForeignHostNames) {
  for (const char* host : {"evil.example", "evil.example:8470", "127.0.0.1.evil.example",
                           "192.168.1.7", "localhost.evil", "[::2]", "[::1", "127.0.0.1:80x",
                           "[::1]evil.example", "[::1]:", "[::1]:80x", "127.0.0.1:", "::1"}) {
    EXPECT_EQ(status_of(get(port_, "/", "Host: " + std::string(host) + "\r\n")), 403) << host;
  }
  for (const char* host : {"localhost", "LOCALHOST:9000", "127.0.0.1", "[::1]:8470"})
    EXPECT_EQ(status_of(get(port_, "/", "Host: " + std::string(host) + "\r\n")), 200) << host;
}

TEST_F(Server, RejectsRequestsWithARepeatedHostOrOrigin) {
  const std::string start = "GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n";
  for (const char* second : {"Host: 127.0.0.1\r\n", "Host: evil.example\r\n",
                             "Origin: http://127.0.0.1\r\nOrigin: http://evil.example\r\n"}) {
    const std::string answer = test::raw_exchange(port_, start + second + "\r\n");
    EXPECT_EQ(status_of(answer), 400) << second;
    EXPECT_THAT(answer, HasSubstr("Connection: close")) << second;
  }
}

TEST_F(Server, RejectsOtherOrigins) {
  for (const char* origin : {"http://evil.example", "https://127.0.0.1", "null",
                             "http://127.0.0.1:1", "http://localhost"}) {
    EXPECT_EQ(status_of(get(port_, "/numbers.json", "Origin: " + std::string(origin) + "\r\n")),
              403)
        << origin;
    EXPECT_THROW(Page(port_, origin), std::runtime_error) << origin;
  }
  EXPECT_THROW(Page(port_, "", "evil.example"), std::runtime_error);
  EXPECT_THROW(Page(port_, "http://evil.example", "evil.example"), std::runtime_error);
  EXPECT_THROW(Page(port_, "", "", "/other"), std::runtime_error);
  Page own(port_, "http://127.0.0.1:" + std::to_string(port_));
  EXPECT_EQ(own.next_text().at("type"), "hello");
}

TEST_F(Server, KeepsAConnectionAlive) {
  const std::string request = "GET /page.js HTTP/1.1\r\nHost: localhost\r\n\r\n";
  const std::string last = "GET /nowhere HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n";
  const std::string answer = test::raw_exchange(port_, request + request + last);
  EXPECT_EQ(status_of(answer), 200);
  EXPECT_THAT(answer, HasSubstr("404"));
}

TEST_F(Server, ServesNumbersByName) {
  const std::string answer = get(port_, "/numbers.json");
  const auto json = test::Json::parse(answer.substr(answer.find("\r\n\r\n") + 4));
  EXPECT_EQ(json.at("numbers").at("world_ms"), 7.25);
  EXPECT_TRUE(json.at("numbers").at("rmse").is_null());
  EXPECT_EQ(json.at("sequence"), 1);
}

/// A hidden page requests one frame a second, which must not limit the rate of other readers.
TEST_F(Server, NumbersHaveTheirOwnRate) {
  Page page(port_);
  page.say(R"({"type":"rate","hz":1})");
  ASSERT_TRUE(eventually([&] { return server_.stats().pages == 1; }));
  for (int i = 0; i < 2; ++i) page.next_frame();
  const std::int64_t frames = server_.stats().frames, asked = source_.refreshed;
  EXPECT_TRUE(eventually([&] {
    get(port_, "/numbers.json");
    return source_.refreshed - asked > server_.stats().frames - frames + 3;
  })) << "only the page's frames update the numbers";
}

TEST(ServerWithoutAPage, ReportsTheMissingPage) {
  StandIn source;
  const ViewServer server(anywhere(), source, {});
  const std::string answer = get(server.port(), "/");
  EXPECT_EQ(status_of(answer), 200);
  EXPECT_THAT(answer, HasSubstr("no page"));
}

// ---- pages ----

TEST_F(Server, APageGetsHelloStateAndWholeFrames) {
  Page page(port_);
  EXPECT_EQ(page.next_text().at("type"), "hello");
  EXPECT_EQ(page.next_text().at("type"), "state");
  const std::string first = page.next_frame();
  EXPECT_EQ(first.substr(0, 4), "PSTM");
  EXPECT_EQ(test::u32_at(first, 12), first.size());
  EXPECT_TRUE(test::has_section(first, 4));
  EXPECT_TRUE(test::has_section(first, 5));
  const std::string second = page.next_frame();
  EXPECT_GT(test::u32_at(second, 8), test::u32_at(first, 8));
  EXPECT_TRUE(test::has_section(second, 4)) << "the smoke changes in every frame";
  EXPECT_FALSE(test::has_section(second, 5)) << "the field does not";
}

TEST_F(Server, ServesGuestsIfConfigured) {
  const std::string upgrade = "Connection: Upgrade\r\nUpgrade: websocket\r\n";
  EXPECT_EQ(status_of(get(port_, "/guest/live", upgrade)), 404);
  ViewSettings settings = anywhere();
  settings.guests = true;
  StandIn source;
  const ViewServer server(settings, source, some_files());
  Page guest(server.port(), "", "", "/guest/live"), main(server.port());
  EXPECT_EQ(guest.next_text().at("type"), "hello");
  EXPECT_EQ(guest.next_text().at("type"), "guests");
  EXPECT_EQ(main.next_text().at("type"), "hello");
  EXPECT_EQ(main.next_text().at("type"), "state");
  main.next_frame();
  source.state_version = 2;
  EXPECT_EQ(main.next_text("state").at("version"), 2);
  for (int i = 0; i < 10; ++i) main.next_frame();
  EXPECT_FALSE(guest.hears()) << "guests get neither states nor frames";
}

TEST_F(Server, SendsANewStateToEveryPage) {
  Page one(port_), two(port_);
  one.next_text("state");
  two.next_text("state");
  source_.state_version = 2;
  EXPECT_EQ(one.next_text("state").at("version"), 2);
  EXPECT_EQ(two.next_text("state").at("version"), 2);
}

TEST_F(Server, ForwardsMessagesAndAnswersInvalidOnes) {
  Page page(port_);
  page.say(R"({"type":"set","id":"gain","value":2})");
  page.say("nonsense");
  EXPECT_THAT(page.next_text("error").at("sentence").get<std::string>(), HasSubstr("JSON object"));
  page.say(R"({"type":"set","id":"refused","value":2})");
  EXPECT_EQ(page.next_text("error").at("sentence"), "it cannot be done");
  page.say(R"({"type":"rate","hz":60})");
  ASSERT_TRUE(eventually([&] { return source_.taken().size() == 2; }));
  const auto [id, message] = source_.taken().front();
  EXPECT_EQ(std::get<SetMessage>(message).id, "gain");
  source_.refuse_later(id, "too late");
  EXPECT_EQ(page.next_text("error").at("sentence"), "too late");
}

TEST_F(Server, ClosesAfterAHundredInvalidMessages) {
  Page page(port_);
  for (int i = 0; i < 99; ++i) page.say("nonsense");
  page.say(R"({"type":"rate","hz":30})");
  for (int i = 0; i < 99; ++i) page.say("nonsense");
  page.next_text("error");
  EXPECT_EQ(server_.stats().dropped_pages, 0);
  page.say("nonsense");
  page.read_to_the_end();
  EXPECT_TRUE(eventually([&] { return server_.stats().pages == 0; }));
  EXPECT_EQ(server_.stats().dropped_pages, 1);
  EXPECT_EQ(source_.forgotten, 1);
}

TEST_F(Server, ClosesOnOversizedAndMalformedFrames) {
  {
    Page page(port_);
    page.say(std::string(4097, ' '));
    page.read_to_the_end();
  }
  {
    // a frame that claims 2^62 bytes
    Page page(port_);
    page.send_raw({'\x81', '\xFF', 0x40, 0, 0, 0, 0, 0, 0, 0, 1, 2, 3, 4});
    page.read_to_the_end();
  }
  {
    Page page(port_);
    page.send_raw(std::string(100, '\xff'));
    page.read_to_the_end();
  }
  EXPECT_TRUE(eventually([&] { return server_.stats().pages == 0; }));
  Page page(port_);
  EXPECT_EQ(page.next_text().at("type"), "hello");
}

TEST_F(Server, WatchesOnlyWhileAPageIsOpen) {
  EXPECT_FALSE(source_.watched);
  {
    Page one(port_);
    {
      Page two(port_);
      one.next_frame();
      two.next_frame();
    }
    EXPECT_TRUE(eventually([&] { return server_.stats().pages == 1; }));
    EXPECT_TRUE(source_.watched);
  }
  EXPECT_TRUE(eventually([&] { return server_.stats().pages == 0; }));
  EXPECT_FALSE(source_.watched);
}

TEST(ServerLimits, AcceptsNoMoreThanTheConfiguredPages) {
  StandIn source;
  ViewSettings settings = anywhere();
  settings.max_pages = 2;
  const ViewServer server(settings, source, some_files());
  Page one(server.port()), two(server.port());
  one.next_frame();
  two.next_frame();
  EXPECT_THROW(Page(server.port()), std::runtime_error);
}

TEST(ServerLimits, EndsRequestsThatNeverArrive) {
  StandIn source;
  ViewSettings settings = anywhere();
  settings.request_time = 0.2;
  const ViewServer server(settings, source, some_files());
  EXPECT_EQ(test::raw_exchange(server.port(), "GET / HT"), "");
}

// One page stops reading: the others continue, and after a while that page is dropped.
TEST(ServerLimits, APageThatStopsReadingDelaysNoOther) {
  StandIn source(96);  // frames of 0.9 MB fill the kernel's buffers at once
  ViewSettings settings = anywhere();
  settings.stall_time = 3.0;
  const ViewServer server(settings, source, some_files());
  Page stopped(server.port());
  stopped.next_frame();
  constexpr int kOthers = 4;
  std::vector<std::thread> others;
  std::atomic<int> whole{0};
  for (int i = 0; i < kOthers; ++i) {
    others.emplace_back([&] {
      Page page(server.port());
      std::uint32_t last = 0;
      for (int n = 0; n < 20; ++n) {
        const std::uint32_t sequence = test::u32_at(page.next_frame(), 8);
        if (sequence > last) ++whole;
        last = sequence;
      }
    });
  }
  for (std::thread& other : others) other.join();
  EXPECT_EQ(whole, 20 * kOthers);
  EXPECT_GT(server.stats().skipped_frames, 0) << "frames for the page that stopped";
  EXPECT_TRUE(eventually([&] { return server.stats().dropped_pages == 1; }));
  EXPECT_TRUE(eventually([&] { return server.stats().pages == 0; }));
}

// ---- listening address ----

TEST(ServerPort, APortInUseIsRejectedInASentence) {
  StandIn source, other;
  const ViewServer first(anywhere(), source, some_files());
  ViewSettings settings;
  settings.port = first.port();
  try {
    const ViewServer second(settings, other, some_files());
    FAIL() << "two servers on one port";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("in use"));
    EXPECT_THAT(error.what(), HasSubstr("--view-port"));
  }
}

TEST(ServerPort, ADefaultPortInUseGivesTheNextOne) {
  StandIn source, other;
  const ViewServer first(ViewSettings{}, source, some_files());
  const ViewServer second(ViewSettings{}, other, some_files());
  EXPECT_NE(first.port(), second.port());
  EXPECT_GE(first.port(), kViewPort);
  EXPECT_LT(second.port(), kViewPort + kViewPortTries);
}

TEST(ServerPort, IsFreeAgainAtOnce) {
  StandIn source;
  ViewSettings settings = anywhere();
  for (int i = 0; i < 3; ++i) {
    const ViewServer server(settings, source, some_files());
    settings.port = server.port();
    Page page(server.port());
    page.next_frame();
  }
}

TEST(ServerPort, InvalidAddressesAreRejected) {
  StandIn source;
  for (const char* address : {"", "localhost", "127.0.0", "256.0.0.1", "192.0.2.1"}) {
    ViewSettings settings = anywhere();
    settings.address = address;
    EXPECT_THROW(ViewServer(settings, source, some_files()), InputError) << address;
  }
  ViewSettings settings;
  settings.port = 70000;
  EXPECT_THROW(ViewServer(settings, source, some_files()), InputError);
}

TEST(ServerPort, AllAddressesMeansNumericHostsOnly) {
  StandIn source;
  ViewSettings settings = anywhere();
  settings.address = "0.0.0.0";
  const ViewServer server(settings, source, some_files());
  EXPECT_FALSE(server.loopback());
  EXPECT_EQ(status_of(get(server.port(), "/", "Host: 192.168.1.7:80\r\n")), 200);
  EXPECT_EQ(status_of(get(server.port(), "/", "Host: evil.example\r\n")), 403);
}

TEST(ServerWithNames, AnswersToThemAndToPagesOfTheirProxies) {
  StandIn source;
  ViewSettings settings = anywhere();
  settings.hosts = {"lab", "Touch.example.org"};
  const ViewServer server(settings, source, some_files());
  const int port = server.port();
  for (const char* host : {"lab", "LAB:8470", "touch.example.org", "localhost"})
    EXPECT_EQ(status_of(get(port, "/", "Host: " + std::string(host) + "\r\n")), 200) << host;
  for (const char* host : {"lab.evil.example", "[lab]", "lab:80x", "example.org", "192.168.1.7"})
    EXPECT_EQ(status_of(get(port, "/", "Host: " + std::string(host) + "\r\n")), 403) << host;
  Page proxied(port, "https://touch.example.org", "touch.example.org");
  EXPECT_EQ(proxied.next_text().at("type"), "hello");
  EXPECT_THROW(Page(port, "https://localhost", "localhost"), std::runtime_error);
  EXPECT_THROW(Page(port, "https://evil.example", "lab"), std::runtime_error);
  for (const char* host : {"", "http://lab", "lab:8470", "127.0.0.1", "::1", "la b"}) {
    settings.hosts = {host};
    EXPECT_THROW(ViewServer(settings, source, some_files()), InputError) << host;
  }
}

}  // namespace
}  // namespace prostm
