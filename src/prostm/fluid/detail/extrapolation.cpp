#include "prostm/fluid/detail/extrapolation.hpp"

namespace prostm::fluid {

namespace {

constexpr int kNeighbours = 6;

/// The distance to a face's neighbour.
Index away(const Index stride[3], int neighbour) {
  return neighbour % 2 == 0 ? -stride[neighbour / 2] : stride[neighbour / 2];
}

/// A face that gets the mean of its neighbours for which `test` holds.
template <class Test>
ShutFace shut_face(const Index stride[3], Index at, const Test& test) {
  ShutFace face{at, 0};
  for (int n = 0; n < kNeighbours; ++n) {
    if (test(at + away(stride, n))) face.from |= static_cast<std::uint8_t>(1U << n);
  }
  return face;
}

void add_face(const PressureLevel& level, int axis, Index at, ShutFaces& faces) {
  const float* const open = level.open[axis].data();
  const ShutFace face = shut_face(faces.stride, at, [&](Index c) { return open[c] > 0.0F; });
  if (face.from == 0) return faces.deep.push_back(at);
  faces.layers[0].push_back(face);
  faces.layer[at] = 1;
}

}  // namespace

void list_shut_faces(const PressureLevel& level, int axis, ShutFaces& faces) {
  for (const ShutFace& face : faces.layers[0]) faces.layer[face.at] = 0;
  for (auto& layer : faces.layers) layer.clear();
  faces.deep.clear();
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
        if (open[i] == 0.0F) add_face(level, axis, row + i, faces);
      }
    }
  }
  for (const Index at : faces.deep) {
    const ShutFace face = shut_face(faces.stride, at, [&](Index c) { return faces.layer[c] != 0; });
    if (face.from != 0) faces.layers[1].push_back(face);
  }
}

void extend_into_hands(const ShutFaces& faces, Field& u) {
  for (const std::vector<ShutFace>& layer : faces.layers) {
    for (const ShutFace& face : layer) {
      float sum = 0.0F, count = 0.0F;
      for (int n = 0; n < kNeighbours; ++n) {
        if ((face.from >> n & 1) == 0) continue;
        sum += u[face.at + away(faces.stride, n)];
        count += 1.0F;
      }
      u[face.at] = sum / count;
    }
  }
}

}  // namespace prostm::fluid
