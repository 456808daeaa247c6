/// import prostm._prostm: what the package prostm/ shows under its own name.

#include "bindings.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/version.hpp"

PYBIND11_MODULE(_prostm, m) {
  namespace py = pybind11;
  using namespace prostm::python;

  // classes and signatures are to say prostm.Plan: a class takes its module's name when it is made
  const py::object own_name = m.attr("__name__");
  m.attr("__name__") = "prostm";
  m.attr("__version__") = PROSTM_VERSION;
  py::register_exception<prostm::InputError>(m, "InputError", PyExc_ValueError).doc() =
      "A file that is wrong: one sentence that says what, where, and what would be right.";
  bind_target(m);
  bind_paths(m);
  bind_plan(m);
  bind_score(m);
  bind_result(m);
  bind_emit(m);
  bind_io(m);
  m.attr("__name__") = own_name;
}
