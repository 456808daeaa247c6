#include "prostm/plan/detail/fit/phases.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "prostm/core/random.hpp"
#include "prostm/core/units.hpp"
#include "prostm/fields/fields.hpp"
#include "prostm/plan/planner.hpp"
#include "support/load.hpp"

namespace prostm::planning {
namespace {

constexpr double kSpeed = 7e3;  // [mm/s]

/// Returns a loop around a centre, in polar coordinates; radius(angle) [mm].
template <class Radius>
std::vector<Vec2> polar_loop(const Vec2& centre, int samples, Radius radius, double from = 0.0) {
  std::vector<Vec2> loop;
  for (int i = 0; i < samples; ++i) {
    const double a = from + 2.0 * kPi * i / samples;
    loop.push_back(centre + radius(a) * Vec2(std::cos(a), std::sin(a)));
  }
  return loop;
}

std::vector<Vec2> circle(const Vec2& centre, double radius, int samples = 20, double from = 0.0) {
  return polar_loop(
      centre, samples, [&](double) { return radius; }, from);
}

Loops loops_of(const std::vector<std::vector<Vec2>>& list) {
  Loops loops;
  loops.reset(static_cast<int>(list[0].size()), static_cast<int>(list.size()));
  for (int k = 0; k < loops.paths; ++k) {
    for (int i = 0; i < loops.samples; ++i) {
      loops.set_point(i, k, list[static_cast<std::size_t>(k)][static_cast<std::size_t>(i)]);
    }
  }
  return loops;
}

double length(const std::vector<Vec2>& loop) {
  double sum = 0.0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    sum += (loop[(i + 1) % loop.size()] - loop[i]).norm();
  }
  return sum;
}

/// Returns the position of a focal point after this fraction of its lap from its start.
Vec2 at(const std::vector<Vec2>& loop, const LapStart& start, double share) {
  const auto n = static_cast<int>(loop.size());
  double left = (share - std::floor(share)) * length(loop);
  for (int i = 0;; ++i) {
    const Vec2 a = loop[static_cast<std::size_t>(start.sample(i % n, n))];
    const Vec2 b = loop[static_cast<std::size_t>(start.sample((i + 1) % n, n))];
    const double step = (b - a).norm();
    if (left <= step || i > n) return a + std::min(left / step, 1.0) * (b - a);
    left -= step;
  }
}

struct Range {
  double least = std::numeric_limits<double>::max(), most = 0.0;
};
/// Returns the range of the distances between two focal points over 40 ms.
Range distances(const std::vector<std::vector<Vec2>>& list, const LapStarts& starts,
                std::span<const double> periods) {
  Range range;
  for (double t = 0.0; t < 0.04; t += 1e-4) {
    for (std::size_t k = 0; k < list.size(); ++k) {
      for (std::size_t j = 0; j < k; ++j) {
        const double d =
            (at(list[k], starts[k], t / periods[k]) - at(list[j], starts[j], t / periods[j]))
                .norm();
        range.least = std::min(range.least, d);
        range.most = std::max(range.most, d);
      }
    }
  }
  return range;
}

std::vector<Vec2> begun_at(const std::vector<Vec2>& loop, int first, bool reversed) {
  const LapStart start{first, reversed};
  std::vector<Vec2> out;
  for (int i = 0; i < static_cast<int>(loop.size()); ++i) {
    out.push_back(loop[static_cast<std::size_t>(start.sample(i, static_cast<int>(loop.size())))]);
  }
  return out;
}

TEST(Phases, EqualCirclesSideBySideKeepTheDistanceOfTheirCentres) {
  const double period = 2.0 * kPi * 20.0 / kSpeed;
  const std::vector<double> periods(3, period);
  for (int first = 0; first < 20; first += 3) {
    for (const bool reversed : {false, true}) {
      const std::vector<std::vector<Vec2>> list{
          circle({0, 0}, 20.0), begun_at(circle({50, 10}, 20.0), first, reversed),
          begun_at(circle({5, 49}, 20.0), (7 * first + 2) % 20, !reversed)};
      Phases phases;
      const LapStarts starts = phases.choose(loops_of(list), periods);
      const Range range = distances(list, starts, periods);
      EXPECT_NEAR(range.least, std::hypot(5, 49), 1e-4);
      EXPECT_NEAR(range.most, std::hypot(45, 39), 1e-4);
      EXPECT_EQ(starts[1].reversed, reversed);
      EXPECT_EQ(starts[2].reversed, !reversed);
    }
  }
}

TEST(Phases, ConcentricCirclesOfEqualPeriodRunOnOppositeSides) {
  const std::vector<double> periods(2, 0.02);
  const std::vector<std::vector<Vec2>> list{circle({0, 0}, 22.0),
                                            begun_at(circle({0, 0}, 12.0), 4, true)};
  Phases phases;
  const LapStarts starts = phases.choose(loops_of(list), periods);
  const Range range = distances(list, starts, periods);
  EXPECT_NEAR(range.least, 34.0 * std::cos(kPi / 20), 0.01);  // at the chords' midpoints
  EXPECT_NEAR(range.most, 34.0, 0.01);
}

TEST(Phases, StartsDoNotMatterIfOneGainsAWholeLap) {
  const std::vector<std::vector<Vec2>> list{circle({0, 0}, 22.0), circle({30, 0}, 7.0)};
  const Loops loops = loops_of(list);
  std::array<EvenLap, 2> laps;
  for (int k = 0; k < 2; ++k) laps[static_cast<std::size_t>(k)].set(loops, k);
  PhaseCosts costs;
  const auto spread = [&](const std::vector<double>& periods) {
    costs.set(laps, periods);
    float least = std::numeric_limits<float>::max(), most = 0.0F;
    for (int a = 0; a < 20; ++a) {
      const float cost = costs.total(std::vector<int>{3, a});
      least = std::min(least, cost);
      most = std::max(most, cost);
    }
    return static_cast<double>(most / least);
  };
  // two and three laps in 40 ms
  EXPECT_GT(spread({0.02, 0.02}), 100.0);
  EXPECT_LT(spread({0.02, 0.04 / 3.0}), 1.001);
  EXPECT_GT(spread({0.02, 0.018}), 1.5);
}

/// Returns up to 4 loops that do not cross, each within its own square of 50 mm.
std::vector<std::vector<Vec2>> random_loops(Random& random, int paths, int samples) {
  std::vector<std::vector<Vec2>> list;
  for (int k = 0; k < paths; ++k) {
    const Vec2 centre = 50.0 * Vec2(k % 3, k / 3) + Vec2(random.uniform(), random.uniform());
    const double r = random.uniform(6.0, 19.0), u = random.uniform(-0.2, 0.2) * r,
                 v = random.uniform(-0.1, 0.1) * r, turn = random.uniform(0.0, 2.0 * kPi);
    const auto radius = [&](double a) {
      return r + u * std::cos(2.0 * a + turn) + v * std::sin(3.0 * a);
    };
    list.push_back(
        begun_at(polar_loop(centre, samples, radius), random.below(samples), random.below(2) == 1));
  }
  return list;
}

std::vector<double> periods_of(const std::vector<std::vector<Vec2>>& list) {
  std::vector<double> periods;
  for (const std::vector<Vec2>& loop : list) periods.push_back(length(loop) / kSpeed);
  return periods;
}

TEST(EvenLap, SamplesAndArcsConvertIntoEachOtherAcrossTheEnd) {
  // a circle whose last sample is far from the first, or close to it
  for (const double last : {0.87, 0.99}) {
    std::vector<Vec2> loop;
    for (int i = 0; i < 20; ++i) {
      const double a = 2.0 * kPi * last * i / 19.0;
      loop.push_back(20.0 * Vec2(std::cos(a), std::sin(a)));
    }
    EvenLap lap;
    lap.set(loops_of({loop}), 0);
    EXPECT_EQ(lap.nearest_sample(0), 0);
    EXPECT_EQ(lap.nearest_sample(19), last < 0.9 ? 0 : 18);
    EXPECT_EQ(lap.nearest_arc(19), last < 0.9 ? 17 : 0);
    for (int arc = 0; arc < 20; ++arc) {
      const auto i = static_cast<std::size_t>(arc);
      EXPECT_EQ(lap.x[i], lap.x[i + 20]);
      EXPECT_LT(std::abs(std::hypot(lap.x[i], lap.y[i]) - 20.0F), 1.7F);
      EXPECT_NEAR(std::hypot(lap.x[i + 1] - lap.x[i], lap.y[i + 1] - lap.y[i]), 6.2, 0.4);
    }
  }
}

TEST(PhaseCosts, MatchTheStatedEquation) {
  Random random(1);
  for (int round = 0; round < 50; ++round) {
    const int paths = 2 + round % 4, samples = 8 + random.below(40);
    const auto list = random_loops(random, paths, samples);
    std::vector<double> periods(list.size());
    for (double& period : periods) period = random.uniform(0.005, 0.02);
    const Loops loops = loops_of(list);
    std::array<EvenLap, kMaxPaths> laps;
    std::vector<int> arc;
    for (int k = 0; k < paths; ++k) laps[static_cast<std::size_t>(k)].set(loops, k);
    const int arcs = laps[0].arcs;
    EXPECT_EQ(arcs, std::min(samples, 32));
    for (int k = 0; k < paths; ++k) arc.push_back(random.below(arcs));
    PhaseCosts costs;
    costs.set(std::span<const EvenLap>(laps).first(list.size()), periods);

    double expected = 0.0;
    for (std::size_t k = 0; k < list.size(); ++k) {
      for (std::size_t j = 0; j < k; ++j) {
        const LapStart from_k{0, laps[k].reversed}, from_j{0, laps[j].reversed};
        for (int moment = 0; moment < arcs; ++moment) {
          const double gained =
              (moment + 0.5) / arcs * 0.04 * (1.0 / periods[k] - 1.0 / periods[j]);
          const double shift = std::floor((gained - std::floor(gained)) * arcs);
          for (int i = 0; i < arcs; ++i) {
            const Vec2 d = at(list[k], from_k, (i + arc[k] + shift) / arcs) -
                           at(list[j], from_j, static_cast<double>(i + arc[j]) / arcs);
            expected += std::pow(d.norm(), -8.0);
          }
        }
      }
    }
    EXPECT_NEAR(static_cast<double>(costs.total(arc)) / expected, 1.0, 1e-3);
  }
}

TEST(PhaseCosts, SearchIsNearlyAsGoodAsTryingAllStarts) {
  constexpr int kSamples = 12;
  Random random(2);
  double worst = 1.0, product = 0.0;
  const auto count = static_cast<int>(test::reduced(1000));
  for (int round = 0; round < count; ++round) {
    const int paths = 2 + round % 3;
    const auto list = random_loops(random, paths, kSamples);
    std::vector<double> periods = periods_of(list);
    if (round % 2 == 0) periods.assign(list.size(), 0.02);
    const Loops loops = loops_of(list);
    std::array<EvenLap, kMaxPaths> laps;
    for (int k = 0; k < paths; ++k) laps[static_cast<std::size_t>(k)].set(loops, k);
    PhaseCosts costs;
    costs.set(std::span<const EvenLap>(laps).first(list.size()), periods);

    std::array<int, kMaxPaths> found{};
    costs.search(std::span<int>(found).first(list.size()));
    float least = std::numeric_limits<float>::max();
    const int all = static_cast<int>(std::pow(kSamples, paths - 1));
    for (int which = 0; which < all; ++which) {
      std::vector<int> arc{0};
      for (int rest = which; arc.size() < list.size(); rest /= kSamples)
        arc.push_back(rest % kSamples);
      least = std::min(least, costs.total(arc));
    }
    const double ratio = std::pow(static_cast<double>(least / costs.total(found)), 1.0 / 8.0);
    EXPECT_GT(ratio, paths == 2 ? 1.0 - 1e-4 : 0.95);  // a single free start is found exactly
    worst = std::min(worst, ratio);
    product += std::log(ratio);
  }
  RecordProperty("worst_distance_over_best", std::to_string(worst));
  EXPECT_GT(std::exp(product / count), 0.995);
}

/// Cost of starts, as a distance over that of other starts: above 1 if they keep farther apart.
double distance_over(const LapStarts& starts, const LapStarts& others, const Loops& loops,
                     std::span<const double> periods) {
  std::array<EvenLap, kMaxPaths> laps;
  std::vector<int> arc, other;
  for (int k = 0; k < loops.paths; ++k) {
    EvenLap& lap = laps[static_cast<std::size_t>(k)];
    lap.set(loops, k);
    arc.push_back(lap.nearest_arc(starts[static_cast<std::size_t>(k)].first));
    other.push_back(lap.nearest_arc(others[static_cast<std::size_t>(k)].first));
  }
  PhaseCosts costs;
  costs.set(std::span<const EvenLap>(laps).first(arc.size()), periods);
  return std::pow(static_cast<double>(costs.total(other) / costs.total(arc)), 1.0 / 8.0);
}

TEST(Phases, AreIndependentOfPositionAndAsGoodAtAnotherScale) {
  Random random(3);
  int elsewhere = 0;
  for (int round = 0; round < 300; ++round) {
    auto list = random_loops(random, 2 + round % 4, 20);
    // on a grid of binary fractions, so that the copies below are exact
    for (std::vector<Vec2>& loop : list) {
      for (Vec2& x : loop) x = (64.0 * x).array().round() / 64.0;
    }
    const std::vector<double> periods = periods_of(list);
    auto moved = list, larger = list;
    for (std::size_t k = 0; k < list.size(); ++k) {
      for (std::size_t i = 0; i < list[k].size(); ++i) {
        moved[k][i] += Vec2(-128.0, 512.0);
        larger[k][i] *= 2.0;
      }
    }
    Phases a, b, c;
    const LapStarts starts = a.choose(loops_of(list), periods);
    const LapStarts of_moved = b.choose(loops_of(moved), periods);
    const LapStarts of_larger = c.choose(loops_of(larger), periods);
    for (std::size_t k = 0; k < list.size(); ++k) {
      elsewhere += starts[k].first != of_moved[k].first ? 1 : 0;
      EXPECT_EQ(starts[k].reversed, of_moved[k].reversed);
      EXPECT_EQ(starts[k].reversed, of_larger[k].reversed);
    }
    // points between corners round differently at another position, which decides between nearly
    // equal starts
    EXPECT_NEAR(distance_over(of_moved, starts, loops_of(list), periods), 1.0, 1e-3);
    // the term that keeps costs finite does not scale, so the search may descend to another minimum
    EXPECT_GT(distance_over(of_larger, starts, loops_of(list), periods), 0.95);
  }
  EXPECT_LE(elsewhere, 5);  // of 1050
}

TEST(Phases, StartsAreKeptUntilOthersAreWorthwhile) {
  const std::vector<double> periods(2, 0.02);
  const auto beside = [](double x, double y) {
    return loops_of({circle({x, y}, 20.0), circle({x + 46.0, y}, 20.0, 20, 1.0)});
  };
  Phases phases;
  const LapStarts first = phases.choose(beside(0.0, 0.0), periods);
  // the starts follow moving loops, or targets with a moving origin
  for (int step = 1; step < 40; ++step) {
    if (step % 2 == 0) phases.move(Vec2(30.0, 0.0));
    const double x = 3.0 * step + (step % 2 == 0 ? 30.0 : 0.0);
    if (step % 2 == 1 && step > 1) phases.move(Vec2(-30.0, 0.0));
    const LapStarts next = phases.choose(beside(x, -2.0 * step), periods);
    EXPECT_EQ(next[0].first, first[0].first) << step;
    EXPECT_EQ(next[1].first, first[1].first) << step;
  }

  // one loop inside the other: equal angles are no longer far apart
  Phases other;
  const std::vector<std::vector<Vec2>> near{circle({0, 0}, 20.0), circle({46, 0}, 20.0)};
  const std::vector<std::vector<Vec2>> within{circle({0, 0}, 20.0), circle({0, 0}, 8.0)};
  other.choose(loops_of(near), periods);
  const LapStarts apart = other.choose(loops_of(within), periods);
  EXPECT_GT(distances(within, apart, periods).least, 27.0);

  // a new loop next to a continuing one gets its start
  Phases second;
  second.choose(loops_of({begun_at(circle({0, 0}, 20.0), 5, false), circle({300, 0}, 20.0)}),
                periods);
  const LapStarts joined =
      second.choose(loops_of({circle({0, 0}, 20.0), circle({42, 0}, 20.0)}), periods);
  EXPECT_EQ(joined[0].first, 5);
  EXPECT_EQ(joined[1].first, 5);

  // starts are kept if others gain little; after forget() they are chosen again
  Phases third;
  third.choose(loops_of({begun_at(circle({0, 0}, 20.0), 5, false), circle({300, 0}, 20.0)}),
               periods);
  const auto far = loops_of({circle({0, 0}, 20.0), circle({301, 0}, 20.0)});
  EXPECT_EQ(third.choose(far, periods)[0].first, 5);
  third.forget();
  EXPECT_EQ(third.choose(far, periods)[0].first, 0);
}

TEST(Phases, RandomLoopsOfAnyNumberGetStartsNoWorseThanTheirOwn) {
  const std::uint64_t count = test::reduced(100'000);
  Phases phases;
  Random random(4);
  double gained = 0.0;
  for (std::uint64_t round = 0; round < count; ++round) {
    const int paths = 1 + static_cast<int>(round % kMaxPaths);
    const int samples = round % 50 == 0 ? 8 + random.below(57) : 8 + random.below(13);
    auto list = random_loops(random, paths, samples);
    // some loops are collapsed to a line or a point
    if (round % 17 == 0) {
      for (Vec2& x : list[0]) x.y() = 0.0;
    }
    if (round % 31 == 0) list.back().assign(list.back().size(), Vec2(1.0, 2.0));
    const Loops loops = loops_of(list);
    std::vector<double> periods = periods_of(list);
    for (double& period : periods) period = std::max(period, 1e-3);
    if (round % 3 == 0) phases.forget();
    const LapStarts starts = phases.choose(loops, periods);
    ASSERT_EQ(starts.size(), list.size());
    std::array<EvenLap, kMaxPaths> laps;
    std::vector<int> own, chosen;
    for (int k = 0; k < paths; ++k) {
      EvenLap& lap = laps[static_cast<std::size_t>(k)];
      const LapStart& start = starts[static_cast<std::size_t>(k)];
      lap.set(loops, k);
      ASSERT_GE(start.first, 0);
      ASSERT_LT(start.first, samples);
      ASSERT_EQ(start.reversed, lap.reversed);
      own.push_back(0);
      chosen.push_back(lap.nearest_arc(start.first));
    }
    if (paths == 1 || samples > 32 || round % 3 != 0) continue;
    PhaseCosts costs;
    costs.set(std::span<const EvenLap>(laps).first(list.size()), periods);
    // starting at a sample, next to the chosen arc, may cost a little
    const auto ratio = static_cast<double>(costs.total(own) / costs.total(chosen));
    ASSERT_GT(ratio, 0.5) << round;
    gained += std::log(ratio) / 8.0;
  }
  EXPECT_GT(gained, 0.0);
}

}  // namespace
}  // namespace prostm::planning
