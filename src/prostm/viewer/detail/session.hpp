#pragma once
/// One connection: HTTP requests, and a page after the upgrade to a WebSocket.

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "prostm/viewer/detail/http_answer.hpp"
#include "prostm/viewer/detail/hub.hpp"

namespace prostm::viewer {

namespace beast = boost::beast;
namespace http = beast::http;

/// Lives as long as an operation on its socket is in progress.
class Session : public std::enable_shared_from_this<Session> {
 public:
  Session(boost::asio::ip::tcp::socket&& socket, Hub& hub);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  void run() { read_request(); }

  // for pages, called once per tick
  std::uint32_t id() const { return id_; }
  Room room() const { return room_; }
  double rate() const { return rate_; }  ///< requested rate of frames [Hz]
  /// Sends the hub's frame if one is due at `now` and nothing is in flight.
  void offer_frame(Clock::time_point now, EncodedFrame& frame);
  /// Sends the hub's new state of its room.
  void tell_state();
  /// Sends an error. @param control the control that could not be set, if known.
  void tell_error(const std::string& sentence, const std::string& control = "");
  /// Closes the connection if a write has been pending for longer than stall_time.
  void check_stall(Clock::time_point now);

 private:
  const std::shared_ptr<const std::string>& state() const {
    return hub_.states[static_cast<std::size_t>(room_)];
  }
  void read_request();
  void on_request(beast::error_code wrong);
  void reply(const HttpAnswer& answer, bool keep_alive, bool head);
  void upgrade(Room room);
  void read_message();
  void on_message(const std::string& text);
  void pump();
  void write(boost::asio::const_buffer bytes, bool text);
  void drop();
  void close();

  Hub& hub_;
  beast::flat_buffer buffer_;
  beast::tcp_stream stream_;  // until the upgrade
  std::optional<http::request_parser<http::empty_body>> parser_;
  std::string answer_;  // text of the answer being written
  std::optional<beast::websocket::stream<beast::tcp_stream, false>> socket_;  // no compression

  std::uint32_t id_ = 0;  // id of the page; 0 before the upgrade
  Room room_ = Room::Main;
  double rate_ = kPageRate;
  Clock::time_point due_{}, write_began_{}, second_began_{};
  bool writing_ = false, state_waits_ = false;
  ViewNews sent_;  // newest large sections that were sent
  std::shared_ptr<const void> in_flight_;
  std::deque<std::shared_ptr<const std::string>> texts_;
  int nonsense_ = 0;  // successive malformed messages
  int messages_ = 0;  // number of messages since second_began_
};

}  // namespace prostm::viewer
