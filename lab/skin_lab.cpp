/// The skin under moving focal points: published experiments, computed with parameters that were
/// fixed beforehand, and the cost of a response.

#include "program.hpp"
#include "prostm/figure/figures.hpp"
#include "skin/tables.hpp"

int main(int argc, char** argv) {
  using namespace prostm;
  bench::Program program("the skin under moving focal points: published experiments");
  std::string folder;
  program.option("--figures", folder,
                 "folder in which to draw skin-circles.png, skin-squares.png, skin-lines.png, "
                 "skin-gap.png and skin-loops.png");
  return program.run(argc, argv, [&] {
    const auto figure = [&](const char* name) {
      return folder.empty() ? std::string() : folder + "/" + name;
    };
    if (!folder.empty()) check_figure(figure("skin-circles.png"));
    std::vector<bench::Row> rows;
    bench::measure_response(rows);
    bench::compute_circles(figure("skin-circles.png"), rows);
    bench::compute_squares(figure("skin-squares.png"), rows);
    bench::compute_regimes(figure("skin-lines.png"), rows);
    bench::compute_gap(figure("skin-gap.png"), rows);
    bench::compute_loops(figure("skin-loops.png"), rows);
    return rows;
  });
}
