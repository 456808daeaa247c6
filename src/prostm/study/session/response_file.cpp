#include "prostm/study/session/response_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "prostm/core/file/advisory_lock.hpp"
#include "prostm/core/file/file.hpp"
#include "prostm/core/input_error.hpp"

namespace prostm {
namespace {

constexpr std::string_view kCheck = ",\"check\":\"";
constexpr std::size_t kTail = kCheck.size() + 8 + 2;  // eight digits, a quote and a brace

void add(boost::crc_32_type& sum, std::string_view text) {
  sum.process_bytes(text.data(), text.size());
}

/// The check of a line that follows the text in `before`. @param body the line without its closing
/// brace.
std::string check_of(boost::crc_32_type before, std::string_view body) {
  add(before, body);
  return fmt::format("{:08x}", before.checksum());
}

ResponseLine parse_line(std::string_view line, const boost::crc_32_type& before,
                        const std::string& where) {
  const auto fail = [&](const char* problem) { throw InputError(where + problem); };
  ResponseLine json = ResponseLine::parse(line, nullptr, false);
  if (!json.is_object()) fail(" is not a JSON object; the file was edited or damaged");
  if (line.size() <= kTail || line.substr(line.size() - kTail, kCheck.size()) != kCheck)
    fail(" does not end with its check; the file was edited or damaged");
  const std::string_view body = line.substr(0, line.size() - kTail);
  if (line.substr(body.size() + kCheck.size(), 8) != check_of(before, body)) {
    fail(
        " does not match its check, so it or a line before it was edited, moved or left out; put "
        "the file back as it was; to correct answers, correct a table that prostm study analyse "
        "--tidy writes");
  }
  json.erase("check");
  return json;
}

/// Reads the complete lines of `text`. @return their size in bytes.
std::size_t read_lines(std::string_view text, const std::string& file,
                       std::vector<ResponseLine>& lines, boost::crc_32_type& sum) {
  std::size_t at = 0;
  for (std::size_t end = 0; (end = text.find('\n', at)) != std::string_view::npos; at = end + 1) {
    const std::string where = fmt::format("{}, line {}", file, lines.size() + 1);
    lines.push_back(parse_line(text.substr(at, end - at), sum, where));
    add(sum, text.substr(at, end + 1 - at));
  }
  return at;
}

[[noreturn]] void fail(const std::string& path, const char* what) {
  throw InputError(fmt::format("{} {}: {}", path, what, std::strerror(errno)));
}

void write_all(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(file, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw InputError(std::strerror(errno));
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
  if (::fsync(file) != 0) throw InputError(std::strerror(errno));
}

/// Syncs the folder, so that the name of a new file is on disk, too.
void sync_folder_of(const std::string& path) {
  const std::filesystem::path parent = std::filesystem::path(path).parent_path();
  const int folder =
      ::open(parent.empty() ? "." : parent.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;
  ::fsync(folder);
  ::close(folder);
}

void keep_cut_off(const std::string& path, std::string_view bytes) {
  const std::string aside = path + ".cut-off";
  const int file = ::open(aside.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (file < 0) fail(aside, "cannot be written");
  try {
    write_all(file, std::string(bytes) + "\n");
  } catch (const InputError&) {
    ::close(file);
    fail(aside, "cannot be written");
  }
  ::close(file);
}

}  // namespace

std::vector<ResponseLine> responses_from_text(std::string_view text, const std::string& file,
                                              std::string* cut_off) {
  std::vector<ResponseLine> lines;
  boost::crc_32_type sum;
  const std::size_t whole = read_lines(text, file, lines, sum);
  if (cut_off != nullptr) *cut_off = text.substr(whole);
  return lines;
}

ResponseFile::ResponseFile(std::string path, ForeignLock foreign)
    : path_(std::move(path)), lock_(path_, foreign, "--take-over") {
  file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (file_ < 0) fail(path_, "cannot be opened to write answers");
  try {
    // in addition to the lock file, for older versions of prostm and other programs that ignore it
    if (try_lock(file_, LockKind::Exclusive, path_) == LockResult::Held) {
      throw InputError(path_ +
                       " is being written by another program; close it, or give the participant "
                       "another number");
    }
    const std::string text = read_file(path_, std::size_t{1} << 30, Empty::Allowed);
    size_ = read_lines(text, path_, lines_, sum_);
    found_cut_off_ = size_ < text.size();
    if (found_cut_off_) {
      keep_cut_off(path_, std::string_view(text).substr(size_));
      if (::ftruncate(file_, static_cast<off_t>(size_)) != 0) fail(path_, "cannot be written");
    }
    sync_folder_of(path_);
  } catch (...) {
    ::close(file_);
    throw;
  }
}

ResponseFile::~ResponseFile() {
  ::close(file_);
}

void ResponseFile::append(const ResponseLine& line) {
  std::string text = line.dump(-1, ' ', false, ResponseLine::error_handler_t::replace);
  text.pop_back();  // the closing brace
  text += std::string(kCheck) + check_of(sum_, text) + "\"}\n";
  try {
    write_all(file_, text);
  } catch (const InputError& error) {
    // removes a partly written line; otherwise the next start would move it aside
    static_cast<void>(::ftruncate(file_, static_cast<off_t>(size_)));
    throw InputError(fmt::format("{} could not be written: {}", path_, error.what()));
  }
  size_ += text.size();
  add(sum_, text);
  lines_.push_back(line);
}

}  // namespace prostm
