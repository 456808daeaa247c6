#pragma once
/// A participant's file: one JSON object per line, appended and synced to disk before the session
/// continues.
///
/// Every line ends with `"check":"xxxxxxxx"`: the CRC-32 of the file up to that point, including
/// the rest of the line. It detects lines that were changed, moved, duplicated or left out. An
/// incomplete last line, after a crash or on a full disk, is moved to a separate file.

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

/// Reads all lines and removes their checks. @param cut_off receives the bytes of an incomplete
/// last line. @throws InputError with file and line: invalid JSON, a check that is missing or does
/// not match.
std::vector<ResponseLine> responses_from_text(std::string_view text, const std::string& file,
                                              std::string* cut_off = nullptr);

class ResponseFile {
 public:
  /// Creates or continues a file, and holds its lock file (core/file/lock_file.hpp). An incomplete
  /// last line is removed and appended to PATH.cut-off. @throws InputError: the file cannot be
  /// opened or written, another program has it open, or as responses_from_text(); nothing has
  /// changed then.
  explicit ResponseFile(std::string path, ForeignLock foreign = ForeignLock::Respected);
  ~ResponseFile();
  ResponseFile(const ResponseFile&) = delete;
  ResponseFile& operator=(const ResponseFile&) = delete;

  const std::string& path() const { return path_; }
  const std::vector<ResponseLine>& lines() const { return lines_; }
  bool found_cut_off() const { return found_cut_off_; }
  /// A sentence about a lock file that was replaced; empty if there was none.
  const std::string& lock_notice() const { return lock_.notice(); }

  /// Writes a line and waits until it is on disk. @throws InputError: the disk is full, or the
  /// write failed; the file is then unchanged.
  void append(const ResponseLine& line);

 private:
  std::string path_;
  LockFile lock_;
  int file_ = -1;
  std::uint64_t size_ = 0;  // [bytes]
  boost::crc_32_type sum_;  // of the whole file
  std::vector<ResponseLine> lines_;
  bool found_cut_off_ = false;
};

}  // namespace prostm
