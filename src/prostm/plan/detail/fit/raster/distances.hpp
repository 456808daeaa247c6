#pragma once
/// Kernels that compare the distances of many points.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "prostm/plan/detail/fit/loops.hpp"

namespace prostm::planning {

/// Positions of the set bits of each byte, lowest first: they list the lanes that a vector
/// comparison found, without branches. (Highway's own CompressStore is slow on AVX2.)
using SetBits = std::array<std::array<std::uint8_t, 8>, 256>;
constexpr SetBits set_bits() {
  SetBits places{};
  for (std::size_t byte = 0; byte < 256; ++byte) {
    std::size_t count = 0;
    for (std::uint8_t bit = 0; bit < 8; ++bit) {
      if ((byte >> bit & 1U) != 0) places[byte][count++] = bit;
    }
  }
  return places;
}
alignas(64) inline constexpr SetBits kSetBits = set_bits();

/// Writes the index of the centre nearest to each point; ties go to the first.
/// @pre x, y and nearest have the same size; centre_x and centre_y too, at least one.
void nearest_centres(std::span<const float> x, std::span<const float> y,
                     std::span<const float> centre_x, std::span<const float> centre_y,
                     std::span<std::int32_t> nearest);

/// Two nodes; first < second.
struct NodePair {
  std::size_t first, second;
};

/// The pairs of nodes that are near each other, in ascending order. Sized once, for all possible
/// pairs.
class NodePairs {
 public:
  NodePairs();

  /// Lists the pairs of the first `nodes` nodes that are nearer than `distance`.
  /// @pre x and y are aligned like a vector.
  void set(const NodeArray& x, const NodeArray& y, std::size_t nodes, float distance);

  void clear() { size_ = 0; }
  void add(const NodePair& pair) {
    packed_[size_++] = static_cast<std::uint32_t>(pair.first | pair.second << 16U);
  }
  /// Removes the pairs for which keep(pair) is false.
  template <typename Keep>
  void filter(const Keep& keep) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      const std::uint32_t packed = packed_[i];
      packed_[kept] = packed;
      kept += keep((*this)[i]) ? 1 : 0;
    }
    size_ = kept;
  }

  std::size_t size() const { return size_; }
  NodePair operator[](std::size_t i) const { return {packed_[i] & 0xffffU, packed_[i] >> 16U}; }

 private:
  std::vector<std::uint32_t> packed_;  // with room for one vector past the end
  std::size_t size_ = 0;
};

}  // namespace prostm::planning
