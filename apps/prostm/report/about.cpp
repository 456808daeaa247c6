#include "prostm/commit.hpp"
#include "report/report.hpp"

namespace prostm::app {

void make_about(const ReportWork& work, nlohmann::ordered_json& document) {
  using report::text_block;
  document["values"] = {{"version", version_text()}, {"seed", work.seed}, {"quick", work.quick}};
  auto& blocks = document["blocks"];
  if (work.quick) {
    blocks.push_back(text_block(
        "This is a quick report: it has fewer fields, hands and speeds than a whole one, so its "
        "numbers are rougher. Make a whole one without --quick."));
  }
  blocks.push_back(text_block(
      "prostm {/values/version} computed all that stands here, with seed {/values/seed}: the "
      "tables and figures of the paper on path routing optimisation for spatiotemporal modulation "
      "(Barreiro, Sinclair and Otaduy), what amplitude modulation, its baseline, makes of the same "
      "fields, and what an array and the skin make of both. Each number comes from a file of this "
      "run; report.json has them all."));
  blocks.push_back(text_block(
      "Nobody has felt any of this: the array is simulated, and so is the skin. Only Fig. 4 has "
      "answers of people, those of the paper's own study. Rows on a shaded ground are the paper's, "
      "from its own machine and its own scenes; they stand beside ours, but nothing makes them "
      "comparable in more than their order of magnitude."));
  if (!work.paper_file("fig4.json") || !work.paper_file("fig2.json")) {
    blocks.push_back(text_block(
        "The paper's figures as data were not all there, so parts are missing: the scores of its "
        "participants (fig4.json) and the steps of its algorithm (fig2.json, fig2.field.json). "
        "--paper-data names their folder."));
  }
}

}  // namespace prostm::app
