#pragma once
/// RAII wrappers of the few HDF5 calls needed by recordings, without printed errors. Private to io.
///
/// Debian's build of HDF5 is not thread-safe: only one thread at a time may use recorders and
/// readers.

#include <hdf5.h>

#include <cstddef>
#include <string>
#include <vector>

#include "prostm/core/file/advisory_lock.hpp"

namespace prostm::h5 {

/// Keeps HDF5 from printing errors during its lifetime.
class Quiet {
 public:
  Quiet();
  ~Quiet();
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

 private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

/// An identifier that is closed with its owner.
class Id {
 public:
  using Close = herr_t (*)(hid_t);
  Id() = default;
  Id(hid_t id, Close closer) : id_(id), close_(closer) {}
  ~Id() { close(); }
  Id(Id&& other) noexcept;
  Id& operator=(Id&& other) noexcept;

  bool valid() const { return id_ >= 0; }
  hid_t get() const { return id_; }
  bool close();  ///< false on failure of the library

 private:
  hid_t id_ = H5I_INVALID_HID;
  Close close_ = nullptr;
};

/// Opens a file for reading, even if this process has it open elsewhere; invalid on failure. @param
/// lock lock the file as HDF5 does by default, which fails on file systems without locks.
Id open_to_read(const std::string& path, bool lock = true);
/// Tries the lock that HDF5 uses for reading: Held while another program writes the file.
LockResult probe_lock(const std::string& path);

/// The description of a dataset's rows.
struct Column {
  const char* name;
  hid_t type;                  ///< native type of a number, also used in the file
  std::vector<hsize_t> shape;  ///< shape of one row; empty for a single number
  const char* unit;
  std::string meaning;
};

/// A dataset that grows by rows: chunked, shuffled and deflated.
class Table {
 public:
  /// Creates the dataset with the attributes "unit" and "meaning"; invalid on failure.
  Table(hid_t group, const Column& column);
  bool valid() const { return dataset_.valid(); }
  /// Appends `rows` rows; false on failure. @pre data holds all of them.
  bool append(const void* data, hsize_t rows);
  bool close() { return dataset_.close(); }

 private:
  Id dataset_;
  hid_t type_;
  std::vector<hsize_t> size_;
};

/// Writes a text attribute of any length, replacing one of the same name; false on failure.
bool write_text(hid_t object, const char* name, const std::string& value);
/// Reads a text attribute, of variable or fixed length, scalar or an array of one; empty if absent
/// or not a text.
std::string read_text(hid_t object, const char* name);

/// Reads rows [first, first + count) of a dataset whose rows have `shape`, as native `type`; false
/// if it is missing, has another shape, is shorter, or cannot be read. @pre out has room for all of
/// them.
bool read_rows(hid_t file, const char* path, hid_t type, const std::vector<hsize_t>& shape,
               hsize_t first, hsize_t count, void* out);
/// Number of rows of a dataset; -1 if it is missing.
long long row_count(hid_t file, const char* path);

}  // namespace prostm::h5
