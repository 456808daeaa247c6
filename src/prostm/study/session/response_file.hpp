#pragma once
/// A participant's file: one JSON object on each line, appended and on the disk before anything
/// else happens.
///
/// Every line ends with `"check":"xxxxxxxx"`: the CRC-32 of all that stands before it in the file
/// and of the line without it. So a line that was changed, moved, doubled or left out is found. A
/// last line that was cut off, by a crash or a full disk, is put aside in a file of its own.

#include <boost/crc.hpp>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "prostm/core/file/lock_file.hpp"

namespace prostm {

inline constexpr const char* kResponseFormat = "prostm-responses/1";  ///< in the first line

using ResponseLine = nlohmann::ordered_json;

/// Reads all lines, without their checks. @param cut_off gets the bytes of a last line that is not
/// whole. @throws InputError with file and line: no JSON, a check that is missing or does not
/// match.
std::vector<ResponseLine> responses_from_text(std::string_view text, const std::string& file,
                                              std::string* cut_off = nullptr);

class ResponseFile {
 public:
  /// Begins a file, or goes on with one, and holds its lock file (core/file/lock_file.hpp). A last
  /// line that is not whole is appended to PATH.cut-off and taken away. @throws InputError: it
  /// cannot be opened or written, another program has it open, or what responses_from_text()
  /// throws; then nothing has changed.
  explicit ResponseFile(std::string path, ForeignLock foreign = ForeignLock::Respected);
  ~ResponseFile();
  ResponseFile(const ResponseFile&) = delete;
  ResponseFile& operator=(const ResponseFile&) = delete;

  const std::string& path() const { return path_; }
  const std::vector<ResponseLine>& lines() const { return lines_; }
  bool found_cut_off() const { return found_cut_off_; }
  /// A sentence about a lock file that was replaced; empty if there was none.
  const std::string& lock_notice() const { return lock_.notice(); }

  /// Writes a line, and waits until it is on the disk. @throws InputError: the disk is full, or the
  /// write failed; then the file is as before.
  void append(const ResponseLine& line);

 private:
  std::string path_;
  LockFile lock_;
  int file_ = -1;
  std::uint64_t size_ = 0;  // [bytes]
  boost::crc_32_type sum_;  // of all of it
  std::vector<ResponseLine> lines_;
  bool found_cut_off_ = false;
};

}  // namespace prostm
