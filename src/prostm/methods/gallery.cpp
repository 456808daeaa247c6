#include "prostm/methods/gallery.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <span>
#include <utility>

#include "prostm/core/run_all.hpp"
#include "prostm/fields/fields.hpp"
#include "prostm/figure/figures.hpp"
#include "prostm/plan/plan_settings.hpp"
#include "prostm/plan/quasi_static/quasi_static.hpp"

namespace prostm::methods {
namespace {

/// Turns a name like "one-plume" into a heading.
std::string heading(std::string name) {
  std::ranges::replace(name, '-', ' ');
  name.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(name.front())));
  return name;
}

GalleryPlan shown(Way way, const Rendering& rendering, const TargetField& target) {
  const PlanSettings paper;
  GalleryPlan out = {to_string(way), rendering.plan, std::vector<double>(target.size()),
                     rendering.of_model};
  quasi_static_field(out.plan, 0, target, paper.sigma, paper.gain_law(), out.rendered);
  if (rendering.felt_at_all)
    out.second_caption = fmt::format("felt S₈.₅ {:.2f} · {:.2f} µm", rendering.of_felt.skill_8,
                                     1e6 * rendering.felt.largest);
  return out;
}

}  // namespace

std::vector<GalleryTarget> render_gallery(std::size_t targets,
                                          const std::function<void(double)>& progress) {
  constexpr int kFrame = fields::kFrames / 2;
  const std::size_t count = targets * kGalleryWays.size();
  std::vector<GalleryTarget> out;
  for (const fields::Pattern pattern : std::span(fields::kPatterns).first(targets))
    out.push_back({to_string(pattern), fields::make(pattern, kFrame), {}});
  std::atomic<int> done = 0;
  WorkerPool pool(2);
  run_all(pool, static_cast<int>(count), [&](int i) {
    const auto rendering = static_cast<std::size_t>(i);
    GalleryTarget& of = out[rendering / kGalleryWays.size()];
    const std::size_t w = rendering % kGalleryWays.size();
    Renderer renderer(usx_array(), out.front().target, 1);
    of.renderings[w] = renderer.render(kGalleryWays[w], of.target);
    progress(static_cast<double>(++done) / static_cast<double>(count));
  });
  return out;
}

void draw_gallery_of_ways(const std::vector<GalleryTarget>& targets, const std::string& path) {
  std::vector<GalleryField> fields;
  for (const GalleryTarget& of : targets) {
    GalleryField& field = fields.emplace_back(GalleryField{heading(of.name), of.target, {}});
    for (std::size_t w = 0; w < kGalleryWays.size(); ++w)
      field.plans.push_back(shown(kGalleryWays[w], of.renderings[w], of.target));
  }
  GalleryPage page;
  page.title = "Targets and what is planned for them";
  page.note =
      "RMSE and S₈.₅ by Eq. (1); felt: S₈.₅ and strength of the percept by the skin model, with "
      "the "
      "16 × 16 array at full output.";
  page.fields_in_row = 2;
  draw_gallery(page, fields, path);
}

}  // namespace prostm::methods
