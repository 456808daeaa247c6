/// prostm-foci/1: any text gives focal points that drives of at most 1 can produce, or an error.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>

#include "prostm/acoustics/field/propagation.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/io/foci_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace prostm;
  static const TransducerArray array = usx_array();
  try {
    const FociFile foci = foci_from_json({reinterpret_cast<const char*>(data), size}, "fuzz.json");
    const Propagation g = propagation_to(array, Medium{}, foci.position);
    const Eigen::VectorXd target =
        Eigen::Map<const Eigen::VectorXd>(foci.pressure.data(), g.rows());
    const FocusSolution solution = solve_foci(g, target, {});
    for (const auto& q : solution.drive) {
      if (!(std::abs(q) <= 1.0 + 1e-9)) std::abort();
    }
  } catch (const InputError&) {
    // the required answer to bad input
  } catch (const std::invalid_argument&) {
    // the required answer to impossible focal points
  }
  return 0;
}
