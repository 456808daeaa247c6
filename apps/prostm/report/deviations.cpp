#include "report/report.hpp"

namespace prostm::app {
namespace {

struct Deviation {
  const char *what, *paper, *here, *why, *where;
};

/// The deviations stated in docs/design, in the order of the pipeline.
constexpr Deviation kDeviations[] = {
    {"the smoke's pressure", "a pressure solve of unknown effort, 40 Jacobi sweeps as we take it",
     "two V-cycles of a multigrid method that start from the last step's pressure",
     "far less divergence is left in the same time (The smoke); the sweeps are a setting",
     "fluid.md, Pressure"},
    {"the hand in the smoke", "whole cells", "open fractions of faces",
     "a finger is as wide as a cell or two; whole cells are a setting", "fluid.md, Hands"},
    {"visible skin and its plane", "a plane fitted to the visible cells",
     "rays that end on the hand's surface, and a plane that is weighted by how far skin faces the "
     "array and is held by the palm where little is in sight",
     "rasters and heights neither flip nor jump while a hand turns", "contact.md"},
    {"units of the costs", "not given, nor the weights",
     "pressures over the field's highest, mm, rad; weights 3, 3, 1 and 0.3",
     "a plan does not depend on the unit of pressure", "(P6)"},
    {"the bending cost", "arctan of a ratio", "atan2 of cross and dot product",
     "a turn by 180° would be free, and one by 90° has no arctan", "(P5)"},
    {"the length cost", "pulls every path to L, though paths need only be shorter",
     "the same in presets paper and paper-valid; best bounds the length",
     "paths about small contacts grow far around them", "(P3)"},
    {"clusters without extent", "not mentioned", "start as thin ellipses",
     "a doubled line starts with samples that coincide", "planner.md, Tours"},
    {"limits after refinement", "soft costs; a path of its Fig. 2 is longer than L",
     "paper: the same, counted and reported; paper-valid and best: always kept",
     "a path that is too long is drawn less than 50 times a second", "planner.md, Presets"},
    {"the default planner", "initialisation and refinement",
     "preset best, which lowers the error of the field of Eq. (1) itself",
     "a lower cost is not a better field (Quality)", "(P11)"},
    {"one plan and the next", "each field from the beginning",
     "best continues from the previous plan, and compares with a plan from scratch",
     "paths move less from update to update, and new contacts are still found",
     "planner-fit.md, From plan to plan"},
    {"length on uneven skin", "measured in the plane",
     "speed on the skin; best, fast and felt bound the length there, too",
     "a lap on curved skin takes longer than its plane says", "(E1)"},
    {"the fall-off of a focal point", "σ = 8.6 mm, the wavelength",
     "8.6 mm wherever the paper is compared; otherwise best takes the width of the array's own "
     "focus",
     "a focus of a 16 × 16 array is about half as wide", "(A22)"},
    {"drives of the array", "the device's own, closed", "a weighted Gerchberg-Saxton solver",
     "the array is simulated, and open arrays take phases", "(A16)"},
    {"the AM baseline", "foci at cells of the skin, no rule for ties",
     "foci in the fitted plane, lifted to the skin; a focus without skin within 5 σ is left out",
     "as paths are; such a focus would ask for an enormous pressure", "(B1) to (B3)"},
    {"the study's test", "a z over all answers", "that, and tests over participants",
     "answers of one participant are alike (Fig. 4)", "study.md, Thresholds"},
};

}  // namespace

void make_deviations(const ReportWork&, nlohmann::ordered_json& document) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const Deviation& d : kDeviations) {
    rows.push_back({{"what", d.what},
                    {"paper", d.paper},
                    {"here", d.here},
                    {"why", d.why},
                    {"where", d.where}});
  }
  document["blocks"].push_back(report::text_block(
      "Where the paper is silent, unclear or improved on. The last column is the place in "
      "docs/design."));
  document["blocks"].push_back(report::table_block("From the smoke to the study",
                                                   {{"what", "what"},
                                                    {"paper", "the paper"},
                                                    {"here", "prostm"},
                                                    {"why", "why"},
                                                    {"where", "where"}},
                                                   rows));
  report::add_verdicts(document["blocks"],
                       {report::not_comparable("This part lists decisions; it measures nothing.")});
}

}  // namespace prostm::app
