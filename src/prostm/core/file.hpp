#pragma once
/// Whole files, read with a limit and written so that nothing is ever half there.

#include <cstddef>
#include <string>
#include <string_view>

namespace prostm {

/// The bytes of a file. Never waits: pipes and devices are refused. @throws InputError: it does not
/// exist, cannot be read, is not an ordinary file, is empty, exceeds `limit` bytes.
std::string read_file(const std::string& path, std::size_t limit = std::size_t{1} << 30);

/// @throws InputError: it does not exist, cannot be read, is not an ordinary file.
void check_readable(const std::string& path);

/// Tries whether write_file could write there, before the work whose result it is to hold.
/// @throws InputError: a folder, a folder that is missing or not writable, or a file that is
/// protected.
void check_writable(const std::string& path);

/// Writes to a temporary file beside `path`, flushes, renames. "-" writes to standard output, and
/// what a link points to is written, not the link. @throws InputError: the folder is missing or not
/// writable, the disk is full, or the file is protected: its mode lets nobody write (so that root,
/// who may write everywhere, is refused too), or not this user. Nothing is left behind then.
void write_file(const std::string& path, std::string_view bytes);

/// Whether reading or writing by two names would meet in one file: one that is there, by any of its
/// names and links, or one that both would make. Devices and pipes are no such file, and neither is
/// what lies in a folder that is missing.
bool is_same_file(const std::string& a, const std::string& b);

}  // namespace prostm
