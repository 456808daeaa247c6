#pragma once
/// Random target fields of every kind that a planner may receive, including many unusual ones.

#include <cmath>
#include <limits>

#include "prostm/core/random.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm::test {

enum class FieldKind {
  NoSkin,
  NoPressure,
  OneCell,
  TwoCells,
  Line,
  Diagonal,
  OneRow,
  OneColumn,
  Noise,
  Blobs,
  Ring,
  Border,
  Sparse,
  Flat,
  Invalid
};
inline constexpr int kFieldKinds = 15;

struct RandomField {
  FieldKind kind;
  TargetField field;
};

/// Sets one cell to skin with pressure p.
inline void touch(TargetField& field, int row, int col, double p) {
  field.skin[field.index(row, col)] = 1;
  field.pressure[field.index(row, col)] = p;
}

/// Returns the pressure of the kinds that cover the raster, 0..1; NaN for a cell without skin.
inline double cell_pressure(FieldKind kind, double u, double v, Random& random) {
  switch (kind) {
    case FieldKind::Noise:
      return random.uniform();
    case FieldKind::Ring:
      return std::exp(-50.0 * std::pow(std::hypot(u - 0.5, v - 0.5) - 0.35, 2));
    case FieldKind::Border:
      return std::min({u, v, 1.0 - u, 1.0 - v}) < 0.06 ? 1.0 : 0.0;
    case FieldKind::Sparse:
      return random.uniform() < 0.15 ? random.uniform() : std::nan("");
    case FieldKind::Flat:
      return 1.0;
    default:
      return 0.0;
  }
}

inline void add_blobs(TargetField& field, Random& random) {
  const int blobs = 1 + random.below(5);
  for (int k = 0; k < blobs; ++k) {
    const double r = random.uniform(0, field.rows), c = random.uniform(0, field.cols);
    const double width = random.uniform(0.5, 0.3 * (field.rows + field.cols) + 0.6);
    for (int row = 0; row < field.rows; ++row) {
      for (int col = 0; col < field.cols; ++col) {
        field.pressure[field.index(row, col)] +=
            std::exp(-0.5 * (std::pow((row - r) / width, 2) + std::pow((col - c) / width, 2)));
      }
    }
  }
}

/// Sets one invalid value or shape.
inline void spoil(TargetField& field, Random& random) {
  const auto i = static_cast<std::size_t>(random.below(static_cast<int>(field.size())));
  switch (random.below(5)) {
    case 0:
      field.pressure[i] = std::numeric_limits<double>::quiet_NaN();
      break;
    case 1:
      field.pressure[i] = std::numeric_limits<double>::infinity();
      break;
    case 2:
      field.pressure[i] = -1e-3;
      break;
    case 3:
      field.cell = 0.0;
      break;
    default:
      field.skin.pop_back();
      break;
  }
}

/// Gives the field weights of a random kind; they are invalid if no weight on skin is above 0.
inline void add_weights(TargetField& field, Random& random) {
  const int kind = random.below(5), split = random.below(field.rows + 1);
  const double few = random.uniform(0.0, 0.2);
  field.weight.assign(field.size(), 0.0);
  for (int row = 0; row < field.rows; ++row) {
    for (int col = 0; col < field.cols; ++col) {
      double& w = field.weight[field.index(row, col)];
      if (kind == 0) w = random.uniform();
      if (kind == 1) w = row < split ? 7.0 : 1.0;
      if (kind == 2) w = row < split ? 1.0 : 0.0;
      if (kind == 3) w = random.uniform() < few ? 1.0 : 0.0;
      if (kind == 4) w = std::pow(10.0, random.uniform(-300.0, 300.0));
    }
  }
}

/// @param max_side largest number of rows and columns.
inline RandomField random_field(Random& random, int max_side) {
  RandomField result{static_cast<FieldKind>(random.below(kFieldKinds)), {}};
  TargetField& field = result.field;
  int rows = 1 + random.below(max_side), cols = 1 + random.below(max_side);
  if (result.kind == FieldKind::OneRow) rows = 1;
  if (result.kind == FieldKind::OneColumn) cols = 1;
  field.resize(rows, cols);
  field.cell = random.uniform() < 0.1 ? std::pow(10.0, random.uniform(-5.0, 0.0))
                                      : random.uniform(1e-3, 8e-3);
  field.origin = Vec2(random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2));

  switch (result.kind) {
    case FieldKind::NoSkin:
      break;
    case FieldKind::NoPressure:
      field.skin.assign(field.size(), 1);
      break;
    case FieldKind::OneCell:
      touch(field, random.below(rows), random.below(cols), 1.0);
      break;
    case FieldKind::TwoCells:
      for (int k = 0; k < 2; ++k)
        touch(field, random.below(rows), random.below(cols), random.uniform(0.1, 1.0));
      break;
    case FieldKind::Line: {
      const int row = random.below(rows);
      for (int col = 0; col < cols; ++col) touch(field, row, col, random.uniform(0.1, 1.0));
      break;
    }
    case FieldKind::Diagonal:
      for (int k = 0; k < std::min(rows, cols); ++k) touch(field, k, k, 1.0);
      break;
    case FieldKind::OneRow:
    case FieldKind::OneColumn:
    case FieldKind::Blobs:
    case FieldKind::Invalid:
      field.skin.assign(field.size(), 1);
      add_blobs(field, random);
      break;
    default:
      for (int row = 0; row < rows; ++row) {
        for (int col = 0; col < cols; ++col) {
          const double p =
              cell_pressure(result.kind, (col + 0.5) / cols, (row + 0.5) / rows, random);
          if (!std::isnan(p)) touch(field, row, col, p);
        }
      }
  }
  if (random.uniform() < 0.3) {
    const double scale = std::pow(10.0, random.uniform(-300.0, 298.0));
    for (double& p : field.pressure) p *= scale;
  }
  if (result.kind == FieldKind::Invalid) spoil(field, random);
  return result;
}

}  // namespace prostm::test
