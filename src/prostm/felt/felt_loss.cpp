#include "prostm/felt/felt_loss.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <type_traits>

#include "prostm/core/units.hpp"
#include "prostm/felt/detail/felt_kernels.hpp"

namespace prostm {
namespace {

constexpr double kLeastPercept = 1e-3;   // smooths √e at 0, over its rms
constexpr double kLeastDistance = 1e-6;  // [mm]

template <class Real>
FeltKernels<Real> kernels() {
  if constexpr (std::is_same_v<Real, float>) {
    return fast_felt_kernels();
  } else {
    return plain_felt_kernels<Real>();
  }
}

}  // namespace

template <class Real>
struct FeltLoss<Real>::Impl {
  using Vector = typename RenderLack<Real>::Vector;
  using Pair = FeltPair<Real>;

  /// One skin.
  struct Skin {
    std::vector<Pair> pairs, slopes;  // cells × sources
    std::vector<Pair> felt, pull;     // v of (W2) in each cell, and ∂loss/∂v
    Vector percept;
    Real log_energy = 0, kept = 0;  // of this loop, and of the one whose loudness is kept
  };

  Impl(std::size_t skins, std::size_t most_cells, std::size_t sources, const FeltWeights& w,
       bool with_slopes)
      : fine(static_cast<Real>(w.fine)),
        energy_share(static_cast<Real>(w.energy)),
        loudness(static_cast<Real>(w.loudness)),
        quiet(static_cast<Real>(w.quiet)),
        lack(most_cells),
        skin(skins) {
    for (Skin& s : skin) {
      s.pairs.resize(most_cells * sources);
      if (with_slopes) s.slopes.resize(s.pairs.size());
      s.felt.resize(most_cells);
      s.pull.resize(most_cells);
      s.percept.setZero(static_cast<Eigen::Index>(most_cells));
    }
    for (Vector* v : {&energy, &pull, &energy_pull})
      v->setZero(static_cast<Eigen::Index>(most_cells));
    sums.resize(sources);
    line.resize(sources);
    turned.resize(most_cells);
    places.reserve(sources);
    cells.reserve(most_cells);
  }

  Real evaluate(Skin& s);

