#include "prostm/acoustics/focus/live_focus_solver.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "prostm/acoustics/field/propagation.hpp"
#include "prostm/acoustics/focus/detail/solver_kernels.hpp"
#include "prostm/core/require.hpp"

namespace prostm {
namespace {

using Complex = std::complex<float>;

constexpr int kMost = static_cast<int>(kMaxLiveFoci);
using SmallMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMost, kMost>;
using SmallJacobian = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMost, 2 * kMost>;
using SmallVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMost, 1>;
constexpr float kFarthest = 10.0F;    // largest coordinate of focal points and transducers [m]
constexpr float kSilent = 1e-4F;      // amplitudes up to this are silent
constexpr float kLeastShare = 1e-6F;  // share of the pressure of a focal point alone
constexpr float kMostWeight = 10.0F;  // highest weight in (A16); the lowest is its inverse
constexpr float kLeastSum = 0.1F;     // least sum of phasors over their rms, in gradients of (A23)
constexpr double kMostChange = 0.3;   // largest change of a c in a step of (A23)
// scale of changes of c perpendicular to it in (A23), relative to those along it
constexpr double kAcross = 0.3;
constexpr float kCloseEnough = 0.05F;   // relative error of a share that (A23) accepts
constexpr int kMoreIterations = 2;      // further iterations of (A23) above that error
constexpr double kDamping = 1e-2;       // in (A17) and (A23), relative to the mean diagonal
constexpr double kLeastDamping = 1e-9;  // added in case all gradients are 0

static_assert(ComplexRows::kBlock == PackedArray::kRowBlock);  // rows of G are written in place

const TransducerArray& validated(const TransducerArray& array, const LiveFocusSettings& settings) {
  validate(array);
  if (settings.method != FocusMethod::Weighted && settings.method != FocusMethod::Superposition &&
      settings.method != FocusMethod::GsPat) {
    throw std::invalid_argument("only superposition, gs-pat and weighted run live");
  }
  require_between("iterations", settings.iterations, 1, 1000);
  if (settings.phase_levels != 0) require_between("phase_levels", settings.phase_levels, 2, 65536);
  require_between("full_scale", settings.full_scale, 0.0, 1e6, "Pa");
  require_between("bound", settings.bound, 1.0, 100.0);
  require_between("memory", settings.memory, 0.0, 0.95);
  if (settings.adds_phasors && settings.method != FocusMethod::Weighted) {
    throw std::invalid_argument("only weighted runs for arrays that add phasors");
  }
  return array;
}

Complex direction(const Complex& z) {
  const float size = std::abs(z);
  return size > 0.0F ? z / size : Complex(1.0F);
}

/// Returns a box that contains every point nearer than kNearestPoint to a transducer.
Eigen::AlignedBox3f box_around(const TransducerArray& array) {
  Eigen::AlignedBox3f box;
  const Eigen::Vector3f margin = Eigen::Vector3f::Constant(static_cast<float>(kNearestPoint));
  for (const Vec3& p : array.position) {
    box.extend(p.cast<float>() - margin);
    box.extend(p.cast<float>() + margin);
  }
  return box;
}

/// Returns whether p is at least kNearestPoint from every transducer, so that (A1) is valid.
bool is_clear(const PackedArray& packed, const Eigen::AlignedBox3f& box, const Eigen::Vector3f& p) {
  if (!box.contains(p)) return true;
  const Vec3 at = p.cast<double>();
  return std::all_of(packed.array.position.begin(), packed.array.position.end(),
                     [&](const Vec3& t) { return (at - t).norm() >= kNearestPoint; });
}

/// Whether x is finite and in range, tested in this order, since comparing NaN may trap.
bool is_within(float x, float low, float high) {
  return std::isfinite(x) && x >= low && x <= high;
}

bool is_sound(const LiveFocus& focus) {
  bool sound = is_within(focus.amplitude, kSilent, 1.0F);
  for (const float x : focus.p_D) sound = sound && is_within(x, -kFarthest, kFarthest);
  return sound;
}

/// @param levels steps per turn; 0: any phase.
Complex rounded_phase(const Complex& q, int levels) {
  if (levels == 0) return q;
  const float step = 2.0F * std::numbers::pi_v<float> / static_cast<float>(levels);
  return std::polar(std::abs(q), step * std::round(std::arg(q) / step));
}

}  // namespace

LiveFocusSolver::LiveFocusSolver(const TransducerArray& array, const Medium& medium,
                                 const LiveFocusSettings& settings)
    : settings_(settings),
      packed_(validated(array, settings), medium),
      near_(box_around(array)),
      g_(kMaxLiveFoci, packed_.transducers()),
      drive_(1, packed_.transducers()),
      turns_(kMaxLiveFoci, packed_.transducers()),
      phasors_(settings.adds_phasors ? kMaxLiveFoci : 1, packed_.transducers()),
      pulls_(settings.adds_phasors ? kMaxLiveFoci : 1, packed_.transducers()),
      played_(1, packed_.transducers()),
      correlation_(kMaxLiveFoci, kMaxLiveFoci),
      magnitude_(1, kMaxLiveFoci),
      x_(1, kMaxLiveFoci),
      scratch_(1, kMaxLiveFoci) {
  reset();
}

void LiveFocusSolver::reset() {
  phase_.fill(1.0F);
  weight_.fill(1.0F);
  coefficient_.fill(0.0F);
  std::fill_n(played_.re(0), played_.stride(), 0.0F);
  std::fill_n(played_.im(0), played_.stride(), 0.0F);
}

void LiveFocusSolver::solve(std::span<const LiveFocus> foci) noexcept {
  if (!settings_.warm) reset();
  count_ = 0;
  for (std::size_t f = 0; f < std::min(foci.size(), kMaxLiveFoci); ++f) {
    if (is_within(foci[f].amplitude, 0.0F, kSilent)) {
      weight_[f] = 1.0F;
    } else {
      add(foci[f], f);
    }
  }
  switch (settings_.method) {
    case FocusMethod::GsPat:
      return scale(gs_pat());
    case FocusMethod::Weighted:
      return scale(settings_.adds_phasors ? add_phasors() : weighted());
    default:
      return scale(superpose());
  }
}

/// Adds a focal point unless it is invalid.
void LiveFocusSolver::add(const LiveFocus& focus, std::size_t place) {
  if (!is_sound(focus) || !is_clear(packed_, near_, focus.p_D)) return;
  propagation_row_in_single(packed_, focus.p_D.cast<double>(), g_.re(count_), g_.im(count_));
  const solving::Magnitudes all = solving::magnitudes(g_, count_);
  if (all.squares <= 0.0F) return;
  if (settings_.adds_phasors) set_phasors();
  place_[count_] = place;
  const auto full_scale = static_cast<float>(settings_.full_scale);
  const auto bound = static_cast<float>(settings_.bound);
  wanted_[count_] =
      focus.amplitude * (full_scale > 0.0F ? std::min(full_scale / all.sum, bound) : 1.0F);
  alone_[count_] = all.sum;
  squares_[count_] = all.squares;
  ++count_;
}

/// Sets the phasors of the focal point being added.
void LiveFocusSolver::set_phasors() {
  const float *re = g_.re(count_), *im = g_.im(count_);
  float *unit_re = phasors_.re(count_), *unit_im = phasors_.im(count_);
  for (std::size_t n = 0; n < phasors_.columns(); ++n) {
    const float size = std::max(std::sqrt(re[n] * re[n] + im[n] * im[n]), kLeastShare);
    unit_re[n] = re[n] / size;
    unit_im[n] = im[n] / size;
  }
}

/// (A11). Like the next two functions, computes the drives and returns the largest |q|.
float LiveFocusSolver::superpose() {
  for (std::size_t m = 0; m < count_; ++m) c_[m] = wanted_[m] * alone_[m] / squares_[m];
  return solving::back_propagate(g_, {c_.data(), count_}, drive_);
}

/// (A13)
float LiveFocusSolver::gs_pat() {
  solving::correlate(g_, count_, correlation_);
  std::fill_n(magnitude_.re(0), magnitude_.stride(), 0.0F);
  for (std::size_t m = 0; m < count_; ++m) {
    magnitude_.re(0)[m] = wanted_[m] * alone_[m];
    x_.set(0, m, magnitude_.re(0)[m] * phase_[place_[m]]);
  }
  solving::iterate_gs_pat(correlation_, magnitude_, count_, settings_.iterations, x_, scratch_);
  for (std::size_t m = 0; m < count_; ++m) {
    phase_[place_[m]] = direction(x_.at(0, m));
    c_[m] = x_.at(0, m) / squares_[m];
  }
  return solving::back_propagate(g_, {c_.data(), count_}, drive_);
}

/// (A16), then one step of (A17)
float LiveFocusSolver::weighted() {
  if (count_ == 0) return superpose();
  for (int i = 0; i < settings_.iterations; ++i) {
    float largest = 0.0F;
    for (std::size_t m = 0; m < count_; ++m) {
      c_[m] = weight_[place_[m]] * wanted_[m] / alone_[m] * phase_[place_[m]];
      largest = std::max(largest, std::abs(c_[m]));
    }
    for (std::size_t m = 0; m < count_; ++m) c_[m] /= largest;
    solving::back_propagate_phases(g_, {c_.data(), count_}, drive_);
    level_ = reach();
    reweigh(level_);
  }
  even_out();
  return 1.0F;
}

/// (A23)
float LiveFocusSolver::add_phasors() {
  if (count_ == 0) return superpose();
  for (std::size_t m = 0; m < count_; ++m) {
    const Complex& before = coefficient_[place_[m]];
    c_[m] = before != 0.0F ? before : wanted_[m] * phase_[place_[m]];
  }
  recall();
  for (int i = 0; i < settings_.iterations + kMoreIterations; ++i) {
    if (i >= settings_.iterations && largest_error() < kCloseEnough) break;
    if (i > 0) correct_phasors();
    solving::back_propagate_phases(phasors_, {c_.data(), count_}, drive_);
    level_ = reach_after_memory();
  }
  float largest = kLeastShare;
  for (std::size_t m = 0; m < count_; ++m) largest = std::max(largest, std::abs(c_[m]));
  coefficient_.fill(0.0F);
  for (std::size_t m = 0; m < count_; ++m) {
    coefficient_[place_[m]] = c_[m] / largest;
    phase_[place_[m]] = direction(c_[m]);
  }
  return 1.0F;
}

/// Computes the pressure at each focal point that remains from previous samples.
void LiveFocusSolver::recall() {
  if (settings_.memory == 0.0) return;
  solving::propagate_drives(g_, played_, {left_.data(), count_});
  for (std::size_t m = 0; m < count_; ++m) left_[m] *= static_cast<float>(settings_.memory);
}

void LiveFocusSolver::play(Complex turn) noexcept {
  if (settings_.memory == 0.0) return;
  const auto memory = static_cast<float>(settings_.memory);
  const Complex kept = memory * std::conj(turn);
  for (std::size_t n = 0; n < played_.columns(); ++n)
    played_.set(0, n, kept * played_.at(0, n) + (1.0F - memory) * drive_.at(0, n));
}

/// One Gauss-Newton step on c. Mostly changes the magnitudes, since the shares depend steeply on
/// |c| where two are nearly equal; for close focal points the phases must change, too.
void LiveFocusSolver::correct_phasors() {
  set_phasor_gradients();
  const auto count = static_cast<Eigen::Index>(count_);
  const auto columns = static_cast<Eigen::Index>(turns_.columns());
  SmallJacobian jacobian(count, 2 * count);
  SmallVector lacks(count);
  for (Eigen::Index m = 0; m < count; ++m) {
    const auto row = static_cast<std::size_t>(m);
    const Eigen::Map<const Eigen::VectorXf> pull(pulls_.re(row), columns);
    for (Eigen::Index l = 0; l < count; ++l) {
      const auto of = static_cast<std::size_t>(l);
      const Eigen::Map<const Eigen::VectorXf> along(turns_.re(of), columns);
      const Eigen::Map<const Eigen::VectorXf> across(turns_.im(of), columns);
      jacobian(m, l) = static_cast<double>(fresh_ * pull.dot(along));
      jacobian(m, count + l) = kAcross * static_cast<double>(fresh_ * pull.dot(across));
    }
    lacks[m] = static_cast<double>(level_ * wanted_[row] - std::abs(y_[row]) / alone_[row]);
  }
  SmallMatrix normal = jacobian * jacobian.transpose();
  normal.diagonal().array() += kDamping * normal.diagonal().mean() + kLeastDamping;
  const SmallVector x = normal.llt().solve(lacks);
  const SmallVector along = jacobian.leftCols(count).transpose() * x;
  const SmallVector across = kAcross * jacobian.rightCols(count).transpose() * x;
  const double most = std::max(along.cwiseAbs().maxCoeff(), across.cwiseAbs().maxCoeff());
  const double share = most > kMostChange ? kMostChange / most : 1.0;
  for (std::size_t m = 0; m < count_; ++m) {
    const auto i = static_cast<Eigen::Index>(m);
    const Complex by(static_cast<float>(share * along[i]), static_cast<float>(share * across[i]));
    c_[m] = rounded_phase(c_[m] + by * direction(c_[m]), settings_.phase_levels);
  }
}

/// Writes the derivatives of the drives' phases with respect to c_l, along and perpendicular to it,
/// to the real and imaginary parts of row l of `turns_`, and those of |y_m|/alone with respect to
/// the phases to row m of `pulls_`.
void LiveFocusSolver::set_phasor_gradients() {
  std::array<Complex, kMaxLiveFoci> c_direction, y_direction;
  float squares = 0.0F;
  for (std::size_t m = 0; m < count_; ++m) {
    c_direction[m] = direction(c_[m]);
    y_direction[m] = direction(y_[m]) * alone_[m];
    squares += std::norm(c_[m]);
  }
  const float least = kLeastSum * std::sqrt(squares);
  for (std::size_t n = 0; n < drive_.columns(); ++n) {
    Complex sum = 0.0F;
    for (std::size_t m = 0; m < count_; ++m) sum += c_[m] * std::conj(phasors_.at(m, n));
    const float size = std::max(std::sqrt(std::norm(sum)), least);
    const Complex q = drive_.at(0, n);
    for (std::size_t m = 0; m < count_; ++m) {
      const Complex u = std::conj(q) * c_direction[m] * std::conj(phasors_.at(m, n)) / size;
      const Complex t = std::conj(y_direction[m]) * g_.at(m, n) * q;
      turns_.set(m, n, {u.imag(), u.real()});
      pulls_.re(m)[n] = -t.imag() / (alone_[m] * alone_[m]);
    }
  }
}

/// Returns the largest relative error of a wanted share.
float LiveFocusSolver::largest_error() const {
  float largest = 0.0F;
  for (std::size_t m = 0; m < count_; ++m) {
    const float reached = std::abs(y_[m]) / alone_[m];
    const float wanted = std::max(level_ * wanted_[m], kLeastShare);
    largest = std::max(largest, std::abs(reached / wanted - 1.0F));
  }
  return largest;
}

/// Stores the phases reached, and raises the weights of focal points that are below their share.
void LiveFocusSolver::reweigh(float level) {
  float sum = 0.0F, all = 0.0F;
  for (std::size_t m = 0; m < count_; ++m) {
    const std::size_t f = place_[m];
    phase_[f] = direction(y_[m]);
    weight_[f] *= level * wanted_[m] / std::max(std::abs(y_[m]) / alone_[m], kLeastShare);
    sum += wanted_[m] * weight_[f];
    all += wanted_[m];
  }
  for (std::size_t m = 0; m < count_; ++m) {
    float& weight = weight_[place_[m]];
    weight = std::clamp(weight * all / sum, 1.0F / kMostWeight, kMostWeight);
  }
}

/// (A17): one Gauss-Newton step on the phases of the drives. @pre y_ and level_ are up to date.
void LiveFocusSolver::even_out() {
  std::array<float, kMaxLiveFoci * kMaxLiveFoci> products;
  for (std::size_t m = 0; m < count_; ++m) c_[m] = direction(y_[m]) / alone_[m];
  solving::phase_gradients(g_, {c_.data(), count_}, drive_, turns_, products);

  const auto count = static_cast<Eigen::Index>(count_);
  SmallMatrix normal =
      Eigen::Map<const Eigen::MatrixXf>(products.data(), count, count).cast<double>();
  normal.diagonal().array() += kDamping * normal.diagonal().mean() + kLeastDamping;
  SmallVector x(count);
  for (std::size_t m = 0; m < count_; ++m) {
    const float residual = std::abs(y_[m]) / alone_[m] - level_ * wanted_[m];
    x[static_cast<Eigen::Index>(m)] = static_cast<double>(-residual);
  }
  const Eigen::LLT<Eigen::Ref<SmallMatrix>> factors(normal);  // in place
  factors.solveInPlace(x);

  std::array<float, kMaxLiveFoci> turn;
  for (std::size_t m = 0; m < count_; ++m) {
    turn[m] = static_cast<float>(x[static_cast<Eigen::Index>(m)]);
  }
  solving::turn_phases(turns_, {turn.data(), count_}, drive_);
}

/// Computes y_ = G q. @return its level.
float LiveFocusSolver::reach() {
  solving::propagate_drives(g_, drive_, {y_.data(), count_});
  return level_of_y();
}

/// Computes y_ = G a, where a are the transducers' outputs, (A10), after playing the scaled drives.
/// @return its level.
float LiveFocusSolver::reach_after_memory() {
  const float level = reach();
  if (settings_.memory == 0.0) return level;
  fresh_ = (1.0F - static_cast<float>(settings_.memory)) / std::max(level, 1.0F);
  for (std::size_t m = 0; m < count_; ++m) y_[m] = left_[m] + fresh_ * y_[m];
  return level_of_y();
}

float LiveFocusSolver::level_of_y() const {
  float sum = 0.0F, squares = 0.0F;
  for (std::size_t m = 0; m < count_; ++m) {
    sum += wanted_[m] * std::abs(y_[m]) / alone_[m];
    squares += wanted_[m] * wanted_[m];
  }
  return count_ == 0 ? 0.0F : sum / squares;
}

/// Scales all drives by one factor, so that either the level or the largest drive is 1.
void LiveFocusSolver::scale(float largest) {
  const float level = reach();
  const float factor = count_ == 0 ? 0.0F : 1.0F / std::max(level, largest);
  level_ = level * factor;
  magnitude_of_drives_ = factor;
  float *re = drive_.re(0), *im = drive_.im(0);
  for (std::size_t n = 0; n < drive_.stride(); ++n) {
    re[n] *= factor;
    im[n] *= factor;
  }
  if (settings_.phase_levels == 0 || settings_.adds_phasors) return;
  for (std::size_t n = 0; n < drive_.columns(); ++n) {
    drive_.set(0, n, rounded_phase(drive_.at(0, n), settings_.phase_levels));
  }
}

}  // namespace prostm
