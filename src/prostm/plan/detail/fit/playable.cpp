#include "prostm/plan/detail/fit/playable.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace prostm::planning {
namespace {

constexpr float kStiffness = 300.0F;  // μ: a pull of 1 leaves a step too large by 1/600
constexpr float kInner = 0.98F;  // share of a bound where the cost begins, so that the bound holds
constexpr float kDamping = 1e-3F;     // damping of a system, relative to its diagonal and absolute
constexpr float kNotSilent = 1.001F;  // factor on the least non-silent √p, a margin for rounding
constexpr int kNewtonSteps = 5;
// Where (P18) is enforced: at the samples only, where it is linear in √p, as Newton's method needs;
// or also half-way between them, since p, not √p, is linear along a segment.
constexpr float kAtSamples = 0.0F, kHalfWay = 0.5F;
constexpr float kSettled = 5e-3F;  // change of √p below which the iteration ends

/// One sample of every path, as the lanes of a vector.
template <int kLanes>
using Lanes = Eigen::Array<float, kLanes, 1>;

template <int kLanes>
auto at(NodeArray& values, std::size_t node) {
  return Eigen::Map<Lanes<kLanes>, Eigen::Aligned16>(values.data() + node);
}
template <int kLanes>
auto at(const NodeArray& values, std::size_t node) {
  return Eigen::Map<const Lanes<kLanes>, Eigen::Aligned16>(values.data() + node);
}
template <int kLanes>
auto lanes_of(const std::array<float, kMaxPaths>& values) {
  return Eigen::Map<const Lanes<kLanes>, Eigen::Aligned16>(values.data());
}

/// Square root of each value. Eigen's own vector square root is an estimate that differs between
/// processors, and traps at 0.
template <typename Values>
auto root_of(const Values& values) {
  return values.unaryExpr([](float value) { return std::sqrt(value); });
}

/// Calls f<kLanes>() with the number of lanes of `loops`.
template <typename F>
auto with_lanes(const Loops& loops, const F& f) {
  return loops.lanes == 4 ? f.template operator()<4>() : f.template operator()<8>();
}

template <int kLanes>
class Loop {
 public:
  /// @param where kAtSamples or kHalfWay. @param share factor on the slope bounds.
  Loop(const Loops& loops, const PlayBounds& bounds, float where, float share = 1.0F)
      : n_(loops.nodes()), where_(where) {
    const Lanes<kLanes> slope = share * lanes_of<kLanes>(bounds.slope);
    for (std::size_t a = 0; a < n_; a += kLanes) {
      const std::size_t b = after(a);
      at<kLanes>(step_, a) =
          slope * root_of((at<kLanes>(loops.x, b) - at<kLanes>(loops.x, a)).square() +
                          (at<kLanes>(loops.y, b) - at<kLanes>(loops.y, a)).square());
    }
  }

  std::size_t after(std::size_t a) const { return a + kLanes < n_ ? a + kLanes : 0; }
  std::size_t previous(std::size_t a) const { return a > 0 ? a - kLanes : n_ - kLanes; }
  std::size_t nodes() const { return n_; }
  /// Largest |√p_b − √p_a| of the segment that begins at a.
  auto step(std::size_t a) const { return at<kLanes>(step_, a); }

  /// Computes √p.
  void take_roots(const NodeArray& pressure, NodeArray& root) const {
    for (std::size_t a = 0; a < n_; a += kLanes)
      at<kLanes>(root, a) = root_of(at<kLanes>(pressure, a));
  }

  bool is_too_steep(const NodeArray& root) const {
    Lanes<kLanes> worst = Lanes<kLanes>::Constant(-1.0F);
    for (std::size_t a = 0; a < n_; a += kLanes) {
      const auto u = at<kLanes>(root, a), v = at<kLanes>(root, after(a));
      worst = worst.max(u.max(v) - above(u.min(v), step(a)));
    }
    return (worst > 0.0F).any();
  }

  /// Lowers `root` to the largest values that do not exceed it and are nowhere too steep.
  void lower(NodeArray& root) const {
    spread(root, [&](const Lanes<kLanes>& value, const Lanes<kLanes>& beside, std::size_t segment) {
      return value.min(above(beside, step(segment))).eval();
    });
  }

