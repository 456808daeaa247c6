// A stand-in for AUTD3 units behind a server of v38's remote protocol. It shares nothing with the
// code under test. Prints its port, then an answer to each line of its standard input, and a report
// at its end.
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "server.hpp"

namespace {

int usage() {
  std::fprintf(stderr,
               "usage: autd3_server [--port N] [--frames-per-ms X] [--version N] [--log]\n"
               "standard input takes lines: report, quit, log FILE, rate FRAMES_PER_MS, delay MS,\n"
               "drop REPLIES, stall MS, cut MS, refuse ERROR TIMES, hot 0|1, modulation 0|1,\n"
               "version N\n");
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  standin::Options options;
  for (int i = 1; i < argc; ++i) {
    const bool more = i + 1 < argc;
    if (std::strcmp(argv[i], "--log") == 0) {
      options.keeps_log = true;
    } else if (std::strcmp(argv[i], "--port") == 0 && more) {
      options.port = std::atoi(argv[++i]);
    } else if (std::strcmp(argv[i], "--frames-per-ms") == 0 && more) {
      options.frames_per_ms = std::atof(argv[++i]);
    } else if (std::strcmp(argv[i], "--version") == 0 && more) {
      options.version = std::atoi(argv[++i]);
    } else {
      return usage();
    }
  }
  standin::Server(options).run();
  return 0;
}
