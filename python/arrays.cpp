#include <pybind11/stl.h>

#include <stdexcept>

#include "bindings.hpp"

namespace prostm::python {
namespace {

std::string shape_text(const py::array& array) {
  return py::str(py::tuple(array.attr("shape")));
}

}  // namespace

std::string described(py::handle value) {
  const bool is_short = value.is_none() || py::isinstance<py::str>(value) ||
                        py::isinstance<py::int_>(value) || py::isinstance<py::float_>(value);
  const std::string text = is_short ? py::repr(value) : py::str("");
  constexpr std::size_t kLongest = 60;
  if (is_short && text.size() <= kLongest) return text;
  if (py::isinstance<py::array>(value)) return "an array";
  const std::string type = py::str(py::type::of(value).attr("__name__"));
  return (std::string("aeiouAEIOU").find(type[0]) == std::string::npos ? "a " : "an ") + type;
}

Numbers numbers(py::handle value, const std::string& name, int dimensions, std::size_t most) {
  const py::array given = py::array::ensure(value);
  if (!given) throw py::type_error(name + " must be an array of numbers, not " + described(value));
  if (std::string("fiub").find(given.dtype().kind()) == std::string::npos) {
    throw py::type_error(name + " must be an array of numbers, not of dtype " +
                         std::string(py::str(given.dtype())));
  }
  if (given.ndim() != dimensions) {
    throw std::invalid_argument(name + " has the shape " + shape_text(given) + "; it must have " +
                                std::to_string(dimensions) + " dimension" +
                                (dimensions == 1 ? "" : "s"));
  }
  // checked before copying: a broadcast array may be larger than the memory
  if (static_cast<std::size_t>(given.size()) > most) {
    throw std::invalid_argument(name + " has the shape " + shape_text(given) +
                                "; it must have at most " + std::to_string(most) + " numbers");
  }
  return Numbers(given);
}

Numbers numbers(py::handle value, const std::string& name, const std::vector<py::ssize_t>& shape) {
  Numbers array = numbers(value, name, static_cast<int>(shape.size()));
  for (std::size_t i = 0; i < shape.size(); ++i) {
    if (array.shape(static_cast<py::ssize_t>(i)) == shape[i]) continue;
    throw std::invalid_argument(name + " has the shape " + shape_text(array) + "; it must be " +
                                std::string(py::str(py::tuple(py::cast(shape)))));
  }
  return array;
}

py::array view(const py::dtype& type, const std::vector<py::ssize_t>& shape, const void* data,
               py::handle owner) {
  py::array array(type, shape, data, owner);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

py::array view(const std::vector<py::ssize_t>& shape, const double* data, py::handle owner) {
  return view(py::dtype::of<double>(), shape, data, owner);
}

py::array pose_matrix(const Pose& pose) {
  py::array_t<double> matrix({4, 4});
  auto m = matrix.mutable_unchecked<2>();
  for (int row = 0; row < 4; ++row) {
    for (int col = 0; col < 4; ++col) m(row, col) = pose.matrix()(row, col);
  }
  return matrix;
}

Pose pose_from(py::handle matrix, const std::string& name) {
  const Numbers given = numbers(matrix, name, std::vector<py::ssize_t>{4, 4});
  const auto m = given.unchecked<2>();
  if (m(3, 0) != 0.0 || m(3, 1) != 0.0 || m(3, 2) != 0.0 || m(3, 3) != 1.0) {
    throw std::invalid_argument(name +
                                " is not a pose: the last row of its matrix must be 0 0 0 1");
  }
  Pose pose = Pose::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int col = 0; col < 4; ++col) pose.matrix()(row, col) = m(row, col);
  }
  return pose;
}

}  // namespace prostm::python
