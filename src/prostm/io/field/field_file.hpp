#pragma once
/// Target fields in files: prostm-field/1 JSON, NPY, NPZ, PNG, and frames of HDF5 recordings.

#include <optional>
#include <string>
#include <string_view>

#include "prostm/target/target_field.hpp"

namespace prostm {

/// The names of options in messages; by default those of the command line.
struct FieldOptionNames {
  const char *cell_mm = "--cell-mm", *width_mm = "--width-mm", *frame = "--frame",
             *invert = "--invert", *variable = "--variable";
};

struct FieldFileOptions {
  /// Edge of a cell, or width of the whole field: exactly one is required for .npy, .npz and .png;
  /// none is allowed for other files.
  std::optional<double> cell_mm = {}, width_mm = {};
  std::optional<int> frame = {};  ///< frame of a recording (default 0) or of a 3-D array
  bool invert = false;            ///< the picture is black on white: black means pressure
  FieldOptionNames names = {};
  std::string variable = {};  ///< name of the array, for an .npz with several
};

enum class FieldKind { Json, Npy, Npz, Png, Recording };
/// Returns the kind by file extension. @throws InputError for an unknown extension, with a way to
/// convert the file if its format is known.
FieldKind field_kind(const std::string& path);

/// Reads a field by file extension (.json, .npy, .npz, .png, .h5); "-" is standard input, whose
/// kind is determined from its content. @param kind receives the kind. @throws InputError naming
/// the file.
TargetField read_field(const std::string& path, const FieldFileOptions& options = {},
                       FieldKind* kind = nullptr);

/// Parsers of bytes; `name` is the file's name in messages. @throws InputError.
TargetField field_from_json(std::string_view text, const std::string& name);
/// float16 to float64, integer or boolean, 2-D (rows, columns) or 3-D (frames, rows, columns), C or
/// Fortran order; NaN means no skin. Row 0 has the smallest y. @param frame the frame of a 3-D
/// array, required if there are several. @param frame_option name of this option in messages.
TargetField field_from_npy(std::string_view bytes, const std::string& name, double cell_mm,
                           std::optional<int> frame = {}, const char* frame_option = "--frame");
/// Reads the array named by options.variable from a zip archive, or the only one, as
/// field_from_npy().
TargetField field_from_npz(std::string_view bytes, const std::string& name, double cell_mm,
                           const FieldFileOptions& options = {});
/// The pressure is the luminance relative to white, with 8 or 16 bits; alpha 0 means no skin; row 0
/// has the largest y.
TargetField field_from_png(std::string_view bytes, const std::string& name, double cell_mm);

/// Returns a field as prostm-field/1.
std::string field_to_json(const TargetField& field);

}  // namespace prostm