  FeltKernels<Real> run = kernels<Real>();
  Real fine, energy_share, loudness, quiet;
  RenderLack<Real> lack;
  std::vector<FeltCells::Cell> cells;
  std::vector<FeltSource<Real>> places;
  std::vector<Skin> skin;
  std::vector<Pair> sums;            // of each source
  std::vector<Pair> turned;          // of each cell
  std::vector<Real> line;            // of one cell
  Vector energy, pull, energy_pull;  // e in each cell, ∂loss/∂√e, ∂loss/∂e
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
void FeltLoss<Real>::set_sources(const FeltSkins<Real>& skins,
                                 std::span<const FeltSource<Real>> sources) {
  Impl& d = *impl_;
  d.places.assign(sources.begin(), sources.end());
  for (std::size_t s = 0; s < d.skin.size(); ++s) {
    typename Impl::Skin& to = d.skin[s];
    for (std::size_t x = 0; x < d.cells.size(); ++x) {
      const std::size_t first = x * sources.size();
      d.run.fill(skins[s], static_cast<Real>(d.cells[x].x), static_cast<Real>(d.cells[x].y),
                 sources.data(), sources.size(), &to.pairs[first],
                 to.slopes.empty() ? nullptr : &to.slopes[first]);
    }
  }
}

/// Returns the loss of one skin from its `felt`, and sets its `pull`.
template <class Real>
Real FeltLoss<Real>::Impl::evaluate(Skin& s) {
  const auto n = static_cast<Eigen::Index>(cells.size());
  auto e = energy.head(n), root = s.percept.head(n);
  for (Eigen::Index x = 0; x < n; ++x) {
    e[x] = 0;
    for (const Real part : s.felt[static_cast<std::size_t>(x)].part) e[x] += part * part;
  }
  const Real whole = lack.area().dot(e);
  const auto least = static_cast<Real>(kLeastPercept * kLeastPercept);
  root.array() = (e.array() + least * whole).sqrt();
  s.log_energy = std::log(whole);
  const Real louder = (s.log_energy - s.kept) / 2;
  const Real missing = std::max(-louder - static_cast<Real>(FeltWeights::kSlack), Real(0));
  const Real wanted = loudness + 2 * quiet * missing;
  Real value = lack.of(root, fine, pull.head(n)) - loudness * louder + quiet * missing * missing;
  energy_pull.head(n).setZero();
  if (energy_share > 0) value += energy_share * lack.of(e, Real(0), energy_pull.head(n));
  const Real by_whole = least * (pull.head(n).array() / root.array()).sum() - wanted / whole;
  for (Eigen::Index x = 0; x < n; ++x) {
    const Real factor =
        pull[x] / root[x] + 2 * energy_share * energy_pull[x] + by_whole * lack.area()[x];
    const auto cell = static_cast<std::size_t>(x);
    for (std::size_t i = 0; i < kFeltParts; ++i)
      s.pull[cell].part[i] = factor * s.felt[cell].part[i];
  }
  return value;
}

template <class Real>
Real FeltLoss<Real>::evaluate(std::span<const Real> amplitude, std::span<Real> gradient) {
  Impl& d = *impl_;
  const std::size_t sources = d.places.size();
  const Real share = Real(1) / static_cast<Real>(d.skin.size());
  Real loss = 0;
  for (FeltPair<Real>& sum : d.sums) sum.part.fill(0);
  for (typename Impl::Skin& s : d.skin) {
    d.run.forward(s.pairs.data(), d.cells.size(), sources, amplitude.data(), s.felt.data());
    loss += share * d.evaluate(s);
    d.run.backward(s.pairs.data(), d.cells.size(), sources, s.pull.data(), d.sums.data());
  }
  for (std::size_t j = 0; j < sources; ++j) {
    const auto& part = d.sums[j].part;
    gradient[j] = share * std::accumulate(part.begin(), part.end(), Real(0));
  }
  return loss;
}

template <class Real>
void FeltLoss<Real>::keep_loudness() {
  for (auto& s : impl_->skin) s.kept = s.log_energy;
}

template <class Real>
void FeltLoss<Real>::slide(std::span<const Real> amplitude, std::span<Real> gradient_x,
                           std::span<Real> gradient_y) {
  Impl& d = *impl_;
  const std::size_t sources = d.places.size();
  const Real share = Real(1) / static_cast<Real>(d.skin.size());
  std::fill(gradient_x.begin(), gradient_x.end(), Real(0));
  std::fill(gradient_y.begin(), gradient_y.end(), Real(0));
  for (const typename Impl::Skin& s : d.skin) {
    for (std::size_t x = 0; x < d.cells.size(); ++x) {
      d.run.slide(&s.slopes[x * sources], sources, s.pull[x], d.line.data());
      const auto cx = static_cast<Real>(d.cells[x].x), cy = static_cast<Real>(d.cells[x].y);
      for (std::size_t j = 0; j < sources; ++j) {
        const Real dx = d.places[j].x - cx, dy = d.places[j].y - cy;
        const Real distance = std::max(std::sqrt(dx * dx + dy * dy), Real(kLeastDistance));
        const Real each = share * d.line[j] * amplitude[j] / distance;
        gradient_x[j] += each * dx;
        gradient_y[j] += each * dy;
      }
    }
  }
}

template <class Real>
void FeltLoss<Real>::turn(std::span<const Real> amplitude, int first, std::span<Real> gradient) {
  Impl& d = *impl_;
  constexpr std::size_t kImaginary = kFeltParts / 2;
  for (FeltPair<Real>& sum : d.sums) sum.part.fill(0);
  for (typename Impl::Skin& s : d.skin) {
    // a source that acts later turns its harmonic n by −i n
    for (std::size_t x = 0; x < d.cells.size(); ++x) {
      for (std::size_t n = 0; n < kImaginary; ++n) {
        d.turned[x].part[n] = -s.pull[x].part[n + kImaginary];
        d.turned[x].part[n + kImaginary] = s.pull[x].part[n];
      }
    }
    d.run.backward(s.pairs.data(), d.cells.size(), d.places.size(), d.turned.data(), d.sums.data());
  }
  const Real share = 2 * static_cast<Real>(kPi) / static_cast<Real>(d.skin.size());
  for (std::size_t j = 0; j < d.places.size(); ++j) {
    gradient[j] = 0;
    for (std::size_t n = 0; n < kImaginary; ++n) {
      gradient[j] += share * amplitude[j] * static_cast<Real>(static_cast<std::size_t>(first) + n) *
                     (d.sums[j].part[n] + d.sums[j].part[n + kImaginary]);
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
Real FeltLoss<Real>::loudness() const {
  Real sum = 0;
  for (const auto& s : impl_->skin) sum += s.log_energy;
  return std::exp(sum / (2 * static_cast<Real>(impl_->skin.size())));
}

template class FeltLoss<float>;
template class FeltLoss<double>;

}  // namespace prostm
