#include "run/core_load.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <system_error>
#include <thread>
#include <vector>

#include "prostm/core/input_error.hpp"
#include "prostm/pipeline/realtime/cores.hpp"

namespace prostm::app {
namespace {

/// Uses processor and memory, as another program would.
void work(const std::atomic<bool>& works, const std::atomic<bool>& ends) {
  std::vector<double> numbers(1 << 18, 1.0);
  while (!ends) {
    if (!works) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      continue;
    }
    for (std::size_t i = 1; i < numbers.size(); ++i)
      numbers[i] = 0.5 * (numbers[i] + numbers[i - 1]) + 1e-9;
  }
}

/// The child process: each byte from the pipe switches work on or off; it ends with the pipe.
[[noreturn]] void serve(int pipe) {
  // the parent ends it, after a Ctrl-C once the results are written
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGUSR2, SIGALRM})
    std::signal(signal, SIG_IGN);
  std::atomic<bool> works{false}, ends{false};
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < usable_cores(); ++i) threads.emplace_back([&] { work(works, ends); });
    char order = 0;
    for (;;) {
      const ssize_t count = read(pipe, &order, 1);
      if (count == 1) works = order == '1';
      if (count == 0 || (count < 0 && errno != EINTR)) break;
    }
    ends = true;
  }
  _exit(0);
}

}  // namespace

CoreLoad::CoreLoad() {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0 || (child_ = fork()) < 0) {
    throw InputError("--load needs a process of its own, which cannot be made (" +
                     std::generic_category().message(errno) + ")");
  }
  if (child_ == 0) {
    close(ends[1]);
    serve(ends[0]);
  }
  close(ends[0]);
  pipe_ = ends[1];
}

void CoreLoad::set(bool works) {
  if (works == works_) return;
  works_ = works;
  const char order = works ? '1' : '0';
  while (write(pipe_, &order, 1) < 0 && errno == EINTR) {
  }
}

CoreLoad::~CoreLoad() {
  close(pipe_);
  waitpid(child_, nullptr, 0);
}

}  // namespace prostm::app
