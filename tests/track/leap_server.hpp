#pragma once
/// A Leap service for tests that sends messages at their own times, on a free port.

#include <atomic>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace prostm::test {

class LeapServer {
 public:
  struct Message {
    double time;  // since the connection [s]
    std::string text;
  };

  /// Sends `messages` to every client that requests `path`, repeatedly if `loop`.
  /// @throws boost::system::system_error if the address does not exist.
  explicit LeapServer(std::vector<Message> messages, bool loop = false,
                      std::string path = "/v6.json", const std::string& address = "127.0.0.1")
      : messages_(std::move(messages)),
        loop_(loop),
        path_(std::move(path)),
        acceptor_(io_, {boost::asio::ip::make_address(address), 0}) {
    accept();
    thread_ = std::thread([this] { io_.run(); });
  }
  ~LeapServer() {
    io_.stop();
    thread_.join();
  }

  std::uint16_t port() const { return port_; }
  /// The Host header of the newest client. @pre requests() has returned.
  const std::string& host() const { return host_; }
  /// Waits until clients have sent `count` messages; returns all so far.
  std::vector<std::string> requests(std::size_t count) {
    while (said_ < count) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::vector<std::string> all;
    std::atomic<bool> done{false};
    boost::asio::post(io_, [&] {
      all = requests_;
      done = true;
    });
    while (!done) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return all;
  }
  /// Closes all connections without a message.
  void cut() {
    boost::asio::post(io_, [this] {
      for (const auto& session : sessions_) session->close();
      sessions_.clear();
    });
  }

 private:
  using tcp = boost::asio::ip::tcp;
  using error_code = boost::system::error_code;

  struct Session : std::enable_shared_from_this<Session> {
    Session(LeapServer& owner, tcp::socket socket)
        : server(owner), stream(std::move(socket)), timer(server.io_) {}

    void start() {
      boost::beast::http::async_read(stream.next_layer(), buffer, request,
                                     [self = shared_from_this()](error_code error, std::size_t) {
                                       if (!error) self->answer();
                                     });
    }
    void answer() {
      namespace http = boost::beast::http;
      server.host_ = std::string(request[http::field::host]);
      if (request.target() != server.path_) {
        auto refusal = std::make_shared<http::response<http::string_body>>(http::status::not_found,
                                                                           request.version(), "no");
        refusal->prepare_payload();
        http::async_write(
            stream.next_layer(), *refusal,
            [self = shared_from_this(), refusal](error_code, std::size_t) { self->close(); });
        return;
      }
      stream.async_accept(request, [self = shared_from_this()](error_code error) {
        if (error) return;
        self->begun = std::chrono::steady_clock::now();
        self->buffer.clear();
        self->listen();
        self->send(R"({"serviceVersion":"2.3.1+33747","version":6})", [self] { self->play(0); });
      });
    }
    void listen() {
      stream.async_read(buffer, [self = shared_from_this()](error_code error, std::size_t) {
        if (error) return;
        self->server.requests_.push_back(boost::beast::buffers_to_string(self->buffer.cdata()));
        ++self->server.said_;
        self->buffer.clear();
        self->listen();
      });
    }
    void play(std::size_t i) {
      if (i == server.messages_.size()) {
        if (!server.loop_ || i == 0) return;
        i = 0;
        begun = std::chrono::steady_clock::now();
      }
      timer.expires_at(begun + std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                                   std::chrono::duration<double>(server.messages_[i].time)));
      timer.async_wait([self = shared_from_this(), i](error_code error) {
        if (!error) self->send(self->server.messages_[i].text, [self, i] { self->play(i + 1); });
      });
    }
    template <class Next>
    void send(const std::string& text, Next next) {
      stream.text(true);
      stream.async_write(boost::asio::buffer(text),
                         [self = shared_from_this(), next](error_code error, std::size_t) {
                           if (!error) next();
                         });
    }
    void close() {
      timer.cancel();
      error_code ignored;
      stream.next_layer().close(ignored);
    }

    LeapServer& server;
    boost::beast::websocket::stream<tcp::socket, false> stream;
    boost::asio::steady_timer timer;
    boost::beast::flat_buffer buffer;
    boost::beast::http::request<boost::beast::http::string_body> request;
    std::chrono::steady_clock::time_point begun;
  };

  void accept() {
    acceptor_.async_accept([this](error_code error, tcp::socket socket) {
      if (error) return;
      sessions_.push_back(std::make_shared<Session>(*this, std::move(socket)));
      sessions_.back()->start();
      accept();
    });
  }

  std::vector<Message> messages_;
  bool loop_;
  std::string path_;
  boost::asio::io_context io_{1};
  tcp::acceptor acceptor_;
  std::uint16_t port_ = acceptor_.local_endpoint().port();
  std::vector<std::shared_ptr<Session>> sessions_;
  std::vector<std::string> requests_;
  std::string host_;
  std::atomic<std::size_t> said_{0};
  std::thread thread_;
};

}  // namespace prostm::test
