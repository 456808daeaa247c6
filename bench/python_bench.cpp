/// Cost of a plan from Python and from C++: the same field, settings and process, in turn.
///
/// usage: python_bench [--json FILE]

#include <pybind11/embed.h>
#include <pybind11/numpy.h>

#include <chrono>
#include <cmath>
#include <string>
#include <vector>

#include "prostm/core/distribution.hpp"
#include "prostm/fields/fields.hpp"
#include "prostm/plan/planner.hpp"
#include "report.hpp"

namespace prostm {
namespace {

namespace py = pybind11;

constexpr int kRepeats = 400;

/// The Python side: `plan` calls a planner that is kept; `read` also reads every array of the
/// result; `whole` first makes the field from an array.
constexpr const char* kPython = R"(
import time
import numpy
import prostm

def plan(planner, pressure, field, cell):
    start = time.perf_counter_ns()
    planner.plan(field)
    return time.perf_counter_ns() - start

def read(planner, pressure, field, cell):
    start = time.perf_counter_ns()
    for path in planner.plan(field).paths:
        path.points, path.pressure, path.length
    return time.perf_counter_ns() - start

def whole(planner, pressure, field, cell):
    start = time.perf_counter_ns()
    for path in planner.plan(prostm.TargetField(pressure, cell)).paths:
        path.points, path.pressure, path.length
    return time.perf_counter_ns() - start
)";

double microseconds_of_cpp(Planner& planner, const TargetField& field) {
  Plan plan;
  PlanStats stats;
  const auto start = std::chrono::steady_clock::now();
  planner.plan(field, plan, stats);
  return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start)
      .count();
}

py::array_t<double> as_array(const TargetField& field) {
  py::array_t<double> pressure({field.rows, field.cols});
  for (std::size_t i = 0; i < field.size(); ++i) {
    pressure.mutable_data()[i] = field.skin[i] != 0 ? field.pressure[i] : std::nan("");
  }
  return pressure;
}

/// Adds the times of Python and C++, measured in turn, and their difference in each repeat.
void compare(const std::string& name, const PlanSettings& settings, py::module_& main,
             std::vector<bench::Row>& rows) {
  const TargetField field = fields::make(fields::Pattern::FourPlumes, 0);
  Planner planner(settings, field.size());
  const py::object prostm = py::module_::import("prostm");
  const py::object python_planner =
      prostm.attr("Planner")(py::arg("max_cells") = field.size(),
                             py::arg("preset") = std::string(name_of(settings.preset)),
                             py::arg("clusters") = settings.clusters,
                             py::arg("refine_iterations") = settings.refine_iterations);
  const py::array_t<double> pressure = as_array(field);
  const py::object python_field = prostm.attr("TargetField")(pressure, field.cell);

  for (const char* call : {"plan", "read", "whole"}) {
    const py::object function = main.attr(call);
    Distribution python, cpp, overhead;
    for (int repeat = -10; repeat < kRepeats; ++repeat) {
      // they also take turns in being first
      double a = 0.0, b = 0.0;
      if (repeat % 2 == 0) a = microseconds_of_cpp(planner, field);
      b = 1e-3 * function(python_planner, pressure, python_field, field.cell).cast<double>();
      if (repeat % 2 != 0) a = microseconds_of_cpp(planner, field);
      if (repeat < 0) continue;
      cpp.add(a);
      python.add(b);
      overhead.add(b - a);
    }
    const std::string row = "python/" + name + "/" + call;
    rows.push_back({row, "us", python.summary(), "C++", cpp.summary().p50});
    rows.push_back({row + " less C++", "us", overhead.summary(), "", 0.0});
  }
}

std::vector<bench::Row> measure() {
  const py::scoped_interpreter interpreter;
  py::module_::import("sys").attr("path").attr("insert")(0, PROSTM_PYTHON_FOLDER);
  py::module_ main = py::module_::import("__main__");
  py::exec(kPython, main.attr("__dict__"));

  std::vector<bench::Row> rows;
  const PlanSettings settings;
  compare(std::string(name_of(settings.preset)), settings, main, rows);
  // a plan so short that the cost of the call itself shows
  PlanSettings least = settings;
  least.clusters = 4;
  least.refine_iterations = 0;
  compare("least", least, main, rows);
  return rows;
}

}  // namespace
}  // namespace prostm

int main(int argc, char** argv) {
  return prostm::bench::run(argc, argv, prostm::measure);
}
