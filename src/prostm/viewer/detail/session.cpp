#include "prostm/viewer/detail/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace prostm::viewer {
namespace {

namespace asio = boost::asio;
namespace websocket = beast::websocket;

constexpr std::uint32_t kMaxHeader = 8192;  // [bytes]
constexpr std::size_t kMaxTexts = 64;       // largest number of texts waiting to be sent to a page
constexpr int kMaxNonsense = 100;           // successive malformed messages
constexpr int kMaxMessages = 2000;          // messages per second
constexpr int kSendBuffer = 256 * 1024;  // kernel buffer, small so that few frames in it are stale
constexpr std::string_view kServer = "prostm";

std::chrono::nanoseconds nanoseconds(double seconds) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
      std::chrono::duration<double>(seconds));
}

std::string_view view(beast::string_view text) {
  return {text.data(), text.size()};
}

/// Sets headers that allow only the page's own files and its own socket to be fetched, run or
/// framed.
void set_headers(http::fields& response, std::string_view host) {
  response.set(http::field::server, kServer);
  response.set(http::field::cache_control, "no-cache");
  response.set("X-Content-Type-Options", "nosniff");
  response.set("Referrer-Policy", "no-referrer");
  response.set("Cross-Origin-Resource-Policy", "same-origin");
  response.set("Content-Security-Policy",
               "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; "
               "media-src 'self' blob:; connect-src 'self'" +
                   (host.empty() ? "" : fmt::format(" ws://{0} wss://{0}", host)) +
                   "; object-src 'none'; base-uri 'none'; form-action 'none'; "
                   "frame-ancestors 'none'");
}

}  // namespace

Session::Session(asio::ip::tcp::socket&& socket, Hub& hub) : hub_(hub), stream_(std::move(socket)) {
  ++hub_.connections;
}

Session::~Session() {
  --hub_.connections;
  if (id_ == 0) return;
  hub_.pages.erase(std::remove(hub_.pages.begin(), hub_.pages.end(), this), hub_.pages.end());
  hub_.count.pages = static_cast<int>(hub_.pages.size());
  hub_.source.forget(id_);
  if (hub_.pages.empty()) hub_.source.watch(false);
}

// ---- requests ----

void Session::read_request() {
  parser_.emplace();
  parser_->header_limit(kMaxHeader);
  stream_.expires_after(nanoseconds(hub_.settings.request_time));
  http::async_read(stream_, buffer_, *parser_,
                   [self = shared_from_this()](beast::error_code wrong, std::size_t) {
                     self->on_request(wrong);
                   });
}

void Session::on_request(beast::error_code wrong) {
  if (wrong == http::error::end_of_stream || wrong == http::error::partial_message) return close();
  if (wrong) {
    // answer a malformed request; a closed connection cannot be answered
    if (wrong.category() != http::make_error_code(http::error::bad_method).category())
      return close();
    HttpAnswer bad;
    bad.status = wrong == http::error::header_limit ? 431 : 400;
    bad.body = "This is not a valid HTTP request.\n";
    return reply(bad, false, false);
  }
  const auto& request = parser_->get();
  HttpRequest parts;
  parts.method = view(request.method_string());
  parts.target = view(request.target());
  parts.host = view(request[http::field::host]);
  parts.origin = view(request[http::field::origin]);
  parts.ambiguous = request.count(http::field::host) > 1 || request.count(http::field::origin) > 1;
  parts.upgrade = websocket::is_upgrade(request);
  HttpAnswer a =
      answer(parts, hub_.files, {hub_.any_address, hub_.settings.guests, hub_.settings.hosts},
             [this] { return hub_.numbers(); });
  if (a.live && static_cast<int>(hub_.pages.size()) >= hub_.settings.max_pages) {
    a = {};
    a.status = 503;
    a.body = "Too many pages are open.\n";
  }
  if (a.live) return upgrade(*a.live);
  // close the connection after an ambiguous request
  reply(a, request.keep_alive() && a.status != 400, parts.method == "HEAD");
}

void Session::reply(const HttpAnswer& a, bool keep_alive, bool head) {
  answer_ = a.text;
  const std::string_view content = answer_.empty() ? a.body : std::string_view(answer_);
  const auto status = static_cast<http::status>(a.status);
  auto response = std::make_shared<http::response<http::span_body<const char>>>(status, 11);
  if (!head) response->body() = {content.data(), content.size()};
  response->set(http::field::content_type, beast::string_view(a.type.data(), a.type.size()));
  response->content_length(content.size());
  response->keep_alive(keep_alive);
  set_headers(*response, a.status == 200 ? view(parser_->get()[http::field::host]) : "");
  if (status == http::status::method_not_allowed) response->set(http::field::allow, "GET, HEAD");
  http::async_write(stream_, *response,
                    [self = shared_from_this(), response](beast::error_code wrong, std::size_t) {
                      if (wrong || !response->keep_alive()) return self->close();
                      self->read_request();
                    });
}

void Session::close() {
  beast::error_code ignored;
  stream_.socket().shutdown(asio::ip::tcp::socket::shutdown_send, ignored);
}

