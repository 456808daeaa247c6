#pragma once
/// The page's server: HTTP and one WebSocket, on a thread of its own (docs/design/viewer.md).

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "prostm/viewer/page_files.hpp"
#include "prostm/viewer/view_source.hpp"

namespace prostm {

struct ViewSettings {
  std::string address = "127.0.0.1";  ///< address to listen on, as a literal
  /// TCP port; 0: any free port. If not given, the first free port from kViewPort on.
  std::optional<int> port;
  /// Names under which the page may be requested besides localhost, as of this machine in its
  /// network or of a proxy.
  std::vector<std::string> hosts;
  bool guests = false;         ///< serve /guest/live
  int max_pages = 16;          ///< largest number of WebSockets
  int max_connections = 64;    ///< largest number of connections, HTTP and WebSocket
  double request_time = 10.0;  ///< time limit for a request and its answer [s]
  double stall_time = 20.0;    ///< a page that does not read for this time is dropped [s]
  double idle_time = 30.0;     ///< a page that does not answer pings for this time is dropped [s]
};

inline constexpr int kViewPort = 8470, kViewPortTries = 20;

/// Counters since the start.
struct ViewStats {
  std::int64_t frames = 0;          ///< frames passed to sockets, over all pages
  std::int64_t skipped_frames = 0;  ///< frames skipped because a page was too slow
  std::int64_t bytes = 0;           ///< size of the frames passed to sockets
  std::int64_t dropped_pages = 0;   ///< stalled for stall_time, or kept sending malformed messages
  int pages = 0;                    ///< currently open
};

/// Listens from construction to destruction. A page that reads slowly gets fewer frames and does
/// not affect others: at most one write is in flight for each page.
class ViewServer {
 public:
  /// @param source, files must outlive the server.
  /// @throws InputError with a sentence: an address that is invalid or not of this machine, a port
  /// that is in use, a host that is no name.
  ViewServer(const ViewSettings& settings, ViewSource& source, std::span<const PageFile> files);
  ~ViewServer();

  int port() const;
  std::string url() const;  ///< "http://127.0.0.1:8470/"
  bool loopback() const;    ///< whether only this machine can reach it
  ViewStats stats() const;  ///< thread-safe
  /// Thread-safe. @throws std::runtime_error if the server has failed and stopped.
  void check() const;
  double cpu_time() const;  ///< CPU time of the server's thread so far [s]; thread-safe

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace prostm
