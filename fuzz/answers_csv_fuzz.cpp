/// Answers of a study: any bytes give named answers, whose tidy table has the same answers and
/// whose analysis is finite, or an error.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <set>
#include <string>

#include "prostm/core/input_error.hpp"
#include "prostm/study/analysis/analysis.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace prostm;
  try {
    const auto answers = answers_from_csv({reinterpret_cast<const char*>(data), size}, "fuzz.csv");
    std::set<std::string> participants;
    for (const Answer& a : answers) {
      if (a.participant.empty() || a.method.empty() || a.scene.empty()) std::abort();
      participants.insert(a.participant);
    }
    if (answers_from_csv(tidy_csv(answers), "tidy.csv") != answers) std::abort();
    constexpr std::size_t kFew = 8;  // more participants have too many splits for a fuzzer
    if (participants.size() > kFew) return 0;
    const Analysis analysis = analyse(answers);
    for (const ThresholdResult& of : analysis.thresholds) {
      if (of.fit && !std::isfinite(of.fit->function.threshold)) std::abort();
      if (of.bounds && of.bounds->interval.low > of.bounds->interval.high) std::abort();
    }
    for (const SceneResult& scene : analysis.scenes) {
      for (const Comparison& c : scene.comparisons) {
        const bool is_p =
            c.fisher_p >= 0.0 && c.fisher_p <= 1.0 && (!c.permutation || c.permutation->p > 0.0);
        if (!is_p || !std::isfinite(c.pooled_z.statistic)) std::abort();
      }
    }
  } catch (const InputError&) {
    // the required answer to bad input
  }
  return 0;
}
