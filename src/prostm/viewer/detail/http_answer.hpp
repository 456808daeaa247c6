#pragma once
/// The server's answers to HTTP requests, without sockets, so that every case can be tested.

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "prostm/viewer/page_files.hpp"
#include "prostm/viewer/view_source.hpp"

namespace prostm {

/// The relevant parts of a request.
struct HttpRequest {
  std::string_view method, target;
  std::string_view host, origin;  ///< headers; empty if absent
  bool ambiguous = false;         ///< one of these headers is repeated
  bool upgrade = false;           ///< requests an upgrade to a WebSocket
};

struct HttpAnswer {
  unsigned status = 200;
  std::string_view type = "text/plain; charset=utf-8";
  std::string_view body;          ///< bytes of a page file; unused if there is `text`
  std::string text;               ///< content made for this answer
  std::optional<Room> live = {};  ///< room of the WebSocket; other members are then unused

  std::string_view content() const { return text.empty() ? body : std::string_view(text); }
};

/// Settings of a server that affect its answers.
struct HttpScope {
  bool any_address = false;                 ///< the server listens on more than loopback
  bool guests = false;                      ///< the server has a room for guests
  std::span<const std::string> hosts = {};  ///< names of ViewSettings::hosts
};

/// Answers GET and HEAD for the page's files, by exact path ("/index.html" is "/"), and for
/// /numbers.json, and accepts the WebSockets /live and, with guests, /guest/live.
///
/// 400: no Host, or two. 403: a Host that is a name other than localhost and those in `hosts`, or,
/// unless `any_address`, an address that is not loopback (against DNS rebinding: a foreign site can
/// resolve its name to our address); or an Origin of another host. Under a name of `hosts`, the
/// Origin may be https, of a proxy. Programs send no Origin and are accepted.
/// @param numbers makes the body of /numbers.json; empty if the numbers may not be seen now, which
/// gives 403.
HttpAnswer answer(const HttpRequest& request, std::span<const PageFile> files, HttpScope scope,
                  const std::function<std::string()>& numbers);

/// Whether a name can be one of ViewSettings::hosts: letters, digits, '-' and '.', no address.
bool is_host_name(std::string_view name);

}  // namespace prostm
