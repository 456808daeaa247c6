#include "prostm/felt/felt_loss.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "prostm/core/units.hpp"
#include "prostm/felt/detail/felt_kernels.hpp"

namespace prostm {
namespace {

constexpr double kLeastPercept = 1e-3;  // smoothing of √e at 0, relative to its rms
constexpr double kSilence = 1e-18;      // e where no source is felt [µm²], so that 1/e is finite

/// Returns the upper bound of a part of a pair, a sum of two products.
template <class Real>
Real largest(std::span<const FocusResponse<Real>> skins,
             std::span<const FeltSource<Real>> sources) {
  Real table = 0, source = 0;
  for (const FocusResponse<Real>& skin : skins) table = std::max(table, skin.largest);
  for (const FeltSource<Real>& at : sources) {
    for (const Real part : at.spectrum) source = std::max(source, std::abs(part));
  }
  return 2 * table * source;
}

}  // namespace

template <class Real>
struct FeltLoss<Real>::Impl {
  using Vector = typename RenderLack<Real>::Vector;
  using Pair = FeltPair<Real>;
  using Kept = FeltKept<Real>;

  struct Skin {
    Vector percept;
    Real log_energy = 0, kept = 0;  // log energy of this loop, and the one to keep
    Real lack = 0;                  // (W2), without its part for e
    Real coarse = 0;                // 1 − S_8.5 of √e
  };

  Impl(std::size_t skins, std::size_t most_cells, std::size_t sources, const FeltWeights& w,
       bool with_slopes)
      : fine(static_cast<Real>(w.fine)),
        energy_share(static_cast<Real>(w.energy)),
        loudness(static_cast<Real>(w.loudness)),
        quiet(static_cast<Real>(w.quiet)),
        lack(most_cells),
        skin(skins) {
    const std::size_t rows = most_cells * skins;
    pairs.resize(rows * sources);
    if (with_slopes) slopes.resize(pairs.size());
    for (auto* list : {&felt, &pull, &turned}) list->resize(rows);
    for (Skin& s : skin) s.percept.setZero(static_cast<Eigen::Index>(most_cells));
    for (Vector* v : {&energy, &by_root, &by_energy})
      v->setZero(static_cast<Eigen::Index>(most_cells));
    sums.resize(sources);
    turns.reserve(sources);
    for (auto* list : {&source_x, &source_y, &slid_x, &slid_y})
      list->reserve(sources + kFeltMargin);
    cells.reserve(most_cells);
  }

  /// Rows of felt, pull and pairs: cell by cell, skin by skin.
  std::size_t rows() const { return cells.size() * skin.size(); }
  std::size_t row(Eigen::Index cell, std::size_t s) const {
    return static_cast<std::size_t>(cell) * skin.size() + s;
  }
  FeltAround<Real> around(std::size_t cell) const {
    return {static_cast<Real>(cells[cell].x), static_cast<Real>(cells[cell].y), source_x.data(),
            source_y.data(), turns.size()};
  }
  Real evaluate(std::span<const Real> amplitude, std::optional<Real> keep);
  Real evaluate(std::size_t s, std::optional<Real> keep);
  /// Returns Σ_row pair · by for each source.
  std::span<Pair> add_up(const std::vector<Pair>& by) {
    const std::span<Pair> all = std::span(sums).first(turns.size());
    for (Pair& sum : all) sum.part.fill(0);
    run.backward(pairs.data(), rows(), by.data(), all);
    return all;
  }

