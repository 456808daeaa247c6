#pragma once
/// The shape of a pressure field in terms of its maxima: their number, balance and spacing, and the
/// depth of the saddles between them.

#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <span>
#include <vector>

#include "prostm/core/quantity.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm {

struct FieldShape {
  static constexpr int kMaxMaxima = 16;
  /// Maximum of the field: a cell of at least 0.35 of the largest pressure, which no cell within
  /// ± 18 mm along both axes exceeds. The list has the largest first, at most kMaxMaxima.
  struct Maximum {
    Vec2 position;          ///< in P [m]
    double pressure = 0.0;  ///< [Pa]
  };
  boost::container::static_vector<Maximum, kMaxMaxima> maxima;
  double largest = 0.0;  ///< largest pressure [Pa]
  /// smallest of the maxima over the largest; 0 without maxima
  double balance = 0.0;
  /// highest level at which two of the maxima join, over the largest pressure; 0 with fewer than
  /// two
  double saddle = 0.0;
  double least_spacing = 0.0;  ///< least distance of two maxima [m]; 0 with fewer than two
  /// largest distance of a maximum to its nearest neighbour [m]; 0 with fewer than two
  double most_spacing = 0.0;
  double area = 0.0;   ///< area of the cells of at least half of the largest pressure [m²]
  double force = 0.0;  ///< Σ pressure × area of a cell [N]

  int count() const { return static_cast<int>(maxima.size()); }
};
template <>
std::span<const Quantity<FieldShape>> quantities<FieldShape>();

/// Measures fields. Keeps its scratch memory, so that it allocates nothing for a field of at most
/// `max_cells`. Takes time of order n log n for n cells.
class FieldShapeMeter {
 public:
  explicit FieldShapeMeter(std::size_t max_cells = 0);

  /// @pre the field is valid. A field without pressure has no maxima.
  FieldShape measure(const TargetField& field);

  static constexpr double kWindow = 0.018;  ///< half-width of the window of a maximum [m]
  static constexpr double kLeast = 0.35;    ///< least share of the largest pressure for a maximum

 private:
  void find_maxima(const TargetField& field, FieldShape& out) const;
  /// Returns the highest level at which two maxima are connected [Pa]; 0 if none are.
  double join_level(const TargetField& field, const FieldShape& shape);
  std::uint32_t root_of(std::uint32_t cell);

  std::vector<std::uint32_t> order_;   // cells by falling pressure
  std::vector<std::uint32_t> parent_;  // for each cell, in the forest of joined cells
  std::vector<std::uint8_t> holds_;    // for each root: whether its tree contains a maximum
};

}  // namespace prostm
