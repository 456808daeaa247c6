#pragma once
/// Whole files: read with a size limit, written completely or not at all.

#include <cstddef>
#include <string>
#include <string_view>

namespace prostm {

/// Whether an empty file may be read.
enum class Empty { Refused, Allowed };

/// Returns the bytes of a file; "-" is standard input, to its end. Otherwise never blocks: pipes
/// and devices are refused. @throws InputError: the file does not exist, cannot be read, is not an
/// ordinary file, is empty (unless allowed), or exceeds `limit` bytes.
std::string read_file(const std::string& path, std::size_t limit = std::size_t{1} << 30,
                      Empty empty = Empty::Refused);

/// Returns the first bytes of a file, enough to recognise its kind. @throws as check_readable().
std::string read_head(const std::string& path);

/// @throws InputError: the file does not exist, cannot be read, or is neither an ordinary file nor
/// "-".
void check_readable(const std::string& path);

/// Checks early that write_file() could write there. @throws InputError: `path` is a folder or a
/// protected file, or its folder is missing or not writable.
void check_writable(const std::string& path);

/// Writes to a temporary file beside `path`, flushes, renames. "-" writes to standard output; links
/// are followed. @throws InputError: the folder is missing or not writable, the disk is full, or
/// the file is protected: its mode does not allow this user to write, or allows nobody (which also
/// stops root). Nothing is left behind then.
void write_file(const std::string& path, std::string_view bytes);

/// Whether two names refer to the same ordinary file: an existing one, through any of its names and
/// links, or one that both would create. False for devices, pipes and missing folders.
bool is_same_file(const std::string& a, const std::string& b);

}  // namespace prostm