  FeltKernels<Real> run = felt_kernels<Real>();
  Real fine, energy_share, loudness, quiet;
  Real per_square = 1;  // 1 / unit² of pairs, felt and pull, which are scaled by units
  RenderLack<Real> lack;
  std::vector<FeltCells::Cell> cells;
  std::vector<Real> source_x, source_y;  // [mm], with margin
  std::vector<Real> slid_x, slid_y;      // ∂loss/∂x and ∂loss/∂y per amplitude, with margin
  std::vector<FeltTurn<Real>> turns;
  std::vector<Skin> skin;
  std::vector<Kept> pairs, slopes;    // rows × sources
  std::vector<Pair> felt, pull;       // for each row: v of (W1), and ∂loss/∂v …
  std::vector<Pair> turned;           // … rotated by a quarter turn in each harmonic
  std::vector<Pair> sums;             // for each source
  Vector energy, by_root, by_energy;  // e in each cell, ∂loss/∂√e, ∂loss/∂e
};

template <class Real>
FeltLoss<Real>::FeltLoss(std::size_t skins, std::size_t most_cells, std::size_t most_sources,
                         const FeltWeights& weights, bool with_slopes)
    : impl_(std::make_unique<Impl>(skins, most_cells, most_sources, weights, with_slopes)) {}
template <class Real>
FeltLoss<Real>::~FeltLoss() = default;
template <class Real>
FeltLoss<Real>::FeltLoss(FeltLoss&&) noexcept = default;
template <class Real>
FeltLoss<Real>& FeltLoss<Real>::operator=(FeltLoss&&) noexcept = default;

template <class Real>
void FeltLoss<Real>::set_target(const FeltCells& cells) {
  impl_->cells = cells.cells();
  impl_->lack.set(cells);
}

template <class Real>
void FeltLoss<Real>::set_sources(std::span<const FocusResponse<Real>> skins,
                                 std::span<const FeltSource<Real>> sources) {
  Impl& d = *impl_;
  const Real most = largest(skins, sources);
  const Real unit = most > 0 ? static_cast<Real>(kMostFixed) / most : Real(1);
  d.per_square = 1 / (unit * unit);
  d.turns.resize(sources.size());
  for (auto* list : {&d.source_x, &d.source_y}) list->assign(sources.size() + kFeltMargin, 0);
  constexpr std::size_t kImaginary = kFeltParts / 2;
  for (std::size_t j = 0; j < sources.size(); ++j) {
    d.source_x[j] = sources[j].x;
    d.source_y[j] = sources[j].y;
    for (std::size_t n = 0; n < kImaginary; ++n) {
      FeltTurn<Real>& turn = d.turns[j];
      turn.straight[n] = turn.straight[n + kImaginary] = unit * sources[j].spectrum[n];
      turn.crossed[n + kImaginary] = unit * sources[j].spectrum[n + kImaginary];
      turn.crossed[n] = -turn.crossed[n + kImaginary];
    }
  }
  for (std::size_t x = 0; x < d.cells.size(); ++x) {
    const std::size_t first = x * d.skin.size() * sources.size();
    d.run.fill(skins, d.around(x), d.turns.data(), &d.pairs[first],
               d.slopes.empty() ? nullptr : &d.slopes[first]);
  }
}

/// Returns the loss of one skin from `felt` in its rows, and sets their `pull`. @param keep if
/// given, makes this factor times the present loudness the one to keep.
template <class Real>
Real FeltLoss<Real>::Impl::evaluate(std::size_t number, std::optional<Real> keep) {
  Skin& s = skin[number];
  const auto n = static_cast<Eigen::Index>(cells.size());
  auto e = energy.head(n), root = s.percept.head(n), d_root = by_root.head(n),
       d_energy = by_energy.head(n);
  for (Eigen::Index x = 0; x < n; ++x) {
    e[x] = static_cast<Real>(kSilence);
    for (const Real part : felt[row(x, number)].part) e[x] += per_square * part * part;
  }
  const Real whole = lack.area().dot(e);
  const auto least = static_cast<Real>(kLeastPercept * kLeastPercept);
  root.array() = (e.array() + least * whole).sqrt();
  s.log_energy = std::log(whole);
  if (keep) s.kept = s.log_energy + 2 * std::log(*keep);
  const Real louder = (s.log_energy - s.kept) / 2;
  const Real missing = std::max(-louder - static_cast<Real>(FeltWeights::kSlack), Real(0));
  const Real wanted = loudness + 2 * quiet * missing;
  s.lack = lack.of(root, fine, d_root);
  s.coarse = lack.coarse();
  Real value = s.lack - loudness * louder + quiet * missing * missing;
  d_energy.setZero();
  if (energy_share > 0) value += energy_share * lack.of(e, Real(0), d_energy);
  const Real by_whole = least * (d_root.array() / root.array()).sum() - wanted / whole;
  for (Eigen::Index x = 0; x < n; ++x) {
    const Real factor =
        d_root[x] / root[x] + 2 * energy_share * d_energy[x] + by_whole * lack.area()[x];
    const std::size_t at = row(x, number);
    for (std::size_t i = 0; i < kFeltParts; ++i) pull[at].part[i] = factor * felt[at].part[i];
  }
  return value;
}

template <class Real>
Real FeltLoss<Real>::Impl::evaluate(std::span<const Real> amplitude, std::optional<Real> keep) {
  run.forward(pairs.data(), rows(), amplitude, felt.data());
  Real loss = 0;
  for (std::size_t s = 0; s < skin.size(); ++s) loss += evaluate(s, keep);
  return loss / static_cast<Real>(skin.size());
}

template <class Real>
Real FeltLoss<Real>::evaluate(std::span<const Real> amplitude) {
  return impl_->evaluate(amplitude, std::nullopt);
}

template <class Real>
Real FeltLoss<Real>::keep_loudness(std::span<const Real> amplitude, Real times) {
  return impl_->evaluate(amplitude, times);
}

template <class Real>
void FeltLoss<Real>::gradient(std::span<Real> gradient) {
  Impl& d = *impl_;
  const Real share = d.per_square / static_cast<Real>(d.skin.size());
  const std::span<FeltPair<Real>> sums = d.add_up(d.pull);
  for (std::size_t j = 0; j < sums.size(); ++j) {
    const auto& part = sums[j].part;
    gradient[j] = share * std::accumulate(part.begin(), part.end(), Real(0));
  }
}

template <class Real>
void FeltLoss<Real>::slide(std::span<const Real> amplitude, std::span<Real> gradient_x,
                           std::span<Real> gradient_y) {
  Impl& d = *impl_;
  const std::size_t sources = d.turns.size();
  const Real share = d.per_square / static_cast<Real>(d.skin.size());
  for (auto* list : {&d.slid_x, &d.slid_y}) list->assign(sources + kFeltMargin, 0);
  for (std::size_t row = 0; row < d.rows(); ++row) {
    d.run.slide(&d.slopes[row * sources], d.pull[row], d.around(row / d.skin.size()),
                d.slid_x.data(), d.slid_y.data());
  }
  for (std::size_t j = 0; j < sources; ++j) {
    gradient_x[j] = share * amplitude[j] * d.slid_x[j];
    gradient_y[j] = share * amplitude[j] * d.slid_y[j];
  }
}

template <class Real>
void FeltLoss<Real>::turn(std::span<const Real> amplitude, int first, std::span<Real> gradient) {
  Impl& d = *impl_;
  constexpr std::size_t kImaginary = kFeltParts / 2;
  // the derivative of harmonic n with respect to a source's time is a factor of −i n
  for (std::size_t row = 0; row < d.rows(); ++row) {
    for (std::size_t n = 0; n < kImaginary; ++n) {
      d.turned[row].part[n] = -d.pull[row].part[n + kImaginary];
      d.turned[row].part[n + kImaginary] = d.pull[row].part[n];
    }
  }
  const std::span<FeltPair<Real>> sums = d.add_up(d.turned);
  const Real share = 2 * static_cast<Real>(kPi) * d.per_square / static_cast<Real>(d.skin.size());
  for (std::size_t j = 0; j < sums.size(); ++j) {
    gradient[j] = 0;
    for (std::size_t n = 0; n < kImaginary; ++n) {
      gradient[j] += share * amplitude[j] * static_cast<Real>(static_cast<std::size_t>(first) + n) *
                     (sums[j].part[n] + sums[j].part[n + kImaginary]);
    }
  }
}

template <class Real>
RenderLack<Real>& FeltLoss<Real>::rendering() {
  return impl_->lack;
}

template <class Real>
std::span<const Real> FeltLoss<Real>::percept(std::size_t skin) const {
  return {impl_->skin[skin].percept.data(), impl_->cells.size()};
}

template <class Real>
Real FeltLoss<Real>::lack() const {
  Real sum = 0;
  for (const auto& s : impl_->skin) sum += s.lack;
  return sum / static_cast<Real>(impl_->skin.size());
}

template <class Real>
Real FeltLoss<Real>::coarse_lack() const {
  Real sum = 0;
  for (const auto& s : impl_->skin) sum += s.coarse;
  return sum / static_cast<Real>(impl_->skin.size());
}

template <class Real>
Real FeltLoss<Real>::loudness() const {
  Real sum = 0;
  for (const auto& s : impl_->skin) sum += s.log_energy;
  return std::exp(sum / (2 * static_cast<Real>(impl_->skin.size())));
}

template class FeltLoss<float>;
template class FeltLoss<double>;

}  // namespace prostm
