#pragma once
/// Dataset compressions that libhdf5 does not include. Private to io.

#include <hdf5.h>

#include <string>

namespace prostm::h5 {

/// Enables this process to read datasets compressed by h5py with LZF; does nothing if an LZF filter
/// is already registered.
void register_lzf();

/// Describes the first dataset of a file that needs an unavailable filter: "/a/b is compressed with
/// blosc"; empty if all filters are available.
std::string missing_filter(hid_t file);

}  // namespace prostm::h5
