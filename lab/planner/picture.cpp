#include "planner/picture.hpp"

#include <algorithm>
#include <cctype>

#include "planner/as_played.hpp"
#include "prostm/fields/fields.hpp"
#include "prostm/figure/figures.hpp"
#include "prostm/plan/quasi_static/quasi_static.hpp"

namespace prostm::bench {
namespace {

GalleryPlan plan_for_gallery(Contender& contender, const TargetField& target) {
  GalleryPlan out;
  out.name = contender.name();
  PlanStats stats;
  contender.begin(target.size());
  contender.plan(target, out.plan, stats);
  const PlanSettings& s = contender.settings();
  out.rendered.resize(target.size());
  const SegmentPressures pressures = played(target, out.plan, s);
  quasi_static_field(out.plan, 0, target, s.sigma, s.gain_law(), out.rendered, &pressures);
  out.metrics = score_plan(target, out.plan, 0, s.sigma, s.gain_law(), &pressures);
  return out;
}

/// Turns a name like "one-plume" into a heading.
std::string heading(std::string name) {
  std::replace(name.begin(), name.end(), '-', ' ');
  name.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(name.front())));
  return name;
}

}  // namespace

void draw_gallery_picture(const std::string& path) {
  std::vector<Contender> shown;
  for (Contender& contender : presets()) {
    if (contender.name() != "fast") shown.push_back(std::move(contender));
  }
  std::vector<GalleryField> list;
  for (const fields::Pattern pattern : fields::kPatterns) {
    GalleryField field;
    field.name = heading(to_string(pattern));
    field.target = fields::make(pattern, fields::kFrames / 2);
    for (Contender& contender : shown) {
      field.plans.push_back(plan_for_gallery(contender, field.target));
    }
    list.push_back(std::move(field));
  }
  draw_gallery({"Nine targets and what is planned for them"}, list, path);
}

}  // namespace prostm::bench
