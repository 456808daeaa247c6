#include "prostm/io/detail/hdf5.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <functional>
#include <numeric>
#include <utility>

#include "prostm/core/file/advisory_lock.hpp"

namespace prostm::h5 {
namespace {

constexpr std::size_t kChunkBytes = 32768;
constexpr hsize_t kMaxChunkRows = 8192;

Id text_type() {
  Id type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.get(), H5T_VARIABLE);
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  return type;
}

/// Reads a text of fixed length, without its padding. Some programs leave no room for the NUL of a
/// NUL-terminated type.
std::string read_fixed(hid_t attribute, hid_t stored) {
  std::string text(H5Tget_size(stored), '\0');
  if (H5Aread(attribute, stored, text.data()) < 0) return {};
  const char padding = H5Tget_strpad(stored) == H5T_STR_SPACEPAD ? ' ' : '\0';
  if (padding == '\0') text.resize(std::min(text.find('\0'), text.size()));
  text.resize(text.find_last_not_of(padding) + 1);
  return text;
}

}  // namespace

Quiet::Quiet() {
  H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}
Quiet::~Quiet() {
  H5Eset_auto2(H5E_DEFAULT, function_, data_);
}

Id::Id(Id&& other) noexcept
    : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}

Id& Id::operator=(Id&& other) noexcept {
  if (this != &other) {
    close();
    id_ = std::exchange(other.id_, H5I_INVALID_HID);
    close_ = other.close_;
  }
  return *this;
}

bool Id::close() {
  const hid_t id = std::exchange(id_, H5I_INVALID_HID);
  return id < 0 || close_(id) >= 0;
}

Id open_to_read(const std::string& path, bool lock) {
  // a file that is already open in this process can be reopened only with the same close degree
  for (const H5F_close_degree_t degree : {H5F_CLOSE_DEFAULT, H5F_CLOSE_STRONG, H5F_CLOSE_SEMI}) {
    const Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    H5Pset_fclose_degree(access.get(), degree);
    if (!lock) H5Pset_file_locking(access.get(), false, true);
    Id file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.get()), H5Fclose);
    if (file.valid()) return file;
  }
  return {};
}

LockResult probe_lock(const std::string& path) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return LockResult::Unavailable;
  const LockResult result = try_lock(fd, LockKind::Shared, path);
  ::close(fd);
  return result;
}

Table::Table(hid_t group, const Column& column) : type_(column.type), size_{0} {
  size_.insert(size_.end(), column.shape.begin(), column.shape.end());

  // chunks of about 32 kB
  const auto values =
      std::accumulate(column.shape.begin(), column.shape.end(), hsize_t{1}, std::multiplies<>());
  const std::size_t row_bytes = H5Tget_size(type_) * static_cast<std::size_t>(values);
  std::vector<hsize_t> chunk = size_, limit = size_;
  chunk[0] = std::clamp<hsize_t>(kChunkBytes / row_bytes, 1, kMaxChunkRows);
  limit[0] = H5S_UNLIMITED;
  const int rank = static_cast<int>(size_.size());
  const Id create(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_chunk(create.get(), rank, chunk.data());
  H5Pset_shuffle(create.get());
  H5Pset_deflate(create.get(), 1);

  // the cache holds one chunk, so that full chunks are compressed one by one, and not all at once
  // at a flush
  const Id access(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose);
  H5Pset_chunk_cache(access.get(), 11, static_cast<std::size_t>(chunk[0]) * row_bytes, 1.0);
  const Id space(H5Screate_simple(rank, size_.data(), limit.data()), H5Sclose);
  dataset_ = Id(
      H5Dcreate2(group, column.name, type_, space.get(), H5P_DEFAULT, create.get(), access.get()),
      H5Dclose);
  if (dataset_.valid() && !(write_text(dataset_.get(), "unit", column.unit) &&
                            write_text(dataset_.get(), "meaning", column.meaning))) {
    dataset_.close();
  }
}

bool Table::append(const void* data, hsize_t rows) {
  if (rows == 0) return true;
  std::vector<hsize_t> start(size_.size(), 0), count = size_;
  start[0] = size_[0];
  count[0] = rows;
  size_[0] += rows;
  if (H5Dset_extent(dataset_.get(), size_.data()) < 0) return false;
  const Id file_space(H5Dget_space(dataset_.get()), H5Sclose);
  const Id memory_space(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr),
                        H5Sclose);
  return H5Sselect_hyperslab(file_space.get(), H5S_SELECT_SET, start.data(), nullptr, count.data(),
                             nullptr) >= 0 &&
         H5Dwrite(dataset_.get(), type_, memory_space.get(), file_space.get(), H5P_DEFAULT, data) >=
             0;
}

