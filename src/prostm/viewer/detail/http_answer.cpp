#include "prostm/viewer/detail/http_answer.hpp"

#include <algorithm>
#include <boost/asio/ip/address.hpp>
#include <cctype>

#include "prostm/core/text/lower_case.hpp"

namespace prostm {
namespace {

HttpAnswer refuse(unsigned status, std::string_view sentence) {
  HttpAnswer a;
  a.status = status;
  a.body = sentence;
  return a;
}

/// Whether the Origin is a page served by this host.
bool same_origin(std::string_view origin, std::string_view host) {
  return origin.empty() || lower_case(origin) == "http://" + lower_case(host);
}

HttpAnswer file_answer(std::string_view path, std::span<const PageFile> files) {
  if (path == "/index.html") path = "/";
  for (const PageFile& file : files) {
    if (file.path != path) continue;
    HttpAnswer a;
    a.type = file.type;
    a.body = {reinterpret_cast<const char*>(file.bytes.data()), file.bytes.size()};
    return a;
  }
  if (path == "/" && files.empty())
    return refuse(200,
                  "This build of prostm has no page (PROSTM_PAGE=OFF); /live and "
                  "/numbers.json are available.\n");
  return refuse(404, "There is no such file here; the page is at /.\n");
}

/// Whether the text after a host is empty or a port. Any port is allowed: the connection may come
/// through a tunnel.
bool is_port(std::string_view text) {
  if (text.empty()) return true;
  return text.front() == ':' && text.size() > 1 &&
         std::all_of(text.begin() + 1, text.end(),
                     [](unsigned char c) { return std::isdigit(c) != 0; });
}

}  // namespace

bool host_allowed(std::string_view host, bool any_address) {
  // NAME, NAME:PORT, [ADDRESS] or [ADDRESS]:PORT
  const bool brackets = !host.empty() && host.front() == '[';
  const std::size_t end = brackets ? host.find(']') : host.find(':');
  if (brackets && end == std::string_view::npos) return false;
  const std::string_view name = brackets ? host.substr(1, end - 1) : host.substr(0, end);
  if (!is_port(host.substr(std::min(host.size(), brackets ? end + 1 : end)))) return false;
  if (lower_case(name) == "localhost") return true;
  boost::system::error_code wrong;
  const auto address = boost::asio::ip::make_address(std::string(name), wrong);
  return !wrong && (any_address || address.is_loopback());
}

HttpAnswer answer(const HttpRequest& request, std::span<const PageFile> files, HttpScope scope,
                  const std::function<std::string()>& numbers) {
  if (request.host.empty()) return refuse(400, "The request has no Host.\n");
  if (request.ambiguous)
    return refuse(400, "The request has more than one Host or more than one Origin.\n");
  if (!host_allowed(request.host, scope.any_address))
    return refuse(403, "This server answers only to its own address and to localhost.\n");
  if (!same_origin(request.origin, request.host))
    return refuse(403, "Requests from pages of other sites are refused.\n");
  if (request.method != "GET" && request.method != "HEAD")
    return refuse(405, "Only GET and HEAD are supported.\n");
  if (request.target.empty() || request.target.front() != '/')
    return refuse(400, "The target of a request must begin with /.\n");

  const std::string_view path = request.target.substr(0, request.target.find('?'));
  if (path == "/live" || (scope.guests && path == "/guest/live")) {
    if (!request.upgrade || request.method != "GET")
      return refuse(426, "This is a WebSocket (docs/reference/wire.md).\n");
    HttpAnswer a;
    a.live = path == "/live" ? Room::Main : Room::Guest;
    return a;
  }
  if (path == "/numbers.json") {
    HttpAnswer a;
    a.type = "application/json";
    a.text = numbers();
    return a.text.empty() ? refuse(403, "The numbers may not be seen now.\n") : a;
  }
  return file_answer(path, files);
}

}  // namespace prostm
