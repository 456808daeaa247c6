#include "prostm/methods/gallery.hpp"

#include <gtest/gtest.h>

#include "prostm/core/file/file.hpp"
#include "prostm/fields/fields.hpp"
#include "support/input_errors.hpp"

namespace prostm::methods {
namespace {

TEST(Gallery, ShowsFieldsAndPercepts) {
  const test::TemporaryFolder folder;
  const auto bytes_of = [&](const std::vector<GalleryTarget>& targets) {
    draw_gallery_of_ways(targets, folder.file("a.png"));
    return read_file(folder.file("a.png"));
  };
  GalleryTarget target{"one-plume", fields::make(fields::Pattern::OnePlume, 50, 16), {}};
  Rendering rendering;
  rendering.plan = circle_at_mean_distance(target.target, GainLaw(), 0.01, 0.2);
  rendering.of_felt.skill_8 = 0.9;
  rendering.felt.largest = 2e-7;
  target.renderings.fill(rendering);
  const std::vector<GalleryTarget> all(1, target);
  const std::string whole = bytes_of(all);
  EXPECT_TRUE(whole == bytes_of(all));

  std::vector<GalleryTarget> changed = all;
  changed[0].renderings[2].felt.largest *= 2.0;
  EXPECT_FALSE(bytes_of(changed) == whole);
  changed = all;
  changed[0].renderings[3].of_felt.skill_8 -= 0.1;
  EXPECT_FALSE(bytes_of(changed) == whole);
  changed = all;
  changed[0].renderings[1].plan.paths[0].pressure[0] *= 2.0;
  EXPECT_FALSE(bytes_of(changed) == whole) << "the field";
  changed[0].renderings[1].felt_at_all = false;
  const std::string unfelt = bytes_of(changed);
  changed[0].renderings[1].felt.largest *= 2.0;
  EXPECT_TRUE(bytes_of(changed) == unfelt) << "a loop that is too long has no percept";
}

}  // namespace
}  // namespace prostm::methods
