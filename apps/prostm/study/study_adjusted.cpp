#include <fmt/format.h>

#include "prostm/core/input_error.hpp"
#include "prostm/study/analysis/adjusted.hpp"
#include "study/study.hpp"

namespace prostm::app {
namespace {

std::string number(const std::optional<double>& value) {
  return value ? fmt::format("{:.4g}", *value) : std::string("-");
}

nlohmann::ordered_json json_of(const std::optional<double>& value) {
  if (!value) return nullptr;
  return *value;
}

}  // namespace

void print_adjusted(std::FILE* out, const std::vector<AdjustedResult>& results) {
  std::vector<std::string> scenes, methods, participants = {"all"};
  for (const AdjustedResult& of : results) {
    scenes.push_back(of.scene);
    methods.push_back(of.method);
    for (const AdjustedBy& by : of.participants) participants.push_back(by.participant);
  }
  const std::size_t scene = width_of("scene", scenes), method = width_of("method", methods),
                    participant = width_of("participant", participants);
  const auto row = [&](const std::string& s, const std::string& m, const std::string& p,
                       const std::string& n, const std::string& mean, const std::string& sd,
                       const std::string& interval) {
    fmt::print(out, "  {:<{}}  {:<{}}  {:<{}} {:>11} {:>10} {:>10} {:>21}\n", s, scene, m, method,
               p, participant, n, mean, sd, interval);
  };
  row("scene", "method", "participant", "adjustments", "mean", "sd", "interval");
  for (const AdjustedResult& of : results) {
    int all = 0;
    for (const AdjustedBy& by : of.participants) all += by.adjustments;
    row(of.scene, of.method, "all", std::to_string(all), number(of.mean), number(of.deviation),
        of.interval ? fmt::format("{:.4g} to {:.4g}", of.interval->low, of.interval->high) : "-");
    for (const AdjustedBy& by : of.participants) {
      row(of.scene, of.method, by.participant, std::to_string(by.adjustments), number(by.mean),
          number(by.deviation), "");
    }
  }
}

nlohmann::ordered_json adjusted_json(const std::vector<AdjustedResult>& results, double level,
                                     const std::string& words) {
  nlohmann::ordered_json adjusted = nlohmann::ordered_json::array();
  for (const AdjustedResult& of : results) {
    nlohmann::ordered_json participants = nlohmann::ordered_json::array();
    for (const AdjustedBy& by : of.participants) {
      participants.push_back({{"participant", by.participant},
                              {"adjustments", by.adjustments},
                              {"mean", by.mean},
                              {"deviation", json_of(by.deviation)}});
    }
    nlohmann::ordered_json interval;
    if (of.interval) interval = {of.interval->low, of.interval->high};
    adjusted.push_back({{"scene", of.scene},
                        {"method", of.method},
                        {"mean", of.mean},
                        {"deviation", json_of(of.deviation)},
                        {"interval", interval},
                        {"participants", participants}});
  }
  return {{"format", "prostm-analysis/1"},
          {"kind", "adjusted"},
          {"level", level},
          {"adjusted", adjusted},
          {"words", words}};
}

}  // namespace prostm::app
