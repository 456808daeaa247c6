#include "prostm/pipeline/realtime/machine.hpp"

#include <sys/utsname.h>

#include <cstdlib>

#include "prostm/commit.hpp"
#include "report/report.hpp"

namespace prostm::app {
namespace {

/// Returns the mean number of programs that were ready to run during the last minute.
double load() {
  double mean = 0.0;
  return getloadavg(&mean, 1) == 1 ? mean : 0.0;
}

nlohmann::ordered_json row(const char* what, nlohmann::ordered_json value, int digits = 0) {
  return {{"what", what}, {"value", std::move(value)}, {"digits", digits}};
}

}  // namespace

void make_machine(const ReportWork& work, nlohmann::ordered_json& document) {
  const Machine machine =
      look_at_machine(work.full_or_quick(1.0, 0.3, "s of timed sleeps", document));
  utsname system{};
  uname(&system);
  document["values"] = {{"version", version_text()}, {"seed", work.seed}};
  document["blocks"].push_back(report::text_block(
      "prostm {/values/version}, seed {/values/seed}. The same version with the same seed gives "
      "the "
      "same numbers on every machine, but for the tables of times and this one."));
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  rows.push_back(row("processor", machine.cpu.empty() ? "unknown" : machine.cpu));
  rows.push_back(row("cores that prostm may use", machine.cores));
  rows.push_back(row("vector instructions", machine.vectors));
  rows.push_back(row("kernel", std::string(system.sysname) + " " + system.release));
  rows.push_back(row("compiler", std::string("version ") + __VERSION__));
  rows.push_back(row("real-time priority", machine.realtime_priority));
  rows.push_back(row("programs ready to run, mean of the last minute", load(), 2));
  rows.push_back(row("a sleep of 1 ms ends late by, p50 [ms]", 1e3 * machine.sleep_late.p50, 3));
  rows.push_back(row("the same, p99 [ms]", 1e3 * machine.sleep_late.p99, 3));
  rows.push_back(row("the same, max [ms]", 1e3 * machine.sleep_late.max, 3));
  document["timing"].push_back(
      report::table_block("This machine", {{"what", "what"}, {"value", "value", "", 2}}, rows));
  report::add_verdicts(document["blocks"],
                       {report::not_comparable("The paper's times are from another machine.")});
}

}  // namespace prostm::app
