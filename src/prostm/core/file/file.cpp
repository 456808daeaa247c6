#include "prostm/core/file/file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include "prostm/core/input_error.hpp"

namespace prostm {
namespace {

std::string reason(int error) {
  return std::generic_category().message(error);
}

/// An open file that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&&) = delete;
  int get() const { return fd_; }
  /// Returns 0 or the error; a full disk may be detected only here.
  int close() {
    const int fd = fd_;
    fd_ = -1;
    return ::close(fd) == 0 ? 0 : errno;
  }

 private:
  int fd_;
};

/// Returns 0 or the error.
int write_all(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return errno;
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
  return 0;
}

[[noreturn]] void fail_to_write(const std::string& path, int error) {
  throw InputError(fmt::format(
      "{} cannot be written ({}); name a file in a folder that exists, is writable and has space",
      path, reason(error)));
}

/// Writes to a device or a pipe, without a temporary file.
void write_in_place(const std::string& path, std::string_view bytes) {
  Descriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
  if (file.get() < 0) fail_to_write(path, errno);
  if (const int error = write_all(file.get(), bytes); error != 0) fail_to_write(path, error);
  if (const int error = file.close(); error != 0) fail_to_write(path, error);
}

/// Opens a new, empty file beside `path` for writing and sets `temporary` to its name. The
/// temporary name does not depend on the length of the file's, which may be the longest that the
/// file system allows.
int open_temporary(const std::string& path, std::string& temporary) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  for (int attempt = 0; attempt < 100; ++attempt) {
    temporary = (folder / fmt::format(".prostm.{}.{}.tmp", ::getpid(), attempt)).string();
    const int fd = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (fd >= 0 || errno != EEXIST) return fd;
  }
  return -1;
}

/// Returns why a file cannot be opened to read, in words.
std::string reason_to_read(const std::string& path, int error) {
  if (error == EACCES) return "permission is denied";
  if (error != ENOENT && error != ENOTDIR) return reason(error);
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  std::error_code ignored;
  if (folder.empty() || std::filesystem::is_directory(folder, ignored))
    return "there is no such file";
  return "there is no folder " + folder.string();
}

/// Opens an ordinary file; refuses anything else before it is read.
Descriptor open_to_read(const std::string& path, struct stat* status) {
  // opens a pipe without waiting for a writer
  Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.get() < 0 || ::fstat(file.get(), status) != 0) {
    throw InputError(fmt::format("{} cannot be read: {}", path, reason_to_read(path, errno)));
  }
  if (S_ISDIR(status->st_mode)) throw InputError(path + " is a folder; name a file");
  if (!S_ISREG(status->st_mode)) {
    throw InputError(path + " is a pipe or a device; name an ordinary file");
  }
  return file;
}

/// Returns the file that writing to `path` reaches: follows links, even to a missing file.
std::filesystem::path followed(std::filesystem::path path) {
  constexpr int kMostLinks = 40;  // as many as Linux follows
  std::error_code ignored;
  for (int i = 0; i < kMostLinks && std::filesystem::is_symlink(path, ignored); ++i) {
    path = path.parent_path() / std::filesystem::read_symlink(path, ignored);
  }
  return path;
}

/// Renaming over a protected file succeeds, so this checks its mode. Root may write anywhere, so a
/// file whose mode allows nobody to write also counts as protected for root.
void check_protection(const std::string& path) {
  constexpr mode_t kAnybody = S_IWUSR | S_IWGRP | S_IWOTH;
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return;
  if ((status.st_mode & kAnybody) != 0 && ::access(path.c_str(), W_OK) == 0) return;
  throw InputError(fmt::format(
      "{} is protected (mode {:03o}) and would be replaced; make it writable or name another file",
      path, status.st_mode & 0777U));
}

/// Whether `path` is written through a temporary file beside `target`: a link stays a link, a
/// device stays a device.
bool temporary_serves(const std::string& path, std::string& target) {
  std::error_code ignored;
  const auto kind = std::filesystem::status(path, ignored).type();
  if (kind == std::filesystem::file_type::directory) {
    throw InputError(path + " is a folder; name a file to write");
  }
  const bool regular = kind == std::filesystem::file_type::regular;
  if (regular) check_protection(path);
  target = followed(path).string();
  return regular || kind == std::filesystem::file_type::not_found ||
         kind == std::filesystem::file_type::none;
}

