/// The whole server over loopback: any bytes as a request, as WebSocket frames, or as a page's
/// messages. The server must survive and answer the next request.
#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/write.hpp>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "prostm/viewer/server.hpp"

namespace {

using namespace prostm;
namespace asio = boost::asio;

/// A source without any data.
class Nothing final : public ViewSource {
 public:
  void watch(bool) override {}
  void refresh(ViewFrame& frame, ViewNews& news) override {
    frame.hand_count = 1;
    ++news.fields;
  }
  bool shows_frames(Room) const override { return true; }
  std::string hello(std::uint32_t, Room) override { return "{}"; }
  bool refresh_state(Room, std::string& state) override {
    state = "{}";
    return true;
  }
  std::string take(std::uint32_t, const PageMessage&) override { return "it cannot be done"; }
  bool next_refusal(std::uint32_t&, std::string&) override { return false; }
  void forget(std::uint32_t) override {}
};

ViewServer& server() {
  static Nothing source;
  static const unsigned char kText[] = "page";
  static const std::array<PageFile, 1> kFiles = {PageFile{"/", "text/html", kText}};
  static ViewSettings settings = [] {
    ViewSettings s;
    s.port = 0;
    s.guests = true;
    s.request_time = 1.0;
    return s;
  }();
  static ViewServer server(settings, source, kFiles);
  return server;
}

const std::string& handshake() {
  static const std::string kText =
      "GET /live HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
      "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n";
  return kText;
}

/// Returns the bytes as one masked text frame, with a mask of zeros.
std::string as_message(const std::string& text) {
  std::string out = "\x81";
  out += static_cast<char>(0x80 | 126);
  out += static_cast<char>(text.size() >> 8 & 0xFF);
  out += static_cast<char>(text.size() & 0xFF);
  return out + std::string(4, '\0') + text;
}

/// Returns a different loopback address each time: a closed connection keeps its port for a minute,
/// and one address has too few ports for thousands of connections a second.
asio::ip::address_v4 next_address() {
  static std::uint32_t n = 0;
  return asio::ip::address_v4(0x7F000100U + n++ % 4096U);
}

/// Sends the bytes and reads until the server closes.
std::string exchange(const std::string& bytes) {
  asio::io_context io;
  const asio::ip::tcp::endpoint here(next_address(), 0);
  const asio::ip::tcp::endpoint there(asio::ip::address_v4::loopback(),
                                      static_cast<std::uint16_t>(server().port()));
  asio::ip::tcp::socket socket(io, here);
  boost::system::error_code wrong;
  socket.connect(there, wrong);
  if (wrong) {
    std::fprintf(stderr, "cannot connect: %s\n", wrong.message().c_str());
    std::abort();
  }
  asio::write(socket, asio::buffer(bytes), wrong);
  socket.shutdown(asio::ip::tcp::socket::shutdown_send, wrong);
  std::string answer;
  std::array<char, 4096> some{};
  wrong = {};
  while (!wrong) answer.append(some.data(), socket.read_some(asio::buffer(some), wrong));
  return answer;
}

/// Makes the fuzzer's own alarm restart interrupted calls that wait for the server.
bool restart_after_alarms() {
  struct sigaction action {};
  if (sigaction(SIGALRM, nullptr, &action) != 0) return false;
  action.sa_flags |= SA_RESTART;
  return sigaction(SIGALRM, &action, nullptr) == 0;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const bool kRestarts = restart_after_alarms();
  if (!kRestarts) std::abort();
  if (size == 0) return 0;
  const std::string bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  switch (data[0] % 4) {
    case 0:
      exchange(bytes);
      break;
    case 1:
      exchange("GET " + bytes + " HTTP/1.1\r\nHost: localhost\r\n\r\n");
      break;
    case 2:
      exchange(handshake() + bytes);
      break;
    default:
      exchange(handshake() + as_message(bytes.substr(0, 65535)));
  }
  static int inputs = 0;
  if (++inputs % 64 == 0) {
    const std::string answer =
        exchange("GET / HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
    if (answer.find("200 OK") == std::string::npos) std::abort();
  }
  return 0;
}