bool write_text(hid_t object, const char* name, const std::string& value) {
  const htri_t exists = H5Aexists(object, name);
  if (exists < 0 || (exists > 0 && H5Adelete(object, name) < 0)) return false;
  const Id type = text_type();
  const Id space(H5Screate(H5S_SCALAR), H5Sclose);
  const Id attribute(H5Acreate2(object, name, type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
                     H5Aclose);
  const char* text = value.c_str();
  return attribute.valid() &&
         H5Awrite(attribute.get(), type.get(), static_cast<const void*>(&text)) >= 0;
}

std::string read_text(hid_t object, const char* name) {
  if (H5Aexists(object, name) <= 0) return {};
  const Id attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  if (!attribute.valid()) return {};
  const Id stored(H5Aget_type(attribute.get()), H5Tclose);
  const Id space(H5Aget_space(attribute.get()), H5Sclose);
  if (H5Tget_class(stored.get()) != H5T_STRING || H5Sget_simple_extent_npoints(space.get()) != 1)
    return {};
  if (H5Tis_variable_str(stored.get()) <= 0) return read_fixed(attribute.get(), stored.get());
  const Id type = text_type();
  H5Tset_cset(type.get(), H5Tget_cset(stored.get()));
  char* text = nullptr;
  if (H5Aread(attribute.get(), type.get(), static_cast<void*>(&text)) < 0 || text == nullptr)
    return {};
  std::string value(text);
  H5free_memory(text);
  return value;
}

bool read_rows(hid_t file, const char* path, hid_t type, const std::vector<hsize_t>& shape,
               hsize_t first, hsize_t count, void* out) {
  const Id dataset(H5Dopen2(file, path, H5P_DEFAULT), H5Dclose);
  if (!dataset.valid()) return false;
  const Id space(H5Dget_space(dataset.get()), H5Sclose);
  std::vector<hsize_t> size(shape.size() + 1);
  if (H5Sget_simple_extent_ndims(space.get()) != static_cast<int>(size.size()) ||
      H5Sget_simple_extent_dims(space.get(), size.data(), nullptr) < 0 ||
      !std::equal(shape.begin(), shape.end(), size.begin() + 1) || first > size[0] ||
      count > size[0] - first) {
    return false;
  }
  if (count == 0) return true;
  std::vector<hsize_t> start(size.size(), 0);
  start[0] = first;
  size[0] = count;
  const Id memory(H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr), H5Sclose);
  return H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), nullptr, size.data(),
                             nullptr) >= 0 &&
         H5Dread(dataset.get(), type, memory.get(), space.get(), H5P_DEFAULT, out) >= 0;
}

long long row_count(hid_t file, const char* path) {
  const Id dataset(H5Dopen2(file, path, H5P_DEFAULT), H5Dclose);
  if (!dataset.valid()) return -1;
  const Id space(H5Dget_space(dataset.get()), H5Sclose);
  std::vector<hsize_t> size(H5S_MAX_RANK);
  if (H5Sget_simple_extent_ndims(space.get()) < 1 ||
      H5Sget_simple_extent_dims(space.get(), size.data(), nullptr) < 0) {
    return -1;
  }
  return static_cast<long long>(size[0]);
}

}  // namespace prostm::h5