  /// Raises `root` to the smallest values that are not below it and are nowhere too steep.
  void raise(NodeArray& root) const {
    spread(root, [&](const Lanes<kLanes>& value, const Lanes<kLanes>& beside, std::size_t segment) {
      return value.max(below(beside, step(segment))).eval();
    });
  }

  /// Sets `root` to the mean of lower() and raise(): of all values that are not too steep, those
  /// with the least maximum difference from `root`.
  void flatten(NodeArray& root) const {
    alignas(64) NodeArray raised;
    std::copy_n(root.begin(), n_, raised.begin());
    raise(raised);
    lower(root);
    for (std::size_t a = 0; a < n_; a += kLanes) {
      at<kLanes>(root, a) = 0.5F * (at<kLanes>(root, a) + at<kLanes>(raised, a));
    }
  }

  /// Raises samples within two of a non-silent one to `least`, then their neighbours where that is
  /// too steep.
  void raise_from_silence(const Lanes<kLanes>& least, NodeArray& root) const {
    alignas(64) NodeArray before;
    std::copy_n(root.begin(), n_, before.begin());
    const auto loudest = [&](std::size_t a, std::size_t b) {
      return at<kLanes>(before, a).max(at<kLanes>(before, b)).eval();
    };
    for (std::size_t a = 0; a < n_; a += kLanes) {
      const std::size_t left = previous(a), right = after(a);
      const Lanes<kLanes> around = loudest(left, right).max(loudest(previous(left), after(right)));
      at<kLanes>(root, a) =
          (around >= least).select(at<kLanes>(root, a).max(least), at<kLanes>(root, a));
    }
    raise(root);
  }

 private:
  /// Returns the highest √p allowed next to `low`. Between the two, the root of a linear p rises
  /// fastest near the lower one: up to half-way it may rise by half a step.
  Lanes<kLanes> above(const Lanes<kLanes>& low, const Lanes<kLanes>& step) const {
    return root_of((low + step).square() - where_ * step.square());
  }
  /// Returns the lowest √p allowed next to `high`.
  Lanes<kLanes> below(const Lanes<kLanes>& high, const Lanes<kLanes>& step) const {
    return (root_of(high.square() + where_ * step.square()) - step).max(0.0F);
  }
  /// Sets each value to bound(value, its neighbour, the segment between). Passes twice in each
  /// direction, since a loop has no end to start from.
  template <typename Bound>
  void spread(NodeArray& root, const Bound& bound) const {
    for (std::size_t k = 0, a = 0; k < 2 * n_; k += kLanes, a = after(a))
      at<kLanes>(root, after(a)) = bound(at<kLanes>(root, after(a)), at<kLanes>(root, a), a);
    for (std::size_t k = 0, a = previous(0); k < 2 * n_; k += kLanes, a = previous(a))
      at<kLanes>(root, a) = bound(at<kLanes>(root, a), at<kLanes>(root, after(a)), a);
  }

  std::size_t n_;
  float where_;
  alignas(64) NodeArray step_;
};

/// A cyclic tridiagonal system for each lane, positive definite.
template <int kLanes>
struct CyclicSystem {
  alignas(64) NodeArray diagonal, off, right;  // off: coupling to the next node
  alignas(64) NodeArray last;                  // coupling to the last node during elimination

  /// Keeps a nearly singular system positive definite despite rounding, and leaves values unchanged
  /// that no equation depends on.
  void dampen(std::size_t n) {
    for (std::size_t a = 0; a < n; a += kLanes)
      at<kLanes>(diagonal, a) = (1.0F + kDamping) * at<kLanes>(diagonal, a) + kDamping;
  }

