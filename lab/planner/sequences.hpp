#pragma once
/// The targets that planners are measured on.

#include <functional>
#include <string>
#include <vector>

#include "prostm/target/target_field.hpp"

namespace prostm::bench {

/// A named sequence of target fields.
struct Sequence {
  std::string name;
  int frames = 0;
  std::size_t cells = 0;  ///< number of cells of its largest raster
  std::function<TargetField(int frame)> field;
};

/// Returns the nine generated sequences of src/prostm/fields.
std::vector<Sequence> gallery();

/// Reads the fields of a file: from a recording (.h5) the first patch with pressure of each frame,
/// from any other field file its one field. @throws InputError: no such file, or no pressure in it.
Sequence read_sequence(const std::string& file);

/// Returns n frames spread evenly over a sequence, from 0 up; all of them if it has no more.
std::vector<int> spread(int frames, int n);

}  // namespace prostm::bench
