#include "prostm/acoustics/skin/bounded_skin.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "prostm/core/require.hpp"
#include "prostm/core/units.hpp"

namespace prostm {
namespace {

std::vector<std::uint8_t> checked(const SkinPatch& patch, std::span<const std::uint8_t> skin) {
  if (skin.size() != patch.size() ||
      std::all_of(skin.begin(), skin.end(), [](std::uint8_t here) { return here == 0; })) {
    throw std::invalid_argument(
        "the mask must have one value for each cell of the patch, and skin in at least one");
  }
  return {skin.begin(), skin.end()};
}

int parts_of(const SkinPatch& patch, double finest) {
  require_between("finest", finest, 0.2e-3, 5e-3, "m");
  return 2 * static_cast<int>(std::ceil(0.5 * patch.cell / finest * (1.0 - 1e-9)));
}

/// Divides each cell of a mask into parts × parts.
std::vector<std::uint8_t> refined(const SkinPatch& patch, const std::vector<std::uint8_t>& skin,
                                  int parts) {
  std::vector<std::uint8_t> out;
  for (int j = 0; j < patch.rows * parts; ++j) {
    for (int i = 0; i < patch.cols * parts; ++i) {
      out.push_back(skin[static_cast<std::size_t>(j / parts * patch.cols + i / parts)]);
    }
  }
  return out;
}

/// Returns corners × cells weights along one axis: sin(πs)/(πs), s from cell to corner in cells.
Eigen::MatrixXd interpolation(int cells, int parts) {
  Eigen::MatrixXd out(cells * parts + 1, cells);
  for (int a = 0; a <= cells * parts; ++a) {
    for (int i = 0; i < cells; ++i) {
      const double s = kPi * (static_cast<double>(a) / parts - 0.5 - i);
      out(a, i) = std::abs(s) < 1e-9 ? 1.0 : std::sin(s) / s;
    }
  }
  return out;
}

}  // namespace

BoundedSkin::BoundedSkin(const SkinModel& model, const SkinPatch& patch,
                         std::span<const std::uint8_t> skin, double finest)
    : SkinMotion(patch),
      model_(model),
      skin_(checked(patch, skin)),
      parts_(parts_of(patch, finest)),
      near_(model, patch, SkinPart::Near),
      waves_(patch.rows * parts_, patch.cols * parts_, patch.cell / parts_,
             refined(patch, skin_, parts_)),
      along_rows_(interpolation(patch.rows, parts_)),
      along_cols_(interpolation(patch.cols, parts_)) {}

void BoundedSkin::prepare(double period, int samples, double highest) {
  choose_harmonics(period, samples, highest);
  near_.prepare(period, samples, highest);
  pressure_.resize(static_cast<std::size_t>(samples) * patch().size());
  waves_.clear();
  for (int n = 1; n <= harmonics(); ++n) {
    const double omega = 2.0 * kPi * frequency(n);
    waves_.add(model_.surface_wave_number(omega), model_.wave_strength(omega));
  }
}

void BoundedSkin::respond(const PressureLoop& loop) {
  load(loop);
  for (std::size_t i = 0; i < pressure_.size(); ++i) {
    pressure_[i] = skin_[i % skin_.size()] != 0 ? loop.pressure[i] : 0.0;
  }
  near_.respond({loop.period, loop.samples, pressure_});
  const int rows = patch().rows, cols = patch().cols;
  Eigen::MatrixXcd cells(rows, cols);
  Eigen::VectorXcd at_corners(waves_.corners());
  for (int n = 1; n <= harmonics(); ++n) {
    const auto field = harmonic(n);
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < cols; ++i) {
        const auto c = static_cast<std::size_t>(j * cols + i);
        cells(j, i) = skin_[c] != 0 ? field[c] : 0.0;
      }
    }
    const Eigen::MatrixXcd fine = along_rows_ * cells * along_cols_.transpose();
    for (int a = 0; a < fine.rows(); ++a) {
      for (int b = 0; b < fine.cols(); ++b) {
        const int corner = waves_.corner(a, b);
        if (corner >= 0) at_corners[corner] = fine(a, b);
      }
    }
    const Eigen::VectorXcd moved = waves_.respond(static_cast<std::size_t>(n - 1), at_corners);
    const auto near_field = near_.displacement(n);
    for (std::size_t c = 0; c < field.size(); ++c) {
      const int row = static_cast<int>(c) / cols, col = static_cast<int>(c) % cols;
      const int centre = waves_.corner(row * parts_ + parts_ / 2, col * parts_ + parts_ / 2);
      field[c] = skin_[c] != 0 ? near_field[c] + moved[centre] : 0.0;
    }
  }
}

}  // namespace prostm
