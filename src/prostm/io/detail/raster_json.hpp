#pragma once
/// The parts common to field and plan files: the raster, its heights and its plane. Private to io.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "prostm/core/text/json.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm {

/// Bound of coordinates in files, 1 km [mm]: far beyond any array, far below any overflow.
inline constexpr double kMaxCoordinateMm = 1e6;
/// Largest pressure in a file, in any unit: the sum of its squares over a raster is still finite.
inline constexpr double kMaxFilePressure = 1e150;
/// The largest weight of a cell in a file.
inline constexpr double kMaxFileWeight = 1e150;

/// Returns the edge of a cell [m]. @param what name of the value in the message. @throws InputError
/// unless it is 0.01 to 1000 mm.
double checked_cell(double cell_mm, const std::string& file, const std::string& what);
/// @throws InputError unless the raster has 1 to kMaxFieldCells cells.
void check_raster_size(double rows, double cols, const std::string& file);
/// Removes rounding errors from the pressures on skin (clear_rounding()). @throws InputError for a
/// pressure that is still negative, not finite, or above kMaxFilePressure.
void settle_pressures(TargetField& field, const std::string& file);

/// Reads "cell_mm", "origin_mm", "rows" and "cols" into a cleared field.
void read_raster(const JsonNode& node, TargetField& field);
/// @throws InputError unless `node` is an array of field.rows arrays of field.cols numbers or
/// nulls.
void check_matrix(const JsonNode& node, const TargetField& field);
/// Reads a matrix of heights [mm], null off the skin, where heights are extrapolated from the skin.
void read_heights(const JsonNode& node, TargetField& field);
/// Reads a plane's "origin_mm", "x" and "y": they must be unit and orthogonal within 1e-6, and are
/// then made exactly so; x × y must not point towards the array, −z.
Pose read_plane(const JsonNode& node);

/// Adds the members read by read_raster().
void write_raster(const TargetField& field, nlohmann::ordered_json& object);
/// Returns the matrix read by read_heights().
nlohmann::ordered_json heights_json(const TargetField& field);
nlohmann::ordered_json plane_json(const Pose& X_DP);

}  // namespace prostm
