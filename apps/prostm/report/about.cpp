#include "prostm/commit.hpp"
#include "report/report.hpp"

namespace prostm::app {
namespace {

nlohmann::ordered_json open_text(const std::string& text) {
  return report::open_block(report::text_block(text));
}

}  // namespace

void make_about(const ReportWork& work, nlohmann::ordered_json& document) {
  document["values"] = {{"version", version_text()}, {"seed", work.seed}, {"quick", work.quick}};
  auto& blocks = document["blocks"];
  blocks.push_back(open_text(
      "prostm {/values/version} computed everything on this page, with seed {/values/seed}: the "
      "tables and figures of the paper on path routing optimisation for spatiotemporal modulation "
      "(Barreiro, Sinclair and Otaduy), its baseline, amplitude modulation, on the same fields, "
      "and "
      "both played by an array and felt by a model of the skin. Each number comes from a file of "
      "this run; report.json has them all."));
  blocks.push_back(open_text(
      "Nobody has felt any of this: the array is simulated, and so is the skin. Only Fig. 4 has "
      "answers of people, those of the paper's own study. Rows on a shaded background are the "
      "paper's, from its own machine and its own scenes; compare them with ours only by their "
      "order "
      "of magnitude."));
}

}  // namespace prostm::app
