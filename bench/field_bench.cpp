/// What the field of an array costs: rows of the propagation matrix.
///
/// usage: field_bench [--json FILE]

#include <algorithm>
#include <string>
#include <vector>

#include "acoustics/propagation_kernels.hpp"
#include "core/distribution.hpp"
#include "core/stage_timer.hpp"
#include "report.hpp"

namespace prostm {
namespace {

using bench::Row;

/// A raster of side × side points, 1.5 mm apart, 200 mm above the array.
std::vector<Vec3> raster(int side) {
  std::vector<Vec3> points;
  for (int j = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i) {
      points.emplace_back(1.5e-3 * (i - 0.5 * (side - 1)), 1.5e-3 * (j - 0.5 * (side - 1)), 0.2);
    }
  }
  return points;
}

/// Nanoseconds an element of G, interleaved: the kernel, the plain reference, and the floor, which
/// only writes as many numbers.
void add_propagation_rows(int points, int repeats, std::vector<Row>& rows) {
  const PackedArray packed(usx_array(), Medium());
  std::vector<Vec3> at = raster(64);
  at.resize(static_cast<std::size_t>(points));
  std::vector<float> re(at.size() * packed.stride()), im(re.size());
  const int inner = std::max(1, 4096 / points);
  Distribution ours, plain, floor;
  for (int i = 0; i < repeats; ++i) {
    const auto time = [&](Distribution& out, int times, auto&& work) {
      const StageTimer timer;
      for (int k = 0; k < times; ++k) work(static_cast<float>(k));
      out.add(1e9 * timer.seconds() / (times * static_cast<double>(re.size())));
    };
    time(ours, inner, [&](float) { propagation_rows(packed, at, {}, re.data(), im.data()); });
    time(plain, std::max(1, inner / 16),
         [&](float) { propagation_rows_plain(packed, at, {}, re.data(), im.data()); });
    time(floor, inner, [&](float value) {
      std::fill(re.begin(), re.end(), value);
      std::fill(im.begin(), im.end(), value);
    });
  }
  const std::string name = "G, " + std::to_string(points) + " points x 256";
  rows.push_back({name, "ns", ours.summary(), "plain", plain.summary().p50});
  rows.push_back({name + ", only written", "ns", floor.summary(), "kernel", ours.summary().p50});
}

std::vector<Row> measure_field() {
  std::vector<Row> rows;
  for (const int points : {4, 32, 4096}) add_propagation_rows(points, 15, rows);
  return rows;
}

}  // namespace
}  // namespace prostm

int main(int argc, char** argv) {
  return prostm::bench::run(argc, argv, prostm::measure_field);
}
