#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>

#include "prostm/acoustics/focus/focus_solver.hpp"
#include "prostm/core/random.hpp"
#include "report.hpp"
#include "solvers/textbook_gs_pat.hpp"

namespace prostm {
namespace {

// The baseline is comparable only if it computes the same drives.
TEST(TextbookGsPat, FindsTheDrivesOfTheReference) {
  Random random(1);
  for (const int foci : {1, 3, 8}) {
    std::vector<Eigen::Vector3f> at;
    std::vector<Vec3> points;
    std::vector<float> a;
    for (int f = 0; f < foci; ++f) {
      at.emplace_back(static_cast<float>(0.02 * (f % 4) - 0.03),
                      static_cast<float>(0.025 * (f / 4) + random.uniform(0.0, 0.005)), 0.2F);
      points.push_back(at.back().cast<double>());
      a.push_back(static_cast<float>(random.uniform(0.3, 1.0)));
    }
    const TransducerArray array = usx_array();
    bench::TextbookGsPat textbook(array, Medium{}, foci);
    textbook.solve(at, a, 20);

    const Propagation g = propagation_to(array, Medium{}, points);
    Eigen::VectorXd target = g.cwiseAbs().rowwise().sum();
    for (int f = 0; f < foci; ++f) target[f] *= static_cast<double>(a[static_cast<std::size_t>(f)]);
    const FocusSolution reference = solve_foci(g, 1e6 * target, {.method = FocusMethod::GsPat});
    for (Eigen::Index n = 0; n < g.cols(); ++n) {
      const auto i = static_cast<std::size_t>(n);
      const std::complex<double> q(static_cast<double>(textbook.re()[i]),
                                   static_cast<double>(textbook.im()[i]));
      EXPECT_LT(std::abs(q - reference.drive[n]), 1e-3) << foci << ' ' << n;
    }
  }
}

}  // namespace
}  // namespace prostm
