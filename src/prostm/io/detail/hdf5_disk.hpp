#pragma once
/// Files that HDF5 can always write. Private to io.

#include <hdf5.h>

#include <string>

#include "prostm/io/detail/hdf5.hpp"

namespace prostm::h5 {

/// Creates a file in the earliest format, so that every HDF5 of the last decades opens it.
///
/// The file on the disk changes only when HDF5 flushes or closes it, and only after the space has
/// been reserved: until then what HDF5 writes is kept in memory. So a full disk or a killed program
/// leaves what was flushed last. And HDF5 never learns that a write failed, since libhdf5 1.10
/// crashes where that happens while it closes a file: instead `error` becomes the first errno,
/// after which the file on the disk stays as it is. Invalid when the file cannot be opened.
/// @param error set to 0; must outlive the file.
Id create_file(const std::string& path, int& error);

}  // namespace prostm::h5
