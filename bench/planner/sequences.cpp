#include "planner/sequences.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>

#include "core/input_error.hpp"
#include "fields/fields.hpp"
#include "io/recorder.hpp"

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

Sequence captured(const std::string& file) {
  const RecordingReader recording(file);
  const auto targets = std::make_shared<std::vector<TargetField>>();
  Sequence sequence;
  for (int i = 0; i < recording.frames(); ++i) {
    for (const TargetField& target : recording.frame(i).patches) {
      if (!(max_pressure(target) > 0.0)) continue;
      sequence.cells = std::max(sequence.cells, target.size());
      targets->push_back(target);
      break;
    }
  }
  if (targets->empty()) throw InputError(file + ": none of its fields has pressure to plan for");
  sequence.name = std::filesystem::path(file).stem().string();
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
