#include "viewer/http_answer.hpp"

#include <algorithm>
#include <boost/asio/ip/address.hpp>
#include <cctype>

namespace prostm {
namespace {

HttpAnswer refuse(unsigned status, std::string_view sentence) {
  HttpAnswer a;
  a.status = status;
  a.body = sentence;
  return a;
}

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

/// Whether the Origin is the page that this host served.
bool same_origin(std::string_view origin, std::string_view host) {
  return origin.empty() || lower(origin) == "http://" + lower(host);
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
                  "/numbers.json are there.\n");
  return refuse(404, "There is no such file here; the page is at /.\n");
}

}  // namespace

bool host_allowed(std::string_view host, bool any_address) {
  // the port does not matter: it may come through a tunnel
  std::string_view name = host;
  const std::size_t colon = name.rfind(':');
  if (!name.empty() && name.front() == '[') {
    const std::size_t end = name.find(']');
    if (end == std::string_view::npos) return false;
    name = name.substr(1, end - 1);
  } else if (colon != std::string_view::npos) {
    const std::string_view port = name.substr(colon + 1);
    if (port.empty() || !std::all_of(port.begin(), port.end(),
                                     [](unsigned char c) { return std::isdigit(c) != 0; })) {
      return false;
    }
    name = name.substr(0, colon);
  }
  if (lower(name) == "localhost") return true;
  boost::system::error_code wrong;
  const auto address = boost::asio::ip::make_address(std::string(name), wrong);
  return !wrong && (any_address || address.is_loopback());
}

HttpAnswer answer(const HttpRequest& request, std::span<const PageFile> files, bool any_address,
                  const std::function<std::string()>& numbers) {
  if (request.host.empty()) return refuse(400, "The request has no Host.\n");
  if (!host_allowed(request.host, any_address))
    return refuse(403, "This server answers to its own address and to localhost alone.\n");
  if (!same_origin(request.origin, request.host))
    return refuse(403, "Pages of other sites have no business here.\n");
  if (request.method != "GET" && request.method != "HEAD")
    return refuse(405, "Only GET and HEAD are understood.\n");
  if (request.target.empty() || request.target.front() != '/')
    return refuse(400, "The target of a request must begin with /.\n");

  const std::string_view path = request.target.substr(0, request.target.find('?'));
  if (path == "/live") {
    if (!request.upgrade || request.method != "GET")
      return refuse(426, "/live is a WebSocket (docs/wire.md).\n");
    HttpAnswer a;
    a.live = true;
    return a;
  }
  if (path == "/numbers.json") {
    HttpAnswer a;
    a.type = "application/json";
    a.text = numbers();
    return a;
  }
  return file_answer(path, files);
}

}  // namespace prostm
