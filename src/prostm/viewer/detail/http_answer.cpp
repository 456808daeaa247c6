#include "prostm/viewer/detail/http_answer.hpp"

#include <algorithm>
#include <boost/asio/ip/address.hpp>
#include <cctype>
#include <cstdint>

#include "prostm/core/text/lower_case.hpp"

namespace prostm {
namespace {

HttpAnswer refuse(unsigned status, std::string_view sentence) {
  HttpAnswer a;
  a.status = status;
  a.body = sentence;
  return a;
}

/// Whether the Origin is a page served by this host. @param proxied whether it may be https.
bool same_origin(std::string_view origin, std::string_view host, bool proxied) {
  if (origin.empty()) return true;
  const std::string own = lower_case(host), page = lower_case(origin);
  return page == "http://" + own || (proxied && page == "https://" + own);
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

/// Kinds of hosts that a Host header names.
enum class HostKind : std::uint8_t { Foreign, Own, Named };

HostKind kind_of(std::string_view host, const HttpScope& scope) {
  // NAME, NAME:PORT, [ADDRESS] or [ADDRESS]:PORT
  const bool brackets = !host.empty() && host.front() == '[';
  const std::size_t end = brackets ? host.find(']') : host.find(':');
  if (brackets && end == std::string_view::npos) return HostKind::Foreign;
  const std::string name = lower_case(brackets ? host.substr(1, end - 1) : host.substr(0, end));
  if (!is_port(host.substr(std::min(host.size(), brackets ? end + 1 : end))))
    return HostKind::Foreign;
  if (name == "localhost") return HostKind::Own;
  const auto is_it = [&](const std::string& own) { return lower_case(own) == name; };
  if (!brackets && std::any_of(scope.hosts.begin(), scope.hosts.end(), is_it))
    return HostKind::Named;
  boost::system::error_code wrong;
  const auto address = boost::asio::ip::make_address(name, wrong);
  const bool own = !wrong && (scope.any_address || address.is_loopback());
  return own ? HostKind::Own : HostKind::Foreign;
}

}  // namespace

bool is_host_name(std::string_view name) {
  constexpr std::size_t kLongest = 253;
  const auto fits = [](unsigned char c) { return std::isalnum(c) != 0 || c == '-' || c == '.'; };
  boost::system::error_code not_an_address;
  static_cast<void>(boost::asio::ip::make_address(std::string(name), not_an_address));
  return !name.empty() && name.size() <= kLongest && not_an_address &&
         std::all_of(name.begin(), name.end(), fits);
}

HttpAnswer answer(const HttpRequest& request, std::span<const PageFile> files, HttpScope scope,
                  const std::function<std::string()>& numbers) {
  if (request.host.empty()) return refuse(400, "The request has no Host.\n");
  if (request.ambiguous)
    return refuse(400, "The request has more than one Host or more than one Origin.\n");
  const HostKind host = kind_of(request.host, scope);
  if (host == HostKind::Foreign) {
    return refuse(
        403,
        "This server answers only to its own address, to localhost, and to the names that "
        "--view-host gives.\n");
  }
  if (!same_origin(request.origin, request.host, host == HostKind::Named))
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
