#include "prostm/target/field_shape.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace prostm {
namespace {

constexpr std::uint32_t kAbove = 0xffffffff;  // parent of a cell that is not yet joined

constexpr std::array<Quantity<FieldShape>, 8> kQuantities{{
    {.name = "maxima",
     .unit = "",
     .help = "Maxima of the field: the highest cell within 18 mm, at least 0.35 of the largest "
             "pressure.",
     .value = +[](const FieldShape& s) { return static_cast<std::int64_t>(s.count()); }},
    {.name = "largest_pa",
     .unit = "Pa",
     .help = "Largest pressure.",
     .value = &FieldShape::largest},
    {.name = "balance",
     .unit = "",
     .help = "Smallest of the maxima over the largest.",
     .value = &FieldShape::balance,
     .better = Better::More},
    {.name = "saddle",
     .unit = "",
     .help = "Highest level at which two maxima join, over the largest pressure.",
     .value = &FieldShape::saddle,
     .better = Better::Less},
    {.name = "least_spacing_mm",
     .unit = "mm",
     .help = "Least distance of two maxima.",
     .value = &FieldShape::least_spacing,
     .scale = 1e3},
    {.name = "most_spacing_mm",
     .unit = "mm",
     .help = "Largest distance of a maximum to its nearest other.",
     .value = &FieldShape::most_spacing,
     .scale = 1e3},
    {.name = "area_cm2",
     .unit = "cm2",
     .help = "Area of at least half of the largest pressure.",
     .value = &FieldShape::area,
     .scale = 1e4},
    {.name = "force_mn",
     .unit = "mN",
     .help = "Total force.",
     .value = &FieldShape::force,
     .scale = 1e3},
}};

void measure_spacing(FieldShape& shape) {
  if (shape.maxima.size() < 2) return;
  shape.least_spacing = 1e9;
  for (const FieldShape::Maximum& a : shape.maxima) {
    double nearest = 1e9;
    for (const FieldShape::Maximum& b : shape.maxima) {
      if (&a != &b) nearest = std::min(nearest, (a.position - b.position).norm());
    }
    shape.least_spacing = std::min(shape.least_spacing, nearest);
    shape.most_spacing = std::max(shape.most_spacing, nearest);
  }
}

}  // namespace

template <>
std::span<const Quantity<FieldShape>> quantities<FieldShape>() {
  return kQuantities;
}

FieldShapeMeter::FieldShapeMeter(std::size_t max_cells) {
  order_.reserve(max_cells);
  parent_.reserve(max_cells);
  holds_.reserve(max_cells);
}

FieldShape FieldShapeMeter::measure(const TargetField& field) {
  FieldShape out;
  out.largest = max_pressure(field);
  if (out.largest <= 0.0) return out;
  const double cell_area = field.cell * field.cell;
  out.force = total_pressure(field) * cell_area;
  out.area = cell_area *
             static_cast<double>(std::count_if(field.pressure.begin(), field.pressure.end(),
                                               [&](double p) { return p >= 0.5 * out.largest; }));
  find_maxima(field, out);
  out.balance = out.maxima.back().pressure / out.largest;
  measure_spacing(out);
  if (out.count() > 1) out.saddle = join_level(field, out) / out.largest;
  return out;
}

void FieldShapeMeter::find_maxima(const TargetField& field, FieldShape& out) const {
  const int reach = static_cast<int>(std::floor(kWindow / field.cell + 1e-9));
  // ties go to the first cell
  const auto is_largest = [&](int row, int col) {
    const std::size_t own = field.index(row, col);
    for (int r = std::max(0, row - reach); r <= std::min(field.rows - 1, row + reach); ++r) {
      for (int c = std::max(0, col - reach); c <= std::min(field.cols - 1, col + reach); ++c) {
        const std::size_t other = field.index(r, c);
        if (field.pressure[other] > field.pressure[own] ||
            (other < own && field.pressure[other] == field.pressure[own]))
          return false;
      }
    }
    return true;
  };
  for (int row = 0; row < field.rows; ++row) {
    for (int col = 0; col < field.cols; ++col) {
      const double p = field.pressure[field.index(row, col)];
      if (p < kLeast * out.largest || out.maxima.size() == out.maxima.capacity()) continue;
      if (is_largest(row, col)) out.maxima.push_back({field.position(row, col), p});
    }
  }
  std::sort(out.maxima.begin(), out.maxima.end(),
            [](const auto& a, const auto& b) { return a.pressure > b.pressure; });
}

std::uint32_t FieldShapeMeter::root_of(std::uint32_t cell) {
  while (parent_[cell] != cell) cell = parent_[cell] = parent_[parent_[cell]];
  return cell;
}

double FieldShapeMeter::join_level(const TargetField& field, const FieldShape& shape) {
  const std::size_t count = field.size();
  order_.clear();
  for (std::uint32_t c = 0; c < count; ++c) {
    if (field.pressure[c] > 0.0) order_.push_back(c);
  }
  std::sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) {
    const double pa = field.pressure[a], pb = field.pressure[b];
    return pa > pb || (pa == pb && a < b);
  });
  parent_.assign(count, kAbove);
  holds_.assign(count, 0);
  for (const FieldShape::Maximum& maximum : shape.maxima) {
    const Vec2 q = (maximum.position - field.origin) / field.cell;
    holds_[field.index(static_cast<int>(std::lround(q.y())),
                       static_cast<int>(std::lround(q.x())))] = 1;
  }
  // add the cells by falling pressure; each joins the trees of its eight neighbours
  for (const std::uint32_t cell : order_) {
    parent_[cell] = cell;
    const int row = static_cast<int>(cell) / field.cols, col = static_cast<int>(cell) % field.cols;
    for (int r = std::max(0, row - 1); r <= std::min(field.rows - 1, row + 1); ++r) {
      for (int c = std::max(0, col - 1); c <= std::min(field.cols - 1, col + 1); ++c) {
        const auto other = static_cast<std::uint32_t>(field.index(r, c));
        if (parent_[other] == kAbove) continue;
        const std::uint32_t a = root_of(cell), b = root_of(other);
        if (a == b) continue;
        if (holds_[a] != 0 && holds_[b] != 0) return field.pressure[cell];
        parent_[b] = a;
        holds_[a] |= holds_[b];
      }
    }
  }
  return 0.0;
}

}  // namespace prostm