  /// Solves the system; the solution is in `right`. The nodes are eliminated in order; each is
  /// coupled to the next one and, across the end of the loop, to the last.
  void solve(std::size_t n) {
    const std::size_t end = n - kLanes, before_end = end - kLanes;
    Lanes<kLanes> coupling = at<kLanes>(off, end), end_diagonal = at<kLanes>(diagonal, end),
                  end_right = at<kLanes>(right, end);
    for (std::size_t a = 0; a < end; a += kLanes) {
      if (a == before_end) {
        coupling += at<kLanes>(off, a);
        at<kLanes>(off, a).setZero();
      }
      const Lanes<kLanes> inverse = at<kLanes>(diagonal, a).inverse();
      const Lanes<kLanes> share = at<kLanes>(off, a) * inverse, end_share = coupling * inverse;
      at<kLanes>(diagonal, a) = inverse;
      at<kLanes>(last, a) = coupling;
      end_diagonal -= end_share * coupling;
      end_right -= end_share * at<kLanes>(right, a);
      if (a < before_end) {
        at<kLanes>(diagonal, a + kLanes) -= share * at<kLanes>(off, a);
        at<kLanes>(right, a + kLanes) -= share * at<kLanes>(right, a);
        coupling = -share * coupling;
      }
    }
    const Lanes<kLanes> tail = end_right / end_diagonal;
    at<kLanes>(right, end) = tail;
    for (std::size_t a = end; a > 0;) {
      a -= kLanes;
      at<kLanes>(right, a) =
          (at<kLanes>(right, a) - at<kLanes>(off, a) * at<kLanes>(right, a + kLanes) -
           at<kLanes>(last, a) * tail) *
          at<kLanes>(diagonal, a);
    }
  }
};

/// Sets up the system for a step: gradient and curvature of a quarter of the cost with respect to
/// √p. Parts of the curvature that may be negative are omitted.
template <int kLanes>
void linearise(const Loop<kLanes>& loop, const PressureEquations& equations, const NodeArray& root,
               CyclicSystem<kLanes>& system) {
  const std::size_t n = loop.nodes();
  for (std::size_t a = 0, before = n - kLanes; a < n; before = a, a += kLanes) {
    const std::size_t b = loop.after(a);
    const auto u = at<kLanes>(root, a), v = at<kLanes>(root, b), t = at<kLanes>(root, before);
    const Lanes<kLanes> pull = at<kLanes>(equations.diagonal, a) * u.square() +
                               at<kLanes>(equations.after, a) * v.square() +
                               at<kLanes>(equations.after, before) * t.square() -
                               at<kLanes>(equations.right, a);
    at<kLanes>(system.right, a) = -u * pull;
    at<kLanes>(system.diagonal, a) =
        2.0F * u.square() * at<kLanes>(equations.diagonal, a) + pull.max(0.0F);
    at<kLanes>(system.off, a) = 2.0F * u * v * at<kLanes>(equations.after, a);
  }
  for (std::size_t a = 0; a < n; a += kLanes) {
    const std::size_t b = loop.after(a);
    const Lanes<kLanes> rise = at<kLanes>(root, b) - at<kLanes>(root, a);
    const Lanes<kLanes> excess = (rise.abs() - loop.step(a)).max(0.0F);
    const Lanes<kLanes> stiff =
        (excess > 0.0F).select(Lanes<kLanes>::Constant(0.5F * kStiffness), 0.0F);
    const Lanes<kLanes> force = stiff * (rise < 0.0F).select(-excess, excess);
    at<kLanes>(system.right, a) += force;
    at<kLanes>(system.right, b) -= force;
    at<kLanes>(system.diagonal, a) += stiff;
    at<kLanes>(system.diagonal, b) += stiff;
    at<kLanes>(system.off, a) -= stiff;
  }
}

/// Removes nodes from the system that are at a bound and would move beyond it.
template <int kLanes>
void hold_at_bounds(const Loop<kLanes>& loop, const Lanes<kLanes>& most, const NodeArray& root,
                    CyclicSystem<kLanes>& system) {
  const std::size_t n = loop.nodes();
  const auto is_free = [&](std::size_t a) -> Lanes<kLanes> {
    const auto u = at<kLanes>(root, a);
    const auto step = at<kLanes>(system.right, a);
    return ((u <= 0.0F && step <= 0.0F) || (u >= most && step >= 0.0F))
        .select(Lanes<kLanes>::Zero(), Lanes<kLanes>::Constant(1.0F));
  };
  const Lanes<kLanes> first = is_free(0);
  Lanes<kLanes> own = first;
  for (std::size_t a = 0; a < n; a += kLanes) {
    const std::size_t b = loop.after(a);
    const Lanes<kLanes> next = b > 0 ? is_free(b) : first;
    at<kLanes>(system.off, a) *= own * next;
    at<kLanes>(system.right, a) *= own;
    own = next;
  }
}

template <int kLanes>
void soften_lanes(const Loops& loops, const PlayBounds& bounds, const PressureEquations& equations,
                  NodeArray& pressure) {
  const Loop<kLanes> loop(loops, bounds, kAtSamples, kInner);
  const std::size_t n = loop.nodes();
  alignas(64) NodeArray root;
  loop.take_roots(pressure, root);
  if (!loop.is_too_steep(root)) return;
  loop.flatten(root);
  const Lanes<kLanes> most = root_of(lanes_of<kLanes>(bounds.most));
  CyclicSystem<kLanes> system;
  for (int k = 0; k < kNewtonSteps; ++k) {
    linearise(loop, equations, root, system);
    hold_at_bounds(loop, most, root, system);
    system.dampen(n);
    system.solve(n);
    Lanes<kLanes> largest = Lanes<kLanes>::Zero();
    for (std::size_t a = 0; a < n; a += kLanes) {
      const auto u = at<kLanes>(root, a);
      const Lanes<kLanes> moved = (u + at<kLanes>(system.right, a)).max(0.0F).min(most);
      largest = largest.max((moved - u).abs());
      at<kLanes>(root, a) = moved;
    }
    if (largest.maxCoeff() < kSettled) break;
  }
  for (std::size_t a = 0; a < n; a += kLanes) {
    at<kLanes>(pressure, a) = at<kLanes>(root, a).square();
  }
}

}  // namespace

