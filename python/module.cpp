/// The compiled module prostm._prostm, whose names the package prostm re-exports.

#include "bindings.hpp"
#include "prostm/commit.hpp"
#include "prostm/core/file/advisory_lock.hpp"
#include "prostm/core/input_error.hpp"

PYBIND11_MODULE(_prostm, m) {
  namespace py = pybind11;
  using namespace prostm::python;

  // a class takes its module's name when it is created; it should be prostm.Plan
  const py::object own_name = m.attr("__name__");
  m.attr("__name__") = "prostm";
  prostm::set_lock_warning([](const std::string& sentence) {
    const py::gil_scoped_acquire locked;
    if (PyErr_WarnEx(PyExc_RuntimeWarning, sentence.c_str(), 1) != 0) throw py::error_already_set();
  });
  m.attr("__version__") = PROSTM_VERSION;
  m.attr("__commit__") = std::string(prostm::commit());
  py::register_exception<prostm::InputError>(m, "InputError", PyExc_ValueError).doc() =
      "An invalid file. The message is one sentence: the problem, its place, and the remedy.";
  m.def("_described", &described, "Describes a value in a message.", py::arg("value"));
  // classes must be bound before the signatures that name them
  bind_target(m);
  bind_paths(m);
  bind_plan(m);
  bind_score(m);
  bind_felt(m);
  bind_emit(m);
  bind_result(m);
  bind_planners(m);
  bind_io(m);
  bind_shape(m);
  bind_recording(m);
  m.attr("__name__") = own_name;
}
