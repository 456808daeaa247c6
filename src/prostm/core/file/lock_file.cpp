#include "prostm/core/file/lock_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <boost/crc.hpp>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>

#include "prostm/core/input_error.hpp"

namespace prostm {
namespace {

/// Identifies a process uniquely, for other processes of the same machine and other machines.
struct Owner {
  std::string host;
  std::string machine;  // checksum of the machine's id, which must stay secret
  std::string boot;     // changes with every start of the machine
  std::string pids;     // the namespace that counts `pid`: a container has its own
  long long pid = 0;
  std::string started;  // start in clock ticks since boot, since process numbers are reused
};

/// The beginning of a small system file; empty if it cannot be read.
std::string text_of(const std::string& path) {
  constexpr std::size_t kMost = 4096;
  std::ifstream file(path, std::ios::binary);
  std::string text(kMost, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

std::string host_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : std::string();
}

std::string machine_checksum() {
  const std::string id = text_of("/etc/machine-id");
  if (id.empty()) return {};
  boost::crc_32_type sum;
  sum.process_bytes(id.data(), id.size());
  return fmt::format("{:08x}", sum.checksum());
}

std::string pid_namespace() {
  std::error_code ignored;
  return std::filesystem::read_symlink("/proc/self/ns/pid", ignored).string();
}

/// When a process started: field 22 of its stat (proc(5)). Empty for a process that does not exist
/// or is a zombie.
std::string start_of(long long pid) {
  const std::string stat = text_of(fmt::format("/proc/{}/stat", pid));
  std::size_t at = stat.rfind(')');  // the second field is a name, which may contain anything
  if (at == stat.npos || stat.compare(at, 3, ") Z") == 0) return {};
  for (int field = 2; field < 22 && at != stat.npos; ++field) at = stat.find(' ', at + 1);
  if (at == stat.npos) return {};
  return stat.substr(at + 1, stat.find(' ', at + 1) - at - 1);
}

Owner this_process() {
  const long long pid = ::getpid();
  return {
      host_name(), machine_checksum(), text_of("/proc/sys/kernel/random/boot_id"), pid_namespace(),
      pid,         start_of(pid)};
}

std::string text_of_owner(const Owner& owner) {
  const nlohmann::ordered_json json = {{"host", owner.host}, {"machine", owner.machine},
                                       {"boot", owner.boot}, {"pids", owner.pids},
                                       {"pid", owner.pid},   {"started", owner.started}};
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

/// Nothing if it is not a complete lock file of prostm.
std::optional<Owner> owner_from(const std::string& text) {
  const nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object()) return {};
  try {
    return Owner{json.at("host"), json.at("machine"), json.at("boot"),
                 json.at("pids"), json.at("pid"),     json.at("started")};
  } catch (const nlohmann::json::exception&) {
    return {};
  }
}

enum class State { Runs, Gone, Elsewhere };

State state_of(const Owner& owner, const Owner& here) {
  if (owner.host != here.host || owner.machine != here.machine) return State::Elsewhere;
  // without a machine id, another machine of this name cannot be distinguished from this one after
  // a restart
  if (owner.boot != here.boot) return here.machine.empty() ? State::Elsewhere : State::Gone;
  if (owner.pids != here.pids || here.started.empty()) return State::Elsewhere;
  const std::string started = start_of(owner.pid);
  return !started.empty() && started == owner.started ? State::Runs : State::Gone;
}

/// Creates the lock file. @return 0, EEXIST if it exists, or another error, in which case there is
/// no file.
int create(const std::string& path, const std::string& text) {
  const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (fd < 0) return errno;
  const std::string line = text + "\n";
  const ssize_t n = ::write(fd, line.data(), line.size());
  int error = n == static_cast<ssize_t>(line.size()) ? 0 : n < 0 ? errno : ENOSPC;
  if (error == 0 && ::fsync(fd) != 0) error = errno;
  if (::close(fd) != 0 && error == 0) error = errno;
  if (error != 0) ::unlink(path.c_str());
  return error;
}

/// Removes a lock file that holds `text`. Renames it first: if another process has replaced it
/// since it was read, that one is restored.
void remove_if(const std::string& path, const std::string& text) {
  if (text_of(path) != text) return;
  const std::string aside = fmt::format("{}.{}", path, ::getpid());
  if (std::rename(path.c_str(), aside.c_str()) != 0) return;
  if (text_of(aside) != text) std::rename(aside.c_str(), path.c_str());
  ::unlink(aside.c_str());
}

std::string words_of(const std::optional<Owner>& owner) {
  return owner ? fmt::format("process {} on {:.64}", owner->pid, owner->host) : "another program";
}

}  // namespace

LockFile::LockFile(const std::string& path, ForeignLock foreign, const std::string& override_option)
    : path_(path + ".lock") {
  const Owner here = this_process();
  text_ = text_of_owner(here);
  constexpr int kTries = 10;  // other processes may replace a stale lock file at the same time
  for (int i = 0; i < kTries; ++i) {
    const int error = create(path_, text_);
    if (error == 0) return;
    if (error != EEXIST) {
      throw InputError(
          fmt::format("{} cannot be created ({}); name a folder that exists, is "
                      "writable and has space",
                      path_, std::generic_category().message(error)));
    }
    const std::string held = text_of(path_);
    const std::optional<Owner> owner = owner_from(held);
    const State state = owner ? state_of(*owner, here) : State::Elsewhere;
    if (state == State::Runs) {
      throw InputError(fmt::format("{} is being written by another program, {}; close it first",
                                   path, words_of(owner)));
    }
    if (state == State::Elsewhere && foreign == ForeignLock::Respected) {
      throw InputError(fmt::format(
          "{} is being written by {}, or was when that crashed ({}); end it there, or give {} if "
          "it no longer runs",
          path, words_of(owner), path_, override_option));
    }
    notice_ = state == State::Gone
                  ? fmt::format("{} was left by {}, which no longer runs; it is replaced", path_,
                                words_of(owner))
                  : fmt::format("{} of {} is replaced because {} is given", path_, words_of(owner),
                                override_option);
    remove_if(path_, held);
  }
  throw InputError(path_ + " is repeatedly replaced by other programs; close them first");
}

LockFile::~LockFile() {
  remove_if(path_, text_);
}

}  // namespace prostm
