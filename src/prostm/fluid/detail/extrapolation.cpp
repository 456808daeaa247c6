#include "prostm/fluid/detail/extrapolation.hpp"

namespace prostm::fluid {

void list_shut_faces(const PressureLevel& level, int axis, std::vector<Index>& shut) {
  shut.clear();
  if (level.box.empty()) return;
  const CellBox& box = level.box;
  const int end = level.grid.n - 1;  // the box's outer sides are beyond
  int first[3], last[3];
  for (int a = 0; a < 3; ++a) {
    first[a] = std::max(box.lower[a], a == axis ? 1 : 0);
    last[a] = std::min(a == axis ? box.upper[a] : box.upper[a] - 1, end);
  }
  for (int k = first[2]; k <= last[2]; ++k) {
    for (int j = first[1]; j <= last[1]; ++j) {
      const RowSpan span = level.face_span(axis, j, k);
      if (span.empty()) continue;
      const Index row = level.grid.index(0, j, k);
      const float* open = level.open[axis].data() + row;
      for (int i = std::max<int>(first[0], span.begin); i <= std::min<int>(last[0], span.end);
           ++i) {
        if (open[i] == 0.0F) shut.push_back(row + i);
      }
    }
  }
}

void extend_into_hands(const PressureLevel& level, int axis, Field& u, ShutFaces& faces) {
  const Field& open = level.open[axis];
  const Index row = level.grid.row(), plane = level.grid.plane();
  constexpr std::uint8_t kLayers = 2;
  for (std::uint8_t pass = 1; pass <= kLayers; ++pass) {
    for (const Index c : faces.at) {
      if (faces.layer[c] != 0) continue;
      float sum = 0.0F, count = 0.0F;
      for (const Index o : {Index{-1}, Index{1}, -row, row, -plane, plane}) {
        const bool known =
            open[c + o] > 0.0F ? pass == 1 : faces.layer[c + o] != 0 && faces.layer[c + o] < pass;
        if (!known) continue;
        sum += u[c + o];
        count += 1.0F;
      }
      if (count == 0.0F) continue;
      u[c] = sum / count;
      faces.layer[c] = pass;
    }
  }
  for (const Index c : faces.at) faces.layer[c] = 0;
}

}  // namespace prostm::fluid
