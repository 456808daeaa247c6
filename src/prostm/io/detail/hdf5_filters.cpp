#include "prostm/io/detail/hdf5_filters.hpp"

#include <fmt/format.h>
#include <lzf.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <utility>

#include "prostm/io/detail/hdf5.hpp"

namespace prostm::h5 {
namespace {

constexpr H5Z_filter_t kLzf = 32000;                      // registered by h5py with The HDF Group
constexpr std::size_t kMostBytes = std::size_t{1} << 30;  // largest size of a chunk

/// Decompresses a chunk. The third of the filter's values is a hint for the chunk's size. @return
/// the size in bytes; 0 on failure, which leaves the buffer unchanged.
std::size_t decompress_lzf(unsigned flags, std::size_t count, const unsigned* values,
                           std::size_t bytes, std::size_t* buffer_bytes, void** buffer) {
  if ((flags & H5Z_FLAG_REVERSE) == 0) return 0;
  std::size_t room = std::max<std::size_t>({count > 2 ? values[2] : 0, bytes, 1});
  for (; room <= kMostBytes; room *= 2) {
    void* out = std::malloc(room);
    if (out == nullptr) return 0;
    const unsigned done =
        lzf_decompress(*buffer, static_cast<unsigned>(bytes), out, static_cast<unsigned>(room));
    const bool too_small = done == 0 && errno == E2BIG;
    if (done != 0) {
      std::free(*buffer);
      *buffer = out;
      *buffer_bytes = room;
      return done;
    }
    std::free(out);
    if (!too_small) return 0;
  }
  return 0;
}

/// The name of an unavailable filter; the name stored in the dataset is often empty.
std::string name_of_filter(H5Z_filter_t id, const std::string& said) {
  constexpr std::array<std::pair<H5Z_filter_t, const char*>, 8> kKnown = {
      {{H5Z_FILTER_SZIP, "szip"},
       {32001, "blosc"},
       {32004, "LZ4"},
       {32008, "bitshuffle"},
       {32013, "ZFP"},
       {32015, "Zstandard"},
       {32026, "blosc2"},
       {307, "bzip2"}}};
  const auto* const at =
      std::find_if(kKnown.begin(), kKnown.end(), [&](const auto& k) { return k.first == id; });
  if (at != kKnown.end()) return at->second;
  return said.empty() ? "filter " + std::to_string(id) : said;
}

/// Callback of H5Ovisit: stops at a dataset with an unavailable filter.
herr_t look_at(hid_t file, const char* name, const H5O_info_t* info, void* out) {
  if (info->type != H5O_TYPE_DATASET) return 0;
  const Id dataset(H5Dopen2(file, name, H5P_DEFAULT), H5Dclose);
  if (!dataset.valid()) return 0;
  const Id create(H5Dget_create_plist(dataset.get()), H5Pclose);
  const int filters = H5Pget_nfilters(create.get());
  for (int i = 0; i < filters; ++i) {
    std::array<char, 64> said{};
    unsigned flags = 0, config = 0;
    std::size_t values = 0;
    const H5Z_filter_t id = H5Pget_filter2(create.get(), static_cast<unsigned>(i), &flags, &values,
                                           nullptr, said.size() - 1, said.data(), &config);
    if (id < 0 || H5Zfilter_avail(id) > 0) continue;
    *static_cast<std::string*>(out) =
        fmt::format("/{} is compressed with {}", name, name_of_filter(id, said.data()));
    return 1;
  }
  return 0;
}

}  // namespace

void register_lzf() {
  if (H5Zfilter_avail(kLzf) > 0) return;
  const H5Z_class2_t filter = {H5Z_CLASS_T_VERS, kLzf,          0, 1, "lzf", nullptr,
                               nullptr,          decompress_lzf};
  H5Zregister(&filter);
}

std::string missing_filter(hid_t file) {
  std::string found;
  H5Ovisit(file, H5_INDEX_NAME, H5_ITER_NATIVE, look_at, &found);
  return found;
}

}  // namespace prostm::h5
