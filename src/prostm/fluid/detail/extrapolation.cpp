#include "prostm/fluid/detail/extrapolation.hpp"

namespace prostm::fluid {
namespace {

/// Calls f(index) for each shut face in the hands' box, the floor and the box's outer sides
/// excepted.
template <class F>
void for_shut_faces(const PressureLevel& level, int axis, F&& f) {
  int first[3], last[3];
  for (int a = 0; a < 3; ++a) {
    first[a] = std::max(level.box.lower[a], a == axis ? 1 : 0);
    last[a] = std::min(level.box.upper[a], level.grid.n - 1);
  }
  for (int k = first[2]; k <= last[2]; ++k) {
    for (int j = first[1]; j <= last[1]; ++j) {
      const Index row = level.grid.index(0, j, k);
      const float* open = level.open[axis].data() + row;
      for (int i = first[0]; i <= last[0]; ++i) {
        if (open[i] == 0.0F) f(row + i);
      }
    }
  }
}

}  // namespace

void extend_into_hands(const PressureLevel& level, int axis, Field& u,
                       PaddedField<std::uint8_t>& layer) {
  if (level.box.empty()) return;
  const Field& open = level.open[axis];
  const Index row = level.grid.row(), plane = level.grid.plane();
  constexpr std::uint8_t kLayers = 2;
  for (std::uint8_t pass = 1; pass <= kLayers; ++pass) {
    for_shut_faces(level, axis, [&](Index c) {
      if (layer[c] != 0) return;
      float sum = 0.0F, count = 0.0F;
      for (const Index o : {Index{-1}, Index{1}, -row, row, -plane, plane}) {
        const bool known =
            open[c + o] > 0.0F ? pass == 1 : layer[c + o] != 0 && layer[c + o] < pass;
        if (!known) continue;
        sum += u[c + o];
        count += 1.0F;
      }
      if (count == 0.0F) return;
      u[c] = sum / count;
      layer[c] = pass;
    });
  }
  for_shut_faces(level, axis, [&](Index c) { layer[c] = 0; });
}

}  // namespace prostm::fluid
