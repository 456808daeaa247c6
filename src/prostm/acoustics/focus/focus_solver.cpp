#include "prostm/acoustics/focus/focus_solver.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <stdexcept>
#include <string>

#include "prostm/core/require.hpp"

namespace prostm {
namespace {

using Complex = std::complex<double>;
using Eigen::MatrixXcd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

constexpr int kPowerIterations = 100;
constexpr int kReferenceFactor = 50;    // iterations of the reference per iteration of the settings
constexpr double kConverged = 1e-12;    // share of an eigenvector's or the pressures' square norm
constexpr double kFirstDamping = 1e-3;  // in (A15), relative to the mean of the diagonal of JJᵀ
constexpr double kDamping = 1e-2;       // in (A17), relative to the mean of its diagonal
constexpr double kLeastDamping = 1e-9;  // added in case all gradients are 0
constexpr double kLeastShare = 1e-6;    // share of the pressure of a focal point alone
constexpr double kMostWeight = 10.0;    // highest weight in (A16); the lowest is its inverse
constexpr double kLargestDamping = 1e12;  // reached if no step lowers the error

/// z/|z|; 1 for 0.
Complex direction(const Complex& z) {
  const double size = std::abs(z);
  return size > 0.0 ? z / size : Complex(1.0);
}

VectorXcd directions(const VectorXcd& z) {
  return z.unaryExpr([](const Complex& c) { return direction(c); });
}

VectorXcd with_phases(const VectorXd& size, const VectorXcd& phase) {
  return size.cast<Complex>().cwiseProduct(phase);
}

/// B: the naive focus of each focal point, conj(G_mn) / Σ_n |G_mn|², N × M. G B has ones on its
/// diagonal.
MatrixXcd back_propagation(const Propagation& g) {
  return g.adjoint() * g.rowwise().squaredNorm().cwiseInverse().cast<Complex>().asDiagonal();
}

VectorXcd start_phases(const VectorXd& start, Eigen::Index foci) {
  if (start.size() == 0) return VectorXcd::Ones(foci);
  return start.unaryExpr([](double phase) { return std::polar(1.0, phase); });
}

VectorXcd iterate_back(const Propagation& g, const VectorXd& target, VectorXcd phase,
                       int iterations) {
  VectorXcd drive;
  for (int i = 0; i < iterations; ++i) {
    drive = directions(g.adjoint() * with_phases(target, phase));
    phase = directions(g * drive);
  }
  return drive;
}

VectorXcd gs_pat(const Propagation& g, const VectorXd& target, const VectorXcd& phase,
                 int iterations) {
  const MatrixXcd b = back_propagation(g), r = g * b;
  VectorXcd p = with_phases(target, phase);
  for (int i = 0; i < iterations; ++i) p = r * with_phases(target, directions(r * p));
  return b * with_phases(target, directions(p));
}

/// Returns the phases of the focal points at which their naive foci reinforce each other most.
VectorXcd eigenvector_phases(const Propagation& g, const VectorXd& target, const VectorXcd& phase) {
  const MatrixXcd r = g * back_propagation(g) * target.cast<Complex>().asDiagonal();
  VectorXcd v = phase.normalized();
  for (int i = 0; i < kPowerIterations; ++i) {
    const VectorXcd next = (r * v).normalized();
    const double change = (next - direction(v.dot(next)) * v).squaredNorm();
    v = next;
    if (change < kConverged) break;
  }
  return directions(v);
}

/// (A14): the q that minimises Σ_m |G q − p|² + Σ_n |s_n^γ q_n|², s_n² = |Σ_m G_mn a_m| / M, with G
/// divided by the root mean square norm of its rows. With W = diag(s^−2γ), q = W Gᴴ (G W Gᴴ + 1)⁻¹
/// p.
VectorXcd least_squares(const Propagation& propagation, const VectorXd& target, const VectorXcd& p,
                        double gamma) {
  const auto foci = static_cast<double>(propagation.rows());
  const MatrixXcd g = propagation / (propagation.norm() / std::sqrt(foci));
  const VectorXd w =
      (g.transpose() * target.cast<Complex>()).unaryExpr([&](const Complex& sum) -> double {
        const double s2 = std::abs(sum) / foci;
        return s2 > 0.0 ? std::pow(s2, -gamma) : 0.0;
      });
  const MatrixXcd wg = w.cast<Complex>().asDiagonal() * g.adjoint();
  const MatrixXcd normal = g * wg + MatrixXcd::Identity(g.rows(), g.rows());
  return wg * normal.llt().solve(p);
}

/// Σ a |p| / Σ a².
double level_of(const VectorXcd& pressure, const VectorXd& target) {
  return target.dot(pressure.cwiseAbs()) / target.squaredNorm();
}

/// Derivatives of |p_m| with respect to the phases of the drives: ∂|p_m|/∂θ_n = −Im(conj(p_m)/|p_m|
/// G_mn q_n).
Eigen::MatrixXd phase_gradients(const Propagation& g, const VectorXcd& p, const VectorXcd& q) {
  const MatrixXcd turned = directions(p).conjugate().asDiagonal() * g * q.asDiagonal();
  return -turned.imag();
}

/// Shifts the phases of q by these angles [rad].
VectorXcd turned(const VectorXcd& q, const VectorXd& angle) {
  return q.cwiseProduct(VectorXcd(angle.unaryExpr([](double t) { return std::polar(1.0, t); })));
}

/// (A16), then one step of (A17), with pressures relative to those of each focal point alone.
VectorXcd weighted(const Propagation& propagation, const VectorXd& target, VectorXcd phase,
                   int iterations) {
  const VectorXd alone = propagation.cwiseAbs().rowwise().sum();
  const Propagation g = alone.cwiseInverse().cast<Complex>().asDiagonal() * propagation;
  const VectorXd a = target.cwiseQuotient(alone) / target.cwiseQuotient(alone).maxCoeff();
  VectorXd weight = VectorXd::Ones(a.size());
  VectorXcd q, y;
  for (int i = 0; i < iterations; ++i) {
    q = directions(g.adjoint() * with_phases(weight.cwiseProduct(a), phase));
    y = g * q;
    phase = directions(y);
    const VectorXd share = y.cwiseAbs().cwiseMax(kLeastShare);
    weight = weight.cwiseProduct(level_of(y, a) * a).cwiseQuotient(share);
    weight *= a.sum() / a.dot(weight);
    weight = weight.cwiseMax(1.0 / kMostWeight).cwiseMin(kMostWeight);
  }
  const Eigen::MatrixXd j = phase_gradients(g, y, q);
  Eigen::MatrixXd normal = j * j.transpose();
  normal.diagonal().array() += kDamping * normal.diagonal().mean() + kLeastDamping;
  const VectorXd residual = y.cwiseAbs() - level_of(y, a) * a;
  return turned(q, -j.transpose() * normal.llt().solve(residual));
}

/// (A15), starting from the phases of `drive`: damped Gauss-Newton on |p_m| − s a_m, s the level.
VectorXcd levenberg_marquardt(const Propagation& g, const VectorXd& target, const VectorXcd& drive,
                              int iterations) {
  VectorXcd q = directions(drive);
  VectorXcd p = g * q;
  const auto residual = [&](const VectorXcd& at) -> VectorXd {
    return at.cwiseAbs() - level_of(at, target) * target;
  };
  VectorXd r = residual(p);
  double damping = kFirstDamping;
  for (int i = 0; i < iterations && damping < kLargestDamping; ++i) {
    if (r.squaredNorm() < kConverged * p.squaredNorm()) break;
    const Eigen::MatrixXd j = phase_gradients(g, p, q);
    Eigen::MatrixXd normal = j * j.transpose();
    normal.diagonal().array() += damping * normal.diagonal().mean();
    const VectorXcd trial = turned(q, -j.transpose() * normal.llt().solve(r));
    const VectorXcd reached = g * trial;
    const VectorXd left = residual(reached);
    if (left.squaredNorm() < r.squaredNorm()) {
      q = trial;
      p = reached;
      r = left;
      damping *= 0.1;
    } else {
      damping *= 10.0;
    }
  }
  return q;
}

VectorXcd drives_of(const Propagation& g, const VectorXd& target, const FocusSettings& settings,
                    const VectorXcd& phase) {
  switch (settings.method) {
    case FocusMethod::Superposition:
      return back_propagation(g) * with_phases(target, phase);
    case FocusMethod::Ibp:
      return iterate_back(g, target, phase, settings.iterations);
    case FocusMethod::GsPat:
      return gs_pat(g, target, phase, settings.iterations);
    case FocusMethod::Weighted:
      return weighted(g, target, phase, settings.iterations);
    case FocusMethod::Eigenvector:
      return least_squares(g, target, with_phases(target, eigenvector_phases(g, target, phase)),
                           settings.regularisation);
    case FocusMethod::LevenbergMarquardt:
      return levenberg_marquardt(g, target, gs_pat(g, target, phase, settings.iterations),
                                 kReferenceFactor * settings.iterations);
  }
  return {};
}

void check(const Propagation& g, const VectorXd& target, const FocusSettings& settings,
           const VectorXd& start) {
  const auto refuse = [](const std::string& what) { throw std::invalid_argument(what); };
  const Eigen::Index foci = g.rows();
  if (foci < 1) refuse("there must be at least one focal point");
  if (foci > g.cols()) {
    refuse("there are " + std::to_string(foci) + " focal points; there must be at most " +
           std::to_string(g.cols()) + ", one for each transducer");
  }
  if (target.size() != foci || (start.size() != 0 && start.size() != foci)) {
    refuse("there must be a target for each of " + std::to_string(foci) +
           " focal points, and as many phases or none");
  }
  for (Eigen::Index m = 0; m < foci; ++m) {
    const std::string which = "focal point " + std::to_string(m + 1);
    if (!(std::isfinite(target[m]) && target[m] >= 0.0)) {
      refuse(which + ": the target must be a pressure of 0 Pa or more");
    }
    if (start.size() != 0 && !std::isfinite(start[m])) refuse(which + ": the phase must be finite");
    // element by element: Eigen's own test subtracts infinities, which traps
    double most = 0.0;
    for (const Complex& p : g.row(m)) {
      if (!std::isfinite(p.real()) || !std::isfinite(p.imag())) {
        refuse(which + ": the pressure of each transducer must be finite");
      }
      most = std::max(most, std::abs(p));
    }
    if (most == 0.0) refuse(which + " must be reached by some transducer");
  }
  if (target.isZero(0.0)) refuse("at least one focal point must have a target above 0 Pa");
  require_between("iterations", settings.iterations, 1, 10'000);
  require_between("regularisation", settings.regularisation, 0.0, 1.0);
}

}  // namespace

FocusSolution solve_foci(const Propagation& propagation, const Eigen::VectorXd& target,
                         const FocusSettings& settings, const Eigen::VectorXd& start) {
  check(propagation, target, settings, start);
  // relative to the largest, so that squares of any target are in a double's range
  const double highest = target.maxCoeff();
  const VectorXd shares = target / highest;
  FocusSolution out;
  out.drive = drives_of(propagation, shares, settings, start_phases(start, target.size()));
  const double largest = out.drive.cwiseAbs().maxCoeff();
  if (largest > 0.0) out.drive /= largest;
  out.pressure = propagation * out.drive;
  // scale down to the targets if they are exceeded at a largest drive of 1
  const double reached = level_of(out.pressure, shares);
  if (reached > highest) {
    out.drive *= highest / reached;
    out.pressure *= highest / reached;
  }
  out.level = std::min(reached / highest, 1.0);
  return out;
}

Eigen::VectorXd focus_errors(const FocusSolution& solution, const Eigen::VectorXd& target) {
  VectorXd errors = VectorXd::Zero(target.size());
  for (Eigen::Index m = 0; m < target.size(); ++m) {
    if (target[m] == 0.0 || solution.level == 0.0) continue;
    errors[m] = std::abs(solution.pressure[m]) / (solution.level * target[m]) - 1.0;
  }
  return errors;
}

}  // namespace prostm
