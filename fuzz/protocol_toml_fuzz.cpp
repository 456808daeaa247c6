/// Protocols: any text is a protocol whose orders are whole and whose levels keep within bounds, or
/// gives an InputError.
#include <cstdint>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "prostm/core/input_error.hpp"
#include "prostm/study/task/course.hpp"
#include "prostm/study/task/protocol_file.hpp"
#include "prostm/study/task/task.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace prostm;
  static const PipelineSettings base;
  try {
    const Protocol protocol =
        protocol_from_toml({reinterpret_cast<const char*>(data), size}, "fuzz.toml", base);
    static_cast<void>(protocol_json(protocol).size());
    constexpr int kFew = 50;  // more participants take too long for a fuzzer
    if (protocol.trials.repeats > kFew || protocol.methods.size() > 5) return 0;
    if (protocol.level.tracks * static_cast<int>(protocol.scenes.size()) <= kFew) {
      Course course(protocol, 3);
      const auto& level = protocol.level;
      for (int i = 0; i < kFew && !course.is_done(); ++i) {
        const Trial& t = course.trial();
        if (t.level && !(*t.level >= level.low - 0.5 && *t.level <= level.high + 0.5)) std::abort();
        if (protocol.trials.task->is_tuned()) {
          course.tune(i % 3 - 1, i % 2 == 0);
          course.accept(*course.trial().level);
        } else {
          course.answer(i % 3 == 0);
        }
      }
    }
    const auto trials = trial_order(protocol, 3);
    const std::size_t methods =
        protocol.study.methods == MethodsOf::Between ? 1 : protocol.methods.size();
    const auto repeats = static_cast<std::size_t>(protocol.trials.repeats);
    if (trials.size() != methods * protocol.scenes.size() * repeats) std::abort();
    for (const Trial& t : trials) {
      if (t.method < 0 || t.method >= static_cast<int>(protocol.methods.size())) std::abort();
      for (const int scene : {t.scene, t.question})
        if (scene < 0 || scene >= static_cast<int>(protocol.scenes.size())) std::abort();
    }
  } catch (const InputError&) {
    // the required answer to bad input
  }
  return 0;
}
