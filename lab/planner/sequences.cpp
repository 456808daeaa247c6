#include "planner/sequences.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>

#include "prostm/core/input_error.hpp"
#include "prostm/fields/fields.hpp"
#include "prostm/io/field/field_file.hpp"
#include "prostm/io/recorder.hpp"

namespace prostm::bench {

std::vector<Sequence> gallery() {
  std::vector<Sequence> list;
  for (const fields::Pattern pattern : fields::kPatterns) {
    list.push_back({to_string(pattern), fields::kFrames,
                    static_cast<std::size_t>(fields::kCells) * fields::kCells,
                    [pattern](int frame) { return fields::make(pattern, frame); }});
  }
  return list;
}

Sequence read_sequence(const std::string& file) {
  const std::filesystem::path path(file);
  const auto targets = std::make_shared<std::vector<TargetField>>();
  if (path.extension() == ".h5") {
    const RecordingReader recording(file);
    for (int i = 0; i < recording.frames(); ++i) {
      const TargetFrame frame = recording.frame(i);
      const auto patch =
          std::find_if(frame.patches.begin(), frame.patches.end(),
                       [](const TargetField& target) { return max_pressure(target) > 0.0; });
      if (patch != frame.patches.end()) targets->push_back(*patch);
    }
  } else {
    const TargetField target = read_field(file);
    if (max_pressure(target) > 0.0) targets->push_back(target);
  }
  if (targets->empty()) throw InputError(file + ": none of its fields has pressure to plan for");

  Sequence sequence;
  for (const TargetField& target : *targets) {
    sequence.cells = std::max(sequence.cells, target.size());
  }
  sequence.name = path.stem().string();
  sequence.frames = static_cast<int>(targets->size());
  sequence.field = [targets](int frame) { return (*targets)[static_cast<std::size_t>(frame)]; };
  return sequence;
}

std::vector<int> spread(int frames, int n) {
  std::vector<int> list;
  n = std::min(n, frames);
  for (int i = 0; i < n; ++i) list.push_back(static_cast<int>((2LL * i + 1) * frames / (2LL * n)));
  return list;
}

}  // namespace prostm::bench
