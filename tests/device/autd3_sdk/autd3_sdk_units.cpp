#include "device/autd3_sdk/autd3_sdk_units.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <stdexcept>

extern char** environ;

namespace prostm::test {

SdkUnits::SdkUnits(const std::vector<std::string>& options) {
  std::array<int, 2> to{}, from{};
  if (pipe2(to.data(), O_CLOEXEC) != 0 || pipe2(from.data(), O_CLOEXEC) != 0)
    throw std::runtime_error("no pipe");
  std::vector<std::string> words = {PROSTM_SDK_UNITS};
  words.insert(words.end(), options.begin(), options.end());
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, to[0], STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, from[1], STDOUT_FILENO);
  const int failed =
      posix_spawn(&process_, PROSTM_SDK_UNITS, &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  ::close(to[0]);
  ::close(from[1]);
  in_ = to[1];
  out_ = from[0];
  if (failed != 0) throw std::runtime_error("cannot start " PROSTM_SDK_UNITS);
  port_ = read_line().at("port").get<int>();
}

SdkUnits::~SdkUnits() {
  ::close(in_);
  ::close(out_);
  if (process_ > 0) {
    ::kill(process_, SIGTERM);
    ::waitpid(process_, nullptr, 0);
  }
}

nlohmann::json SdkUnits::tell(const std::string& line) {
  const std::string typed = line + "\n";
  if (::write(in_, typed.data(), typed.size()) != static_cast<ssize_t>(typed.size()))
    throw std::runtime_error("the stand-in is gone");
  return read_line();
}

nlohmann::json SdkUnits::read_line() {
  std::string line;
  for (char c = 0; c != '\n';) {
    pollfd waits{out_, POLLIN, 0};
    if (::poll(&waits, 1, 30'000) <= 0 || ::read(out_, &c, 1) != 1)
      throw std::runtime_error("the stand-in does not answer");
    line += c;
  }
  return nlohmann::json::parse(line);
}

}  // namespace prostm::test
