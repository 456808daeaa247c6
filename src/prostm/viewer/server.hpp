#pragma once
/// The page's server: HTTP and one WebSocket, on a thread of its own (docs/design/viewer.md).

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "prostm/viewer/page_files.hpp"
#include "prostm/viewer/view_source.hpp"

namespace prostm {

struct ViewSettings {
  std::string address = "127.0.0.1";  ///< to listen on; a literal
  /// The TCP port; 0 takes any free one. Without it, the first free port from kViewPort on.
  std::optional<int> port;
  bool guests = false;         ///< /guest/live is there
  int max_pages = 16;          ///< WebSockets at the same time
  int max_connections = 64;    ///< of HTTP and WebSocket together
  double request_time = 10.0;  ///< for a request to come and its answer to go [s]
  double stall_time = 20.0;    ///< a page that reads nothing for this long is dropped [s]
};

inline constexpr int kViewPort = 8470, kViewPortTries = 20;

/// Counters since the start.
struct ViewStats {
  std::int64_t frames = 0;          ///< handed to sockets, over all pages
  std::int64_t skipped_frames = 0;  ///< that a page was too slow for
  std::int64_t bytes = 0;           ///< of frames handed over
  std::int64_t dropped_pages = 0;   ///< that read nothing for stall_time, or went on with nonsense
  int pages = 0;                    ///< open now
};

/// Listens from construction to destruction. A page that reads slowly gets fewer frames, and costs
/// nobody else anything: one write is in flight for each page at most.
class ViewServer {
 public:
  /// @param source, files must outlive the server.
  /// @throws InputError with a sentence: an address that is invalid or not ours, a port that is in
  /// use.
  ViewServer(const ViewSettings& settings, ViewSource& source, std::span<const PageFile> files);
  ~ViewServer();

  int port() const;
  std::string url() const;  ///< "http://127.0.0.1:8470/"
  bool loopback() const;    ///< whether this machine alone can reach it
  ViewStats stats() const;  ///< any thread
  /// Any thread. @throws std::runtime_error when the server has failed and serves no longer.
  void check() const;
  double cpu_time() const;  ///< of the server's thread so far [s], any thread

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace prostm
