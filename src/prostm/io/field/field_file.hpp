#pragma once
/// Target fields in files: prostm-field/1 JSON, NPY, NPZ, PNG, and frames of HDF5 recordings.

#include <optional>
#include <string>
#include <string_view>

#include "prostm/target/target_field.hpp"

namespace prostm {

/// The names that messages call the options by: those of the command line unless set.
struct FieldOptionNames {
  const char *cell_mm = "--cell-mm", *width_mm = "--width-mm", *frame = "--frame",
             *invert = "--invert", *variable = "--variable";
};

struct FieldFileOptions {
  /// Edge of a cell, or width of the whole field: one of them is needed for .npy, .npz and .png,
  /// and both are refused elsewhere.
  std::optional<double> cell_mm = {}, width_mm = {};
  std::optional<int> frame = {};  ///< of a recording, by default 0, or of a 3-D array
  bool invert = false;            ///< a picture is drawn black on white: black is the pressure
  FieldOptionNames names = {};
  std::string variable = {};  ///< the array of an .npz that holds several
};

enum class FieldKind { Json, Npy, Npz, Png, Recording };
/// By the ending of the file's name. @throws InputError for any other ending, with a way to convert
/// the file if its format is known.
FieldKind field_kind(const std::string& path);

/// Reads a field by the ending of its name (.json, .npy, .npz, .png, .h5); "-" is standard input,
/// whose kind is told by its content. @param kind gets the kind. @throws InputError with a sentence
/// that names the file.
TargetField read_field(const std::string& path, const FieldFileOptions& options = {},
                       FieldKind* kind = nullptr);

/// Parsers of bytes; `name` stands for the file in messages. @throws InputError.
TargetField field_from_json(std::string_view text, const std::string& name);
/// float16 to float64, integer or boolean, 2-D (rows, columns) or 3-D (frames, rows, columns), C or
/// Fortran order; NaN is no skin. Row 0 is the smallest y. @param frame of a 3-D array, needed if
/// that has several. @param frame_option its name in messages.
TargetField field_from_npy(std::string_view bytes, const std::string& name, double cell_mm,
                           std::optional<int> frame = {}, const char* frame_option = "--frame");
/// The array of a zip archive that options.variable names, or the only one, as field_from_npy().
TargetField field_from_npz(std::string_view bytes, const std::string& name, double cell_mm,
                           const FieldFileOptions& options = {});
/// Luminance over full white is the pressure, with 8 or 16 bits; alpha 0 is no skin; row 0 is the
/// largest y.
TargetField field_from_png(std::string_view bytes, const std::string& name, double cell_mm);

/// The same field as prostm-field/1.
std::string field_to_json(const TargetField& field);

}  // namespace prostm
