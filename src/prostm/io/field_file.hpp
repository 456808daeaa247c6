#pragma once
/// Target fields in files: prostm-field/1 JSON, NPY, PNG, and frames of HDF5 recordings.

#include <optional>
#include <string>
#include <string_view>

#include "prostm/target/target_field.hpp"

namespace prostm {

/// The names that messages call the options by: those of the command line unless set.
struct FieldOptionNames {
  const char *cell_mm = "--cell-mm", *width_mm = "--width-mm", *frame = "--frame",
             *invert = "--invert";
};

struct FieldFileOptions {
  /// Edge of a cell, or width of the whole field: one of them is needed for .npy and .png, and both
  /// are refused elsewhere.
  std::optional<double> cell_mm = {}, width_mm = {};
  int frame = 0;        ///< of a recording
  bool invert = false;  ///< a picture is drawn black on white: black is the pressure
  FieldOptionNames names = {};
};

enum class FieldKind { Json, Npy, Png, Recording };
/// By the ending of the file's name. @throws InputError for any other ending.
FieldKind field_kind(const std::string& path);

/// Reads a field by the ending of its name (.json, .npy, .png, .h5). @throws InputError with a
/// sentence that names the file.
TargetField read_field(const std::string& path, const FieldFileOptions& options = {});

/// Parsers of bytes; `name` stands for the file in messages. @throws InputError.
TargetField field_from_json(std::string_view text, const std::string& name);
/// float32, float64, integer or boolean, 2-D, C or Fortran order; NaN is no skin. Row 0 is the
/// smallest y.
TargetField field_from_npy(std::string_view bytes, const std::string& name, double cell_mm);
/// Grey value (luminance) over full white is the pressure, alpha 0 is no skin; row 0 is the largest
/// y.
TargetField field_from_png(std::string_view bytes, const std::string& name, double cell_mm);

/// The same field as prostm-field/1.
std::string field_to_json(const TargetField& field);

}  // namespace prostm