PlayBounds PlayBounds::all(float most, float slope, float least) {
  PlayBounds bounds;
  bounds.most.fill(most);
  bounds.slope.fill(slope);
  bounds.least.fill(least);
  return bounds;
}

void soften(const Loops& loops, const PlayBounds& bounds, const PressureEquations& equations,
            NodeArray& pressure) {
  with_lanes(loops,
             [&]<int kLanes>() { soften_lanes<kLanes>(loops, bounds, equations, pressure); });
}

float steepness_cost(const Loops& loops, const PlayBounds& bounds, const NodeArray& pressure,
                     NodeArray& gradient_x, NodeArray& gradient_y) {
  return with_lanes(loops, [&]<int kLanes>() {
    const std::size_t n = loops.nodes();
    const auto slope = lanes_of<kLanes>(bounds.slope);
    Lanes<kLanes> cost = Lanes<kLanes>::Zero();
    for (std::size_t a = 0; a < n; a += kLanes) {
      const std::size_t b = a + kLanes < n ? a + kLanes : 0;
      const Lanes<kLanes> ex = at<kLanes>(loops.x, b) - at<kLanes>(loops.x, a),
                          ey = at<kLanes>(loops.y, b) - at<kLanes>(loops.y, a);
      const Lanes<kLanes> length = root_of(ex.square() + ey.square());
      const Lanes<kLanes> rise =
          (root_of(at<kLanes>(pressure, b)) - root_of(at<kLanes>(pressure, a))).abs();
      const Lanes<kLanes> excess = (rise - kInner * slope * length).max(0.0F);
      cost += kStiffness * excess.square();
      // the allowed rise grows with the length of the segment
      const Lanes<kLanes> pull = 2.0F * kStiffness * kInner * slope * excess / length.max(1e-6F);
      at<kLanes>(gradient_x, a) += pull * ex;
      at<kLanes>(gradient_y, a) += pull * ey;
      at<kLanes>(gradient_x, b) -= pull * ex;
      at<kLanes>(gradient_y, b) -= pull * ey;
    }
    return cost.sum();
  });
}

void make_playable(const Loops& loops, const PlayBounds& bounds, NodeArray& pressure) {
  with_lanes(loops, [&]<int kLanes>() {
    const Loop<kLanes> loop(loops, bounds, kHalfWay);
    const Lanes<kLanes> least = kNotSilent * root_of(lanes_of<kLanes>(bounds.least)),
                        most = root_of(lanes_of<kLanes>(bounds.most));
    alignas(64) NodeArray root;
    loop.take_roots(pressure, root);
    if (loop.is_too_steep(root)) loop.flatten(root);
    loop.raise_from_silence((least <= most).select(least, 0.0F), root);
    for (std::size_t a = 0; a < loop.nodes(); a += kLanes)
      at<kLanes>(pressure, a) = at<kLanes>(root, a).square();
  });
}

}  // namespace prostm::planning
