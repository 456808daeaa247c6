#pragma once
/// The server's answer to a request: no sockets, so that every case can be tried.

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "prostm/viewer/page_files.hpp"
#include "prostm/viewer/view_source.hpp"

namespace prostm {

/// The parts of a request that count.
struct HttpRequest {
  std::string_view method, target;
  std::string_view host, origin;  ///< headers; empty without
  bool ambiguous = false;         ///< one of these headers is there twice
  bool upgrade = false;           ///< to a WebSocket
};

struct HttpAnswer {
  unsigned status = 200;
  std::string_view type = "text/plain; charset=utf-8";
  std::string_view body;          ///< of a page file, or `text`
  std::string text;               ///< what was made for this answer
  std::optional<Room> live = {};  ///< go on as a WebSocket of this room: nothing else counts

  std::string_view content() const { return text.empty() ? body : std::string_view(text); }
};

/// The ways in which servers differ.
struct HttpScope {
  bool any_address = false;  ///< listens on more than loopback
  bool guests = false;       ///< has a room for them
};

/// GET and HEAD of the page's files, by their exact paths alone ("/index.html" is "/"), of
/// /numbers.json, and the WebSockets /live and, with guests, /guest/live.
///
/// 400: no Host, or two. 403: a Host that is a name other than localhost, or an address that is not
/// loopback unless `any_address`, since a foreign site can give its own name our address; or an
/// Origin that is not the same host. Programs send no Origin and are let in.
/// @param numbers makes the body of /numbers.json; an empty one where nobody may see them now is
/// 403.
HttpAnswer answer(const HttpRequest& request, std::span<const PageFile> files, HttpScope scope,
                  const std::function<std::string()>& numbers);

/// Whether a Host header says localhost or an address, loopback unless `any_address`, with or
/// without a port.
bool host_allowed(std::string_view host, bool any_address);

}  // namespace prostm
