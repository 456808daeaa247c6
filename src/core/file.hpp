#pragma once
/// Whole files, read with a limit and written so that nothing is ever half there.

#include <cstddef>
#include <string>
#include <string_view>

namespace prostm {

/// The bytes of a file. @throws InputError: it does not exist, cannot be read, is a folder, is
/// empty, exceeds `limit` bytes.
std::string read_file(const std::string& path, std::size_t limit = std::size_t{1} << 30);

/// @throws InputError: it does not exist, cannot be read, is a folder.
void check_readable(const std::string& path);

/// Tries whether write_file could write there, before the work whose result it is to hold.
/// @throws InputError: a folder, or one that is missing or not writable.
void check_writable(const std::string& path);

/// Writes to a temporary file beside `path`, flushes, renames. "-" writes to standard output.
/// @throws InputError: the folder is missing or not writable, the disk is full. Nothing is left
/// behind then.
void write_file(const std::string& path, std::string_view bytes);

}  // namespace prostm
