#include <fmt/format.h>

#include "study/study.hpp"

namespace prostm::app {

void print_missing(std::FILE* out, const std::vector<MissingAnswers>& missing) {
  if (missing.empty()) return;
  std::vector<std::string> scenes, methods;
  for (const MissingAnswers& of : missing) {
    scenes.push_back(of.scene);
    methods.push_back(of.method);
  }
  const std::size_t scene = width_of("scene", scenes), method = width_of("method", methods);
  fmt::print(out, "  {:<{}}  {:<{}} {:>17} {:>6} {:>13}\n", "scene", scene, "method", method,
             "without an answer", "%", "participants");
  for (const MissingAnswers& of : missing) {
    fmt::print(out, "  {:<{}}  {:<{}} {:>10}/{:<6} {:>6.1f} {:>13}\n", of.scene, scene, of.method,
               method, of.missing, of.trials, 100.0 * of.missing / of.trials, of.participants);
  }
  fmt::print(out, "\n");
}

nlohmann::ordered_json missing_json(const std::vector<MissingAnswers>& missing) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const MissingAnswers& of : missing) {
    out.push_back({{"scene", of.scene},
                   {"method", of.method},
                   {"missing", of.missing},
                   {"trials", of.trials},
                   {"participants", of.participants},
                   {"if_answered", {of.if_answered.low, of.if_answered.high}}});
  }
  return out;
}

}  // namespace prostm::app
