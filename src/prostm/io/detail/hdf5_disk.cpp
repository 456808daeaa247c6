#include "prostm/io/detail/hdf5_disk.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <string>

#include "prostm/core/file/advisory_lock.hpp"

namespace prostm::h5 {
namespace {

constexpr haddr_t kMaxAddress = static_cast<haddr_t>(std::numeric_limits<off_t>::max());
constexpr std::size_t kPageBytes = 16384;
constexpr std::size_t kStructureBytes = 1 << 19;  // bytes of a file's structure kept in memory

/// Driver information, passed with the access properties.
struct Report {
  int* error;
};

struct Disk {
  H5FD_t base{};  // must be the first member, since HDF5 uses it as the file
  int fd = -1;
  std::string path;
  int* error = nullptr;
  haddr_t end_of_allocation = 0, end_of_file = 0;
  haddr_t on_disk = 0;                                    // size of the file on disk
  std::map<haddr_t, std::array<char, kPageBytes>> pages;  // written since the last flush

  ~Disk() { ::close(fd); }
};

Disk& disk_of(H5FD_t* file) {
  return *reinterpret_cast<Disk*>(file);
}
const Disk& disk_of(const H5FD_t* file) {
  return *reinterpret_cast<const Disk*>(file);
}

/// Reads from disk, with zeros beyond the end. Returns false on failure.
bool load(int fd, haddr_t at, char* out, std::size_t size) {
  while (size > 0) {
    const ssize_t n = ::pread(fd, out, size, static_cast<off_t>(at));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return false;
    if (n == 0) break;
    out += n;
    at += static_cast<haddr_t>(n);
    size -= static_cast<std::size_t>(n);
  }
  std::memset(out, 0, size);
  return true;
}

/// Writes to disk. Returns 0 or the error.
int store(int fd, haddr_t at, const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t n = ::pwrite(fd, data, size, static_cast<off_t>(at));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return n < 0 ? errno : ENOSPC;
    data += n;
    at += static_cast<haddr_t>(n);
    size -= static_cast<std::size_t>(n);
  }
  return 0;
}

/// Writes the pages to disk: all, or none if it is full. Returns 0 or the error.
int commit(Disk& disk) {
  const haddr_t end = disk.end_of_allocation;
  if (end > disk.on_disk) {
    const auto from = static_cast<off_t>(disk.on_disk);
    int error = EINTR;
    while (error == EINTR) error = ::posix_fallocate(disk.fd, from, static_cast<off_t>(end) - from);
    if (error != 0) return error;
  }
  for (const auto& [at, page] : disk.pages) {
    if (at >= end) break;
    const std::size_t size = std::min<haddr_t>(kPageBytes, end - at);
    if (const int error = store(disk.fd, at, page.data(), size)) return error;
  }
  if (end < disk.on_disk && ::ftruncate(disk.fd, static_cast<off_t>(end)) != 0) return errno;
  disk.on_disk = end;
  disk.pages.clear();
  return 0;
}

/// Calls part(start of the page, offset in it, bytes done before, bytes) for each page that
/// overlaps [at, at + size).
template <class Part>
bool for_pages(haddr_t at, std::size_t size, Part&& part) {
  std::size_t done = 0;
  while (done < size) {
    const haddr_t offset = (at + done) % kPageBytes;
    const std::size_t bytes = std::min<std::size_t>(kPageBytes - offset, size - done);
    if (!part(at + done - offset, offset, done, bytes)) return false;
    done += bytes;
  }
  return true;
}

H5FD_t* open_disk(const char* name, unsigned flags, hid_t access, haddr_t) {
  const auto* report = static_cast<const Report*>(H5Pget_driver_info(access));
  // HDF5 first checks whether the file exists, then requests an empty one
  if (report == nullptr || (flags & H5F_ACC_TRUNC) == 0) return nullptr;
  auto disk = std::make_unique<Disk>();
  disk->fd = ::open(name, O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (disk->fd < 0) return nullptr;
  disk->path = name;
  disk->error = report->error;
  return &disk.release()->base;
}

herr_t flush(H5FD_t* file, hid_t, hbool_t) {
  Disk& disk = disk_of(file);
  if (*disk.error == 0) *disk.error = commit(disk);
  return 0;
}

herr_t close_disk(H5FD_t* file) {
  const std::unique_ptr<Disk> disk(&disk_of(file));
  return flush(file, H5P_DEFAULT, true);
}

herr_t query(const H5FD_t*, unsigned long* features) {
  *features = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
              H5FD_FEAT_AGGREGATE_SMALLDATA | H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
  return 0;
}

haddr_t end_of_allocation(const H5FD_t* file, H5FD_mem_t) {
  return disk_of(file).end_of_allocation;
}
herr_t set_end_of_allocation(H5FD_t* file, H5FD_mem_t, haddr_t end) {
  disk_of(file).end_of_allocation = end;
  return 0;
}
haddr_t end_of_file(const H5FD_t* file, H5FD_mem_t) {
  return disk_of(file).end_of_file;
}
/// Required by HDF5: ends the file at the end of the allocated space.
herr_t truncate(H5FD_t* file, hid_t, hbool_t) {
  disk_of(file).end_of_file = disk_of(file).end_of_allocation;
  return 0;
}

herr_t read_disk(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t at, std::size_t size, void* out) {
  const Disk& disk = disk_of(file);
  auto* bytes = static_cast<char*>(out);
  const bool ok =
      for_pages(at, size, [&](haddr_t start, haddr_t offset, std::size_t done, std::size_t count) {
        const auto page = disk.pages.find(start);
        if (page == disk.pages.end()) return load(disk.fd, start + offset, bytes + done, count);
        std::memcpy(bytes + done, page->second.data() + offset, count);
        return true;
      });
  return ok ? 0 : -1;
}

herr_t write_disk(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t at, std::size_t size, const void* data) {
  Disk& disk = disk_of(file);
  const auto* bytes = static_cast<const char*>(data);
  disk.end_of_file = std::max<haddr_t>(disk.end_of_file, at + size);
  const bool ok =
      for_pages(at, size, [&](haddr_t start, haddr_t offset, std::size_t done, std::size_t count) {
        const auto [page, is_new] = disk.pages.try_emplace(start);
        if (is_new && !load(disk.fd, start, page->second.data(), kPageBytes)) return false;
        std::memcpy(page->second.data() + offset, bytes + done, count);
        return true;
      });
  return ok ? 0 : -1;
}

/// A file system without locks is not an error.
herr_t lock(H5FD_t* file, hbool_t exclusive) {
  const Disk& disk = disk_of(file);
  const LockKind kind = exclusive ? LockKind::Exclusive : LockKind::Shared;
  return try_lock(disk.fd, kind, disk.path) == LockResult::Held ? -1 : 0;
}
/// Closing the file unlocks it.
herr_t unlock(H5FD_t*) {
  return 0;
}

H5FD_class_t driver() {
  H5FD_class_t c{};
  c.name = "prostm";
  c.maxaddr = kMaxAddress;
  c.fc_degree = H5F_CLOSE_WEAK;
  c.fapl_size = sizeof(Report);
  c.open = open_disk;
  c.close = close_disk;
  c.query = query;
  c.get_eoa = end_of_allocation;
  c.set_eoa = set_end_of_allocation;
  c.get_eof = end_of_file;
  c.read = read_disk;
  c.write = write_disk;
  c.flush = flush;
  c.truncate = truncate;
  c.lock = lock;
  c.unlock = unlock;
  constexpr H5FD_mem_t kPools[] = H5FD_FLMAP_DICHOTOMY;  // separate pools for numbers and structure
  std::copy(std::begin(kPools), std::end(kPools), c.fl_map);
  return c;
}

/// Stays registered, like HDF5's own drivers: closing a file uses the driver after releasing it.
hid_t registered_driver() {
  static const hid_t id = [] {
    const H5FD_class_t disk = driver();
    return H5FDregister(&disk);
  }();
  return id;
}

/// Fixes the size of HDF5's cache of a file's structure, which otherwise grows with the file.
void bound_cache(hid_t access) {
  H5AC_cache_config_t cache{};
  cache.version = H5AC__CURR_CACHE_CONFIG_VERSION;
  H5Pget_mdc_config(access, &cache);
  cache.set_initial_size = true;
  cache.initial_size = cache.min_size = cache.max_size = kStructureBytes;
  cache.incr_mode = H5C_incr__off;
  cache.flash_incr_mode = H5C_flash_incr__off;
  cache.decr_mode = H5C_decr__off;
  H5Pset_mdc_config(access, &cache);
}

}  // namespace

Id create_file(const std::string& path, int& error) {
  error = 0;
  const Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  const Report report{&error};
  H5Pset_libver_bounds(access.get(), H5F_LIBVER_EARLIEST, H5F_LIBVER_V18);
  H5Pset_fclose_degree(access.get(), H5F_CLOSE_STRONG);
  bound_cache(access.get());
  if (H5Pset_driver(access.get(), registered_driver(), &report) < 0) return {};
  return {H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.get()), H5Fclose};
}

}  // namespace prostm::h5
