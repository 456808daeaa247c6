#include "viewer/view_support.hpp"

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>

namespace prostm::test {

namespace asio = boost::asio;
namespace beast = boost::beast;

std::string raw_exchange(int port, const std::string& bytes, std::size_t enough) {
  asio::io_context io;
  asio::ip::tcp::socket socket(io);
  socket.connect({asio::ip::address_v4::loopback(), static_cast<std::uint16_t>(port)});
  boost::system::error_code wrong;
  asio::write(socket, asio::buffer(bytes), wrong);
  std::string answer;
  while (!wrong && answer.size() < enough) {
    char some[4096];
    const std::size_t n = socket.read_some(asio::buffer(some), wrong);
    answer.append(some, n);
  }
  return answer;
}

int status_of(const std::string& answer) {
  return answer.rfind("HTTP/1.1 ", 0) == 0 ? std::stoi(answer.substr(9, 3)) : 0;
}

std::string get(int port, const std::string& target, const std::string& headers,
                const std::string& method) {
  return raw_exchange(port, method + " " + target + " HTTP/1.1\r\n" +
                                (headers.find("Host:") == std::string::npos
                                     ? "Host: 127.0.0.1:" + std::to_string(port) + "\r\n"
                                     : "") +
                                headers + "Connection: close\r\n\r\n");
}

struct Page::Connection {
  asio::io_context io;
  beast::websocket::stream<asio::ip::tcp::socket, false> socket{io};
};

Page::Page(int port, const std::string& origin, const std::string& host, const std::string& target)
    : connection_(std::make_unique<Connection>()) {
  auto& socket = connection_->socket;
  socket.next_layer().connect({asio::ip::address_v4::loopback(), static_cast<std::uint16_t>(port)});
  if (!origin.empty()) {
    socket.set_option(
        beast::websocket::stream_base::decorator([origin](beast::websocket::request_type& request) {
          request.set(beast::http::field::origin, origin);
        }));
  }
  socket.handshake(host.empty() ? "127.0.0.1:" + std::to_string(port) : host, target);
}
Page::~Page() = default;

void Page::say(const std::string& text) {
  connection_->socket.text(true);
  connection_->socket.write(asio::buffer(text));
}

void Page::send_raw(const std::string& bytes) {
  asio::write(connection_->socket.next_layer(), asio::buffer(bytes));
}

std::string Page::next(bool text) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(2);
  while (std::chrono::steady_clock::now() < end) {
    beast::flat_buffer buffer;
    connection_->socket.read(buffer);
    if (connection_->socket.got_text() == text) return beast::buffers_to_string(buffer.data());
  }
  throw std::runtime_error(text ? "no text came within two minutes"
                                : "no frame came within two minutes");
}

Json Page::next_text(const std::string& type) {
  for (;;) {
    Json json = next_text();
    if (json.at("type") == type) return json;
  }
}

bool Page::hears() const {
  return connection_->socket.next_layer().available() > 0;
}

void Page::catch_up() {
  while (hears()) {
    beast::flat_buffer buffer;
    connection_->socket.read(buffer);
  }
}

void Page::read_to_the_end() {
  boost::system::error_code wrong;
  while (!wrong) {
    beast::flat_buffer buffer;
    connection_->socket.read(buffer, wrong);
  }
}

std::uint32_t u32_at(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;)
    value = value << 8 | static_cast<unsigned char>(bytes.at(at + i));
  return value;
}

int section_count(const std::string& bytes, unsigned id) {
  std::size_t at = 16;
  while (at < bytes.size()) {
    const std::uint32_t head = u32_at(bytes, at);
    if ((head & 0xFFFFU) == id) return static_cast<int>(head >> 16);
    at += 8 + (u32_at(bytes, at + 4) + 7) / 8 * 8;
  }
  return -1;
}

bool has_section(const std::string& bytes, unsigned id) {
  return section_count(bytes, id) >= 0;
}

}  // namespace prostm::test
