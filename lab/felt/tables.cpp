#include "felt/tables.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "prostm/plan/plan_settings.hpp"

namespace prostm::bench {
namespace {

/// Values of one way, a field each.
template <class Value>
std::vector<double> each(const std::vector<Judged>& way, Value value) {
  std::vector<double> out;
  for (const Judged& one : way) out.push_back(value(one));
  return out;
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double skill(const Judged& one) {
  return one.felt.skill_8;
}

void print_felt(const JudgedSet& set) {
  fmt::print(
      "\n{}, {} fields: what is felt, √e of (S7) on the skin \"{}\". lack: 1 - S_8.5 over that of "
      "{}\n{:<20} {:>6} {:>16} {:>6} {:>6} {:>6} {:>6} {:>6} {:>7}  {}\n",
      set.name, set.fields.size(), set.skins[0], set.ways[0], "", "S_8.5", "more", "lack", "worse",
      "S_0", "corr.", "overl.", "worst", "on");
  for (std::size_t w = 0; w < set.ways.size(); ++w) {
    const std::vector<Judged>& way = set.results[w];
    const Compared c = compare_shape(set, w);
    fmt::print(
        "{:<20} {:>6.3f} {:>+7.3f} ± {:>6.3f} {:>6.2f} {:>6} {:>6.3f} {:>6.3f} {:>6.3f} {:>7.2f}",
        set.ways[w], c.mean, c.more, c.error, c.lack, c.worse,
        mean(each(way, [](const Judged& j) { return j.felt.skill_0; })),
        mean(each(way, [](const Judged& j) { return j.felt.correlation; })),
        mean(each(way, [](const Judged& j) { return j.felt.overlap; })), c.worst);
    fmt::print("  {}\n", w == 0 ? "" : set.fields[c.worst_field]);
  }
}

void print_readouts(const JudgedSet& set) {
  fmt::print(
      "\n{}: S_8.5 of other readouts and of the envelope; loudness over that of {}\n{:<20} {:>7} "
      "{:>8} {:>7} {:>7} {:>8} {:>8} {:>6} {:>6} {:>7} {:>7} {:>5}\n",
      set.name, set.ways[0], "", "energy", "velocity", "peak", "displ.", "envelope", "√E µm",
      "mean", "least", "ghosts", "cross.", "long");
  for (std::size_t w = 0; w < set.ways.size(); ++w) {
    const std::vector<Judged>& way = set.results[w];
    const auto of = [&](Readout r) {
      return mean(
          each(way, [r](const Judged& j) { return j.readout[static_cast<std::size_t>(r)]; }));
    };
    std::vector<double> louder;
    for (std::size_t f = 0; f < way.size(); ++f)
      louder.push_back(way[f].intensity / set.results[0][f].intensity);
    const auto sum = [&](int Judged::*count) {
      int total = 0;
      for (const Judged& one : way) total += one.*count;
      return total;
    };
    fmt::print(
        "{:<20} {:>7.3f} {:>8.3f} {:>7.3f} {:>7.3f} {:>8.3f} {:>8.3f} {:>6.2f} {:>6.2f} {:>7} "
        "{:>7} "
        "{:>5}\n",
        set.ways[w], of(Readout::Energy), of(Readout::Velocity), of(Readout::Peak),
        of(Readout::Displacement),
        mean(each(way, [](const Judged& j) { return j.envelope.skill_8; })),
        1e6 * mean(each(way, [](const Judged& j) { return j.intensity; })), mean(louder),
        *std::min_element(louder.begin(), louder.end()), sum(&Judged::ghosts),
        sum(&Judged::crossings), sum(&Judged::long_paths));
  }
}

/// Prints shape and strength side by side.
void print_strength(const JudgedSet& set) {
  fmt::print(
      "\n{}: felt shape and strength, the largest √e; ratios of means to those of {}\n{:<20} {:>6} "
      "{:>6} {:>9} {:>6} {:>6} {:>13}\n",
      set.name, set.ways[0], "", "S_8.5", "lack", "strongest", "ratio", "least", "worse in both");
  for (std::size_t w = 0; w < set.ways.size(); ++w) {
    const Compared shape = compare_shape(set, w);
    const Strength strength = compare_strength(set, w);
    fmt::print("{:<20} {:>6.3f} {:>6.2f} {:>6.3f} µm {:>6.2f} {:>6.2f} {:>13}\n", set.ways[w],
               shape.mean, shape.lack, 1e6 * strength.mean, strength.ratio, strength.least,
               strength.worse_in_both);
  }
}

/// A line of names and, for each way, a line of numbers from `cell(way, column)`.
template <class Cell>
void print_columns(const JudgedSet& set, const std::vector<std::string>& columns, Cell cell) {
  fmt::print("{:<20}", "");
  for (const std::string& column : columns) fmt::print(" {:>18}", column);
  fmt::print("\n");
  for (std::size_t w = 0; w < set.ways.size(); ++w) {
    fmt::print("{:<20}", set.ways[w]);
    for (std::size_t c = 0; c < columns.size(); ++c) fmt::print(" {:>18}", cell(w, c));
    fmt::print("\n");
  }
}

void print_skins(const JudgedSet& set) {
  fmt::print("\n{}: S_8.5 on each skin, with the lack over that of {} there, and its worst\n",
             set.name, set.ways[0]);
  print_columns(set, set.skins, [&](std::size_t w, std::size_t s) {
    const auto on_skin = [s](const Judged& j) { return j.skin[s]; };
    const Compared c = compare(each(set.results[w], on_skin), each(set.results[0], on_skin));
    return fmt::format("{:.3f} ({:.2f}, {:.2f})", c.mean, c.lack, c.worst);
  });
}

/// Prints shape and strength by each percept model and control of the published experiments: the
/// lack and the ratio of strengths to those of the first way, and how much more (P25) is, with the
/// default weight and without spill.
void print_models(const JudgedSet& set) {
  const double weight = PlanSettings().strength_weight;
  fmt::print(
      "\n{}: S_8.5 by each percept model, with the strength over that of {}, and the cost "
      "above it\n",
      set.name, set.ways[0]);
  std::vector<std::string> names(kNames<PerceptModel>.begin(), kNames<PerceptModel>.end());
  print_columns(set, names, [&](std::size_t w, std::size_t m) {
    const auto shape = [m](const Judged& j) { return j.model_skill[m]; };
    const auto strength = [m](const Judged& j) { return std::log(j.model_strength[m]); };
    const double more = mean(each(set.results[w], shape)) - mean(each(set.results[0], shape)),
                 louder =
                     mean(each(set.results[w], strength)) - mean(each(set.results[0], strength));
    return fmt::format("{:.3f} {:.2f} {:+.3f}", mean(each(set.results[w], shape)), std::exp(louder),
                       -more - weight * louder);
  });
}

void print_disturbances(const JudgedSet& set) {
  if (set.disturbances.empty()) return;
  fmt::print(
      "\n{}: S_8.5 under disturbances, with the share of the gain that is left over {} disturbed "
      "alike, and undisturbed\n",
      set.name, set.ways[0]);
  const double first = mean(each(set.results[0], skill));
  print_columns(set, set.disturbances, [&](std::size_t w, std::size_t d) {
    if (set.results[w][0].disturbed.empty()) return std::string("-");
    const auto disturbed = [d](const Judged& j) { return j.disturbed[d]; };
    const double own = mean(each(set.results[w], disturbed));
    const Compared calm = compare_shape(set, w);
    const double gain = calm.more;
    if (gain <= 2.0 * calm.error) return fmt::format("{:.3f}", own);
    return fmt::format("{:.3f} ({:.2f}, {:.2f})", own,
                       (own - mean(each(set.results[0], disturbed))) / gain, (own - first) / gain);
  });
}

}  // namespace

Compared compare(const std::vector<double>& own, const std::vector<double>& first) {
  Compared out;
  out.mean = mean(own);
  out.more = out.mean - mean(first);
  out.lack = (1.0 - out.mean) / (1.0 - mean(first));
  out.worst = 0.0;
  double squares = 0.0;
  for (std::size_t f = 0; f < own.size(); ++f) {
    const double more = own[f] - first[f], ratio = (1.0 - own[f]) / (1.0 - first[f]);
    squares += (more - out.more) * (more - out.more);
    out.worse += more < 0.0 ? 1 : 0;
    if (ratio > out.worst) {
      out.worst = ratio;
      out.worst_field = f;
    }
  }
  const auto n = static_cast<double>(own.size());
  if (own.size() > 1) out.error = std::sqrt(squares / (n - 1.0) / n);
  return out;
}

Compared compare_shape(const JudgedSet& set, std::size_t way) {
  return compare(each(set.results[way], skill), each(set.results[0], skill));
}

Strength compare_strength(const JudgedSet& set, std::size_t way) {
  const auto strongest = [](const Judged& j) { return j.strongest; };
  const std::vector<double> own = each(set.results[way], strongest),
                            first = each(set.results[0], strongest);
  Strength out{.mean = mean(own), .ratio = mean(own) / mean(first), .least = own[0] / first[0]};
  for (std::size_t f = 0; f < own.size(); ++f) {
    out.least = std::min(out.least, own[f] / first[f]);
    const bool weaker = own[f] < first[f],
               poorer = skill(set.results[way][f]) < skill(set.results[0][f]);
    out.worse_in_both += weaker && poorer ? 1 : 0;
  }
  return out;
}

JudgedSet pooled(const std::string& name, const std::vector<JudgedSet>& sets) {
  JudgedSet out = sets.at(0);
  out.name = name;
  for (std::size_t s = 1; s < sets.size(); ++s) {
    for (const std::string& field : sets[s].fields) out.fields.push_back(field);
    for (std::size_t w = 0; w < out.ways.size(); ++w) {
      out.results[w].insert(out.results[w].end(), sets[s].results[w].begin(),
                            sets[s].results[w].end());
    }
  }
  return out;
}

void print_tables(const JudgedSet& set) {
  print_felt(set);
  print_strength(set);
  print_readouts(set);
  print_skins(set);
  print_models(set);
  print_disturbances(set);
}

void print_each(const JudgedSet& set) {
  fmt::print("\n{}: S_8.5 of what is felt, and the largest √e in µm\n", set.name);
  for (std::size_t f = 0; f < set.fields.size(); ++f) {
    fmt::print("{:<28}", set.fields[f]);
    for (const std::vector<Judged>& way : set.results)
      fmt::print(" {:>6.3f} {:>5.2f}", way[f].felt.skill_8, 1e6 * way[f].strongest);
    fmt::print("\n");
  }
}

void add_rows(const JudgedSet& set, std::vector<Row>& rows) {
  const auto add = [&](std::size_t w, const std::string& what, const std::string& unit,
                       auto value) {
    Distribution own, first;
    for (const Judged& one : set.results[w]) own.add(value(one));
    for (const Judged& one : set.results[0]) first.add(value(one));
    rows.push_back({fmt::format("felt/{}/{}/{}", set.name, set.ways[w], what), unit, own.summary(),
                    w == 0 ? "" : set.ways[0], w == 0 ? 0.0 : first.summary().p50});
  };
  for (std::size_t w = 0; w < set.ways.size(); ++w) {
    add(w, "1 - S_8.5", "", [](const Judged& j) { return 1.0 - j.felt.skill_8; });
    add(w, "1 - S_8.5, envelope", "", [](const Judged& j) { return 1.0 - j.envelope.skill_8; });
    add(w, "sqrt E", "um", [](const Judged& j) { return 1e6 * j.intensity; });
    add(w, "strongest", "um", [](const Judged& j) { return 1e6 * j.strongest; });
  }
}

}  // namespace prostm::bench
