#pragma once
/// The few calls of HDF5 that recordings need, closed by themselves and silent. Private to io.
///
/// HDF5 is not thread-safe as Debian builds it: one thread at a time may use recorders and readers.

#include <hdf5.h>

#include <cstddef>
#include <string>
#include <vector>

#include "prostm/core/file/advisory_lock.hpp"

namespace prostm::h5 {

/// While it lives, HDF5 does not print its errors.
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
  bool close();  ///< false when the library could not

 private:
  hid_t id_ = H5I_INVALID_HID;
  Close close_ = nullptr;
};

/// Opens a file to read it, even if this process has it open elsewhere; invalid on failure.
/// @param lock as HDF5 does by itself, which fails where the file system has no locks.
Id open_to_read(const std::string& path, bool lock = true);
/// Tries the lock that HDF5 takes to read a file: Held while anyone writes it.
LockResult probe_lock(const std::string& path);

/// The description of a dataset's rows.
struct Column {
  const char* name;
  hid_t type;                  ///< native, of a number; files hold it as it is in memory
  std::vector<hsize_t> shape;  ///< of one row; empty for a number
  const char* unit;
  std::string meaning;
};

/// A dataset that grows by rows: chunked, shuffled and deflated.
class Table {
 public:
  /// Creates the dataset with the attributes "unit" and "meaning"; invalid when that failed.
  Table(hid_t group, const Column& column);
  bool valid() const { return dataset_.valid(); }
  /// Appends `rows` rows; false when the library could not. @pre data holds them all.
  bool append(const void* data, hsize_t rows);
  bool close() { return dataset_.close(); }

 private:
  Id dataset_;
  hid_t type_;
  std::vector<hsize_t> size_;
};

/// A text of any length; replaces one of the same name. False when the library could not.
bool write_text(hid_t object, const char* name, const std::string& value);
/// The text of an attribute, of variable or fixed length, alone or in an array of one; empty when
/// absent or not a text.
std::string read_text(hid_t object, const char* name);

/// Reads rows [first, first + count) of a dataset whose rows have `shape`, as native `type`; false
/// when it is not there, has another shape, is shorter, or cannot be read. @pre out holds them all.
bool read_rows(hid_t file, const char* path, hid_t type, const std::vector<hsize_t>& shape,
               hsize_t first, hsize_t count, void* out);
/// Rows of a dataset; -1 when it is not there.
long long row_count(hid_t file, const char* path);

}  // namespace prostm::h5
