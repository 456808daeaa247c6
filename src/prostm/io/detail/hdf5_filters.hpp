#pragma once
/// Compressions of datasets that libhdf5 does not bring along. Private to io.

#include <hdf5.h>

#include <string>

namespace prostm::h5 {

/// Lets HDF5 read datasets that h5py compressed with LZF, in this process; does nothing where a
/// filter for LZF is registered already.
void register_lzf();

/// The first dataset of a file that is compressed with a filter that is not available, as "/a/b is
/// compressed with blosc"; empty if every filter is available.
std::string missing_filter(hid_t file);

}  // namespace prostm::h5
