#include "prostm/viewer/server.hpp"

#include <fmt/format.h>
#include <pthread.h>

#include <algorithm>
#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <ctime>
#include <stdexcept>
#include <thread>

#include "prostm/core/input_error.hpp"
#include "prostm/core/text/host_port.hpp"
#include "prostm/viewer/detail/http_answer.hpp"
#include "prostm/viewer/detail/hub.hpp"
#include "prostm/viewer/detail/session.hpp"

namespace prostm {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using viewer::Clock;

constexpr auto kAcceptPause = std::chrono::milliseconds(100);  // when file descriptors run out
constexpr auto kIdlePause = std::chrono::milliseconds(100);    // between ticks without a page

asio::ip::address listen_address(const std::string& text) {
  boost::system::error_code wrong;
  const auto address = asio::ip::make_address(text, wrong);
  if (wrong) {
    throw InputError(fmt::format(
        "\"{}\" is not a valid address for the view; use e.g. 127.0.0.1, 0.0.0.0 or ::1", text));
  }
  return address;
}

/// Listens on one port. Returns the error if it cannot.
boost::system::error_code listen_on(tcp::acceptor& acceptor, const tcp::endpoint& endpoint) {
  boost::system::error_code wrong, ignored;
  acceptor.open(endpoint.protocol(), wrong);
  // so that a run can use the port of one that has just ended
  if (!wrong) acceptor.set_option(tcp::acceptor::reuse_address(true), wrong);
  if (!wrong) acceptor.bind(endpoint, wrong);
  if (!wrong) acceptor.listen(asio::socket_base::max_listen_connections, wrong);
  if (wrong) acceptor.close(ignored);
  return wrong;
}

}  // namespace

struct ViewServer::Impl {
  Impl(const ViewSettings& settings, ViewSource& source, std::span<const PageFile> files)
      : hub(settings, source, files) {
    for (const std::string& host : settings.hosts) {
      if (is_host_name(host)) continue;
      throw InputError(fmt::format(
          "--view-host \"{}\" must be a name such as lab.example.org, without http:// and without "
          "a port; addresses need no name",
          host));
    }
    const auto address = listen_address(settings.address);
    listen(address);
    hub.any_address = !address.is_loopback();
    tell();
    accept();
    tick_at = Clock::now();
    tick();
    thread = std::thread([this] { serve(); });
  }

  ~Impl() {
    io.stop();
    thread.join();
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void serve() noexcept {
    try {
      io.run();
    } catch (const std::exception& error) {
      failure = error.what();
      failed.store(true, std::memory_order_release);
    }
  }

  void listen(const asio::ip::address& address) {
    const std::optional<int> asked = hub.settings.port;
    if (asked && (*asked < 0 || *asked > 65535)) {
      throw InputError(fmt::format("the view's port {} must be between 0 (any) and 65535", *asked));
    }
    boost::system::error_code wrong;
    const int first = asked.value_or(kViewPort), tries = asked ? 1 : kViewPortTries;
    for (int port = first; port < first + tries; ++port) {
      wrong = listen_on(acceptor, {address, static_cast<std::uint16_t>(port)});
      if (!wrong) return;
      if (wrong != asio::error::address_in_use) break;
    }
    throw InputError(
        fmt::format("the page cannot be served at {} port {}: {}; give another "
                    "--view-port (0: any free port) or --view-address",
                    address.to_string(), first, wrong.message()));
  }

  void accept() {
    acceptor.async_accept([this](boost::system::error_code wrong, tcp::socket socket) {
      if (!wrong) {
        if (hub.connections < hub.settings.max_connections)
          std::make_shared<viewer::Session>(std::move(socket), hub)->run();
        return accept();
      }
      // e.g. out of file descriptors: others may close meanwhile
      pause.expires_after(kAcceptPause);
      pause.async_wait([this](boost::system::error_code stopped) {
        if (!stopped) accept();
      });
    });
  }

  /// Does the periodic work, at the highest rate requested by a page.
  void tick() {
    timer.expires_at(tick_at);
    timer.async_wait([this](boost::system::error_code stopped) {
      if (stopped) return;
      const auto now = Clock::now();
      double rate = 0.0;
      for (const viewer::Session* page : hub.pages) rate = std::max(rate, page->rate());
      tell();
      if (!hub.pages.empty()) show(now);
      const Clock::duration period = rate > 0.0 ? std::chrono::duration_cast<Clock::duration>(
                                                      std::chrono::duration<double>(1.0 / rate))
                                                : Clock::duration(kIdlePause);
      // keeps the rate, unless it has fallen behind
      tick_at = std::max(tick_at + period, now);
      tick();
    });
  }

  void tell() {
    for (const Room room : kRooms) {
      std::string state;
      if (!hub.source.refresh_state(room, state)) continue;
      hub.states[static_cast<std::size_t>(room)] =
          std::make_shared<const std::string>(std::move(state));
      for (viewer::Session* page : hub.pages)
        if (page->room() == room) page->tell_state();
    }
    std::uint32_t id = 0;
    std::string sentence;
    while (hub.source.next_refusal(id, sentence)) {
      for (viewer::Session* page : hub.pages)
        if (page->id() == id) page->tell_error(sentence);
    }
  }

  void show(Clock::time_point now) {
    hub.next_frame();
    encoded.begin();
    for (viewer::Session* page : hub.pages) {
      page->offer_frame(now, encoded);
      page->check_stall(now);
    }
  }

  viewer::Hub hub;  // outlives the sessions, which `io` holds
  viewer::EncodedFrame encoded;
  asio::io_context io{1};
  tcp::acceptor acceptor{io};
  asio::steady_timer timer{io}, pause{io};
  Clock::time_point tick_at;
  std::string failure;  // valid once `failed` is set
  std::atomic<bool> failed{false};
  std::thread thread;
};

ViewServer::ViewServer(const ViewSettings& settings, ViewSource& source,
                       std::span<const PageFile> files)
    : impl_(std::make_unique<Impl>(settings, source, files)) {}

ViewServer::~ViewServer() = default;

int ViewServer::port() const {
  return impl_->acceptor.local_endpoint().port();
}

std::string ViewServer::url() const {
  const auto address = impl_->acceptor.local_endpoint().address();
  std::string host = address.to_string();
  // a wildcard address cannot be visited
  if (address.is_unspecified()) host = address.is_v6() ? "::1" : "127.0.0.1";
  return fmt::format("http://{}/", HostPort{host, static_cast<std::uint16_t>(port())}.text());
}

bool ViewServer::loopback() const {
  return !impl_->hub.any_address;
}

ViewStats ViewServer::stats() const {
  const auto& count = impl_->hub.count;
  return {count.frames, count.skipped, count.bytes, count.dropped, count.pages};
}

void ViewServer::check() const {
  if (impl_->failed.load(std::memory_order_acquire))
    throw std::runtime_error("the page's server has failed: " + impl_->failure);
}

double ViewServer::cpu_time() const {
  clockid_t clock{};
  timespec t{};
  if (pthread_getcpuclockid(impl_->thread.native_handle(), &clock) != 0 ||
      clock_gettime(clock, &t) != 0) {
    return 0.0;
  }
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace prostm
