#include "report/print_page.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <vector>

extern char** environ;

namespace prostm::app {
namespace {

namespace fs = std::filesystem;

/// Runs a program without input and output. @return whether it succeeded.
bool ran(std::vector<std::string> words) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t quiet;
  posix_spawn_file_actions_init(&quiet);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&quiet, stream, "/dev/null", O_RDWR, 0);
  pid_t child = 0;
  const int failed =
      posix_spawn(&child, words.front().c_str(), &quiet, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&quiet);
  if (failed != 0) return false;
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

/// A folder that exists as long as this object.
class OwnFolder {
 public:
  OwnFolder() {
    name_ = (fs::temp_directory_path() / "prostm-print-XXXXXX").string();
    if (mkdtemp(name_.data()) == nullptr) name_.clear();
  }
  ~OwnFolder() {
    std::error_code ignored;
    if (!name_.empty()) fs::remove_all(name_, ignored);
  }
  OwnFolder(const OwnFolder&) = delete;
  OwnFolder& operator=(const OwnFolder&) = delete;
  const std::string& name() const { return name_; }

 private:
  std::string name_;
};

}  // namespace

std::optional<std::string> find_browser() {
  const char* path = std::getenv("PATH");
  std::string folders = path != nullptr ? path : "";
  for (std::size_t at = 0; at < folders.size();) {
    const std::size_t end = std::min(folders.find(':', at), folders.size());
    for (const char* name : {"chromium", "chromium-browser", "google-chrome"}) {
      const std::string file = folders.substr(at, end - at) + "/" + name;
      if (access(file.c_str(), X_OK) == 0) return file;
    }
    at = end + 1;
  }
  return std::nullopt;
}

bool print_page(const std::string& browser, const std::string& page, const std::string& pdf) {
  const OwnFolder profile;
  if (profile.name().empty()) return false;
  const std::string made = profile.name() + "/page.pdf";
  std::vector<std::string> words = {browser,
                                    "--headless",
                                    "--disable-gpu",
                                    "--disable-background-networking",
                                    "--no-first-run",
                                    "--no-pdf-header-footer",
                                    "--user-data-dir=" + profile.name() + "/profile",
                                    "--print-to-pdf=" + made,
                                    "file://" + fs::absolute(page).string()};
  // its sandbox does not start for root
  if (geteuid() == 0) words.insert(words.begin() + 1, "--no-sandbox");
  std::error_code failure;
  if (!ran(std::move(words)) || fs::file_size(made, failure) == 0 || failure) return false;
  const std::string beside = pdf + ".part";
  fs::copy_file(made, beside, fs::copy_options::overwrite_existing, failure);
  if (!failure) fs::rename(beside, pdf, failure);
  return !failure;
}

}  // namespace prostm::app
