#pragma once
/// The shape of a pressure field to somebody who feels for its maxima: how many there are, how
/// alike, how far apart, and how deep the saddles between them.

#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <span>
#include <vector>

#include "prostm/core/quantity.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm {

struct FieldShape {
  static constexpr int kMaxMaxima = 16;
  /// Maxima of the field: a cell of at least 0.35 of the largest pressure, above which no cell
  /// within 18 mm along both axes has more. The largest first; at most kMaxMaxima of them.
  struct Maximum {
    Vec2 position;          ///< in P [m]
    double pressure = 0.0;  ///< [Pa]
  };
  boost::container::static_vector<Maximum, kMaxMaxima> maxima;
  double largest = 0.0;  ///< pressure [Pa]
  /// the least of the maxima over the largest; 0 without any
  double balance = 0.0;
  /// the highest level at which two of the maxima join, over the largest pressure; 0 with fewer
  /// than two
  double saddle = 0.0;
  double least_spacing = 0.0;  ///< the least distance of two maxima; 0 with fewer than two [m]
  /// the largest distance of a maximum to its nearest other; 0 with fewer than two [m]
  double most_spacing = 0.0;
  double area = 0.0;   ///< of the cells of at least half of the largest pressure [m²]
  double force = 0.0;  ///< Σ pressure × area of a cell [N]

  int count() const { return static_cast<int>(maxima.size()); }
};
template <>
std::span<const Quantity<FieldShape>> quantities<FieldShape>();

/// Measures fields. It keeps its scratch memory, so that it allocates nothing for a field of at
/// most `max_cells`. Time n log n for n cells.
class FieldShapeMeter {
 public:
  explicit FieldShapeMeter(std::size_t max_cells = 0);

  /// @pre the field is valid. A field without pressure has no maxima.
  FieldShape measure(const TargetField& field);

  static constexpr double kWindow = 0.018;  ///< a maximum is alone within ± this [m]
  static constexpr double kLeast = 0.35;    ///< a maximum's least share of the largest pressure

 private:
  void find_maxima(const TargetField& field, FieldShape& out) const;
  /// Returns the pressure at which two maxima join first when the level falls [Pa].
  double join_level(const TargetField& field, const FieldShape& shape);
  std::uint32_t root_of(std::uint32_t cell);

  std::vector<std::uint32_t> order_;   // cells by falling pressure
  std::vector<std::uint32_t> parent_;  // of each cell, in the forest of joined cells
  std::vector<std::uint8_t> holds_;    // of each root: whether a maximum is in its tree
};

}  // namespace prostm
