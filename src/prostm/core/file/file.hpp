#pragma once
/// Whole files: read with a size limit, written completely or not at all.

#include <cstddef>
#include <string>
#include <string_view>

namespace prostm {

/// Whether a file without a byte may be read.
enum class Empty { Refused, Allowed };

/// Returns the bytes of a file; "-" is standard input, to its end. Never waits elsewhere: pipes and
/// devices are refused. @throws InputError: it does not exist, cannot be read, is not an ordinary
/// file, is empty unless that is allowed, exceeds `limit` bytes.
std::string read_file(const std::string& path, std::size_t limit = std::size_t{1} << 30,
                      Empty empty = Empty::Refused);

/// Returns the first bytes of a file, as many as tell what kind it is. @throws as check_readable().
std::string read_head(const std::string& path);

/// @throws InputError: it does not exist, cannot be read, is neither an ordinary file nor "-".
void check_readable(const std::string& path);

/// Checks that write_file could write there, before the work begins.
/// @throws InputError: it is a folder or a protected file, or its folder is missing or not
/// writable.
void check_writable(const std::string& path);

/// Writes to a temporary file beside `path`, flushes, renames. "-" writes to standard output; links
/// are followed. @throws InputError: the folder is missing or not writable, the disk is full, or
/// the file is protected: its mode does not let this user write, or lets nobody write (which stops
/// root too). Then nothing is left behind.
void write_file(const std::string& path, std::string_view bytes);

/// Whether two names lead to the same ordinary file: an existing one, through any of its names and
/// links, or one that both would create. False for devices, pipes and missing folders.
bool is_same_file(const std::string& a, const std::string& b);

}  // namespace prostm
