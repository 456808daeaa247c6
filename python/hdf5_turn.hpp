#pragma once
/// Keeps every other Python thread out of HDF5.

#include "bindings.hpp"

namespace prostm::python {

/// While this object exists, no other thread uses HDF5, which is not thread-safe. The interpreter's
/// lock keeps out the threads of this module. h5py may use the same library and releases that lock
/// while it reads, so its own lock is held too once it is imported.
/// @pre the interpreter's lock is held, and stays held.
class Hdf5Turn {
 public:
  Hdf5Turn() {
    const py::object h5py = py::module_::import("sys").attr("modules").attr("get")("h5py");
    const py::object objects = py::getattr(h5py, "_objects", py::none());
    lock_ = py::getattr(objects, "phil", py::none());
    if (!lock_.is_none()) lock_.attr("acquire")();
  }
  ~Hdf5Turn() {
    if (!lock_.is_none()) lock_.attr("release")();
  }
  Hdf5Turn(const Hdf5Turn&) = delete;
  Hdf5Turn& operator=(const Hdf5Turn&) = delete;

 private:
  py::object lock_;
};

}  // namespace prostm::python