/// An existing file, or the folder and the name of a file that would be created.
struct Identity {
  dev_t device = 0;
  ino_t number = 0;
  std::string name;  // name in the folder; empty for an existing file
  bool operator==(const Identity&) const = default;
};

/// Nothing unless the file is ordinary or could be created in an existing folder.
std::optional<Identity> identity_of(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) == 0) {
    if (!S_ISREG(status.st_mode)) return {};
    return Identity{status.st_dev, status.st_ino, ""};
  }
  const std::filesystem::path target = followed(path);
  const std::filesystem::path folder = target.has_parent_path() ? target.parent_path() : ".";
  if (::stat(folder.c_str(), &status) != 0) return {};
  return Identity{status.st_dev, status.st_ino, target.filename().string()};
}

/// Returns 0 or the error; the temporary file exists in both cases.
int fill_and_sync(Descriptor& file, std::string_view bytes) {
  if (const int error = write_all(file.get(), bytes); error != 0) return error;
  if (::fsync(file.get()) != 0) return errno;
  return file.close();
}

}  // namespace

void check_readable(const std::string& path) {
  if (path == "-") return;
  struct stat status {};
  open_to_read(path, &status);
}

std::string read_head(const std::string& path) {
  struct stat status {};
  const Descriptor file = open_to_read(path, &status);
  std::string bytes(64, '\0');
  const ssize_t n = ::read(file.get(), bytes.data(), bytes.size());
  if (n < 0) throw InputError(fmt::format("{} cannot be read ({})", path, reason(errno)));
  bytes.resize(static_cast<std::size_t>(n));
  return bytes;
}

std::string read_file(const std::string& path, std::size_t limit, Empty empty) {
  struct stat status {};
  const Descriptor file =
      path == "-" ? Descriptor(::dup(STDIN_FILENO)) : open_to_read(path, &status);
  const auto too_large = [&] {
    return InputError(fmt::format("{} is larger than the {} MB that a file of its kind may have",
                                  path, limit >> 20));
  };
  if (static_cast<std::size_t>(status.st_size) > limit) throw too_large();

  // the size is only a hint: files grow, and the kernel's files report size 0
  std::string bytes;
  bytes.reserve(static_cast<std::size_t>(std::max<off_t>(status.st_size, 0)));
  std::array<char, 65536> buffer{};
  for (;;) {
    const ssize_t n = ::read(file.get(), buffer.data(), buffer.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw InputError(fmt::format("{} cannot be read ({})", path, reason(errno)));
    if (n == 0) break;
    bytes.append(buffer.data(), static_cast<std::size_t>(n));
    if (bytes.size() > limit) throw too_large();
  }
  if (bytes.empty() && empty == Empty::Refused) {
    throw InputError((path == "-" ? "standard input" : path) + " is empty; it must hold data");
  }
  return bytes;
}

void check_writable(const std::string& path) {
  std::string target, temporary;
  if (path == "-" || !temporary_serves(path, target)) return;
  const Descriptor file(open_temporary(target, temporary));
  if (file.get() < 0) fail_to_write(path, errno);
  ::unlink(temporary.c_str());
}

bool is_same_file(const std::string& a, const std::string& b) {
  if (a == "-" || b == "-") return a == b;
  const std::optional<Identity> first = identity_of(a);
  return first && first == identity_of(b);
}

void write_file(const std::string& path, std::string_view bytes) {
  if (path == "-") {
    std::fflush(stdout);
    if (const int error = write_all(STDOUT_FILENO, bytes); error != 0) {
      throw InputError("standard output cannot be written (" + reason(error) + ")");
    }
    return;
  }

  std::string target;
  if (!temporary_serves(path, target)) {
    write_in_place(path, bytes);
    return;
  }
  // the new content appears completely or not at all
  std::string temporary;
  Descriptor file(open_temporary(target, temporary));
  if (file.get() < 0) fail_to_write(path, errno);
  int error = fill_and_sync(file, bytes);
  if (error == 0 && std::rename(temporary.c_str(), target.c_str()) != 0) error = errno;
  if (error != 0) {
    ::unlink(temporary.c_str());
    fail_to_write(path, error);
  }
}

}  // namespace prostm
