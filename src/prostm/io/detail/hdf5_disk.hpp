#pragma once
/// An HDF5 file driver that tolerates write errors. Private to io.

#include <hdf5.h>

#include <string>

#include "prostm/io/detail/hdf5.hpp"

namespace prostm::h5 {

/// Creates a file in the earliest format, readable by all HDF5 versions of the last decades.
///
/// The file on disk changes only when HDF5 flushes or closes it, and only after the space has been
/// reserved; until then, writes are kept in memory. So after a full disk or a killed program, the
/// file has the state of the last flush. Write errors are not reported to HDF5, since libhdf5 1.10
/// crashes on errors while closing a file: instead `error` is set to the first errno, and the file
/// on disk does not change any more. Invalid if the file cannot be opened.
/// @param error set to 0; must outlive the file.
Id create_file(const std::string& path, int& error);

}  // namespace prostm::h5
