#include "prostm/commit.hpp"
#include "report/report.hpp"

namespace prostm::app {

void make_about(const ReportWork& work, nlohmann::ordered_json& document) {
  using report::text_block;
  document["values"] = {{"version", version_text()},
                        {"seed", work.seed},
                        {"quick", work.quick},
                        {"am", 61},
                        {"pro_stm", 76}};
  auto& blocks = document["blocks"];
  blocks.push_back(text_block(
      "No model in prostm explains the paper's study. Its participants told one plume from four in "
      "{/values/am} % of trials with AM and in {/values/pro_stm} % with PRO-STM. Observers that "
      "know what both scenes feel like do it better with AM, unless their hand is placed anew in "
      "each trial: then they have 65 to 73 % with both methods. Observers that judge only whether "
      "there are dips between places do it better with PRO-STM, as people did. Neither spread as "
      "people did, and neither counts four points as well. The data are weak: eight people with "
      "each method, and p = 0.17 in a permutation test over people "
      "(docs/experiments/reversal.md)."));
  if (work.quick) {
    blocks.push_back(text_block(
        "This is a quick report: it has fewer fields, hands and speeds than a full one, so its "
        "numbers are rougher. Make a full one without --quick."));
  }
  blocks.push_back(text_block(
      "prostm {/values/version} computed everything on this page, with seed {/values/seed}: the "
      "tables and figures of the paper on path routing optimisation for spatiotemporal modulation "
      "(Barreiro, Sinclair and Otaduy), its baseline, amplitude modulation, on the same fields, "
      "and "
      "both played by an array and felt by a model of the skin. Each number comes from a file of "
      "this run; report.json has them all."));
  blocks.push_back(text_block(
      "Nobody has felt any of this: the array is simulated, and so is the skin. Only Fig. 4 has "
      "answers of people, those of the paper's own study. Rows on a shaded background are the "
      "paper's, from its own machine and its own scenes; compare them with ours only by their "
      "order "
      "of magnitude."));
  if (!work.paper_file("fig4.json") || !work.paper_file("fig2.json")) {
    blocks.push_back(text_block(
        "Some of the paper's own data were not found, so parts are missing: the scores of its "
        "participants (fig4.json) and the steps of its algorithm (fig2.json, fig2.field.json). "
        "Name their folder with --paper-data."));
  }
}

}  // namespace prostm::app