// ---- the page ----

void Session::upgrade(Room room) {
  room_ = room;
  stream_.expires_never();
  beast::error_code ignored;
  stream_.socket().set_option(asio::ip::tcp::no_delay(true), ignored);
  stream_.socket().set_option(asio::socket_base::send_buffer_size(kSendBuffer), ignored);
  socket_.emplace(std::move(stream_));
  socket_->set_option(websocket::stream_base::timeout{nanoseconds(hub_.settings.request_time),
                                                      nanoseconds(hub_.settings.idle_time), true});
  socket_->read_message_max(kMaxPageMessage);
  socket_->auto_fragment(false);
  socket_->async_accept(parser_->get(), [self = shared_from_this()](beast::error_code wrong) {
    if (wrong) return;
    Hub& hub = self->hub_;
    self->id_ = ++hub.last_page;
    if (hub.pages.empty()) hub.source.watch(true);
    hub.pages.push_back(self.get());
    hub.count.pages = static_cast<int>(hub.pages.size());
    self->texts_.push_back(
        std::make_shared<const std::string>(hub.source.hello(self->id_, self->room_)));
    self->state_waits_ = !self->state()->empty();
    self->pump();
    self->buffer_.clear();
    self->read_message();
  });
}

void Session::read_message() {
  socket_->async_read(buffer_, [self = shared_from_this()](beast::error_code wrong, std::size_t) {
    // an oversized message has already closed the connection
    if (wrong) return self->drop();
    if (self->socket_->got_text()) {
      self->on_message(beast::buffers_to_string(self->buffer_.data()));
    } else {
      self->on_message({});
    }
    self->buffer_.clear();
    self->read_message();
  });
}

void Session::on_message(const std::string& text) {
  const auto now = Clock::now();
  if (now - second_began_ > std::chrono::seconds(1)) {
    second_began_ = now;
    messages_ = 0;
  }
  PageMessage message;
  std::string problem;
  const bool read = read_page_message(text, message, problem);
  nonsense_ = read ? 0 : nonsense_ + 1;
  if (nonsense_ >= kMaxNonsense || ++messages_ > kMaxMessages) {
    ++hub_.count.dropped;
    return drop();
  }
  if (read) {
    if (const auto* wanted = std::get_if<RateMessage>(&message)) {
      rate_ = wanted->rate;
      return;
    }
    problem = hub_.source.take(id_, message);
  }
  if (problem.empty()) return;
  const auto* set = read ? std::get_if<SetMessage>(&message) : nullptr;
  tell_error(problem, set == nullptr ? "" : set->id);
}

void Session::tell_error(const std::string& sentence, const std::string& control) {
  nlohmann::ordered_json json = {{"type", "error"}, {"sentence", sentence}};
  if (!control.empty()) json["id"] = control;
  if (texts_.size() >= kMaxTexts) return;  // the page does not read them: see check_stall()
  texts_.push_back(std::make_shared<const std::string>(
      json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace)));
  pump();
}

void Session::tell_state() {
  state_waits_ = true;
  pump();
}

void Session::offer_frame(Clock::time_point now, EncodedFrame& frame) {
  const auto period = nanoseconds(1.0 / rate_);
  if (now + period / 4 < due_) return;
  // keeps the rate, unless it has fallen behind
  due_ = std::max(due_ + period, now);
  if (!hub_.source.shows_frames(room_)) return;
  if (writing_) {
    ++hub_.count.skipped;
    return;
  }
  const bool smoke = sent_.smoke != hub_.news.smoke, fields = sent_.fields != hub_.news.fields;
  const auto bytes = frame.message(hub_.frame, smoke, fields);
  sent_ = hub_.news;
  in_flight_ = bytes;
  ++hub_.count.frames;
  hub_.count.bytes += static_cast<std::int64_t>(bytes->size());
  write(asio::buffer(*bytes), false);
}

/// Sends pending texts before frames: they are few, and none may be lost.
void Session::pump() {
  if (writing_) return;
  if (!texts_.empty()) {
    const auto text = texts_.front();
    texts_.pop_front();
    in_flight_ = text;
    write(asio::buffer(*text), true);
  } else if (state_waits_) {
    state_waits_ = false;
    const auto newest = state();
    in_flight_ = newest;
    write(asio::buffer(*newest), true);
  }
}

void Session::write(asio::const_buffer bytes, bool text) {
  writing_ = true;
  write_began_ = Clock::now();
  socket_->text(text);
  socket_->async_write(bytes, [self = shared_from_this()](beast::error_code wrong, std::size_t) {
    if (wrong) return self->drop();
    self->writing_ = false;
    self->pump();
  });
}

void Session::check_stall(Clock::time_point now) {
  if (!writing_ || now - write_began_ < nanoseconds(hub_.settings.stall_time)) return;
  ++hub_.count.dropped;
  write_began_ = now;
  drop();
}

/// Makes all pending operations fail, so that the session ends.
void Session::drop() {
  beast::get_lowest_layer(*socket_).close();
}

}  // namespace prostm::viewer
