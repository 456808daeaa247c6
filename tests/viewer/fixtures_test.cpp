/// The encoder, and files that keep it consistent with the page's decoder.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "prostm/core/file/file.hpp"
#include "prostm/score/score.hpp"
#include "prostm/viewer/wire.hpp"
#include "support/heap_guard.hpp"
#include "support/places.hpp"

namespace prostm {
namespace {

using Json = nlohmann::ordered_json;
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

/// A frame, with the large sections sent along with it.
struct Fixture {
  std::string name;
  ViewFrame frame;
  bool with_smoke = true, with_fields = true;
};

ViewHand some_hand(std::uint32_t id, std::uint32_t side) {
  ViewHand hand{id, side, 0.5F, {}};
  for (std::size_t j = 0; j < hand.joints.size(); ++j) {
    const auto at = static_cast<float>(j);
    const float s = std::sin(0.1F * at), c = std::cos(0.1F * at);
    hand.joints[j] = {0.01F * at, -0.002F * at, 0.2F, 0.0F, s, 0.0F, c, 0.008F};
  }
  return hand;
}

ViewField some_field(std::uint32_t rows, std::uint32_t cols) {
  ViewField f;
  f.rows = rows;
  f.cols = cols;
  f.cell = 0.0056F;
  f.origin = {-0.01F, 0.02F};
  f.X_DP = {1, 0, 0, 0.01F, 0, 0.8F, -0.6F, 0.02F, 0, 0.6F, 0.8F, 0.2F};
  f.scale = 0.75F;
  f.height_scale = 1e-5F;
  for (std::uint32_t i = 0; i < rows * cols; ++i) {
    f.target.push_back(static_cast<std::uint16_t>(i * 4369 % 65536));
    f.rendered.push_back(static_cast<std::uint16_t>(65535 - i * 1000));
    f.height.push_back(static_cast<std::int16_t>(static_cast<int>(i) * 300 - 1000));
    f.skin.push_back(i % 3 != 0 ? 1 : 0);
  }
  return f;
}

ViewPath some_path(std::uint32_t patch, int points) {
  ViewPath path{0, patch, 0.12F, 7.0F, 0.0175F, 0.0F, 0.0F, {}};
  for (int i = 0; i < points; ++i) {
    const float x = 0.01F * std::cos(0.5F * static_cast<float>(i));
    const float y = 0.01F * std::sin(0.5F * static_cast<float>(i));
    path.points.push_back({x, y, 0.1F * static_cast<float>(i), x, y + 0.02F, 0.21F});
  }
  return path;
}

ViewFrame some_frame(std::uint32_t sequence) {
  ViewFrame frame;
  frame.sequence = sequence;
  frame.run = {12.34, 2.5, 617, 308, kViewHandInSight};
  for (std::size_t i = 0; i < frame.numbers.size(); ++i)
    frame.numbers[i] = 0.125F * static_cast<float>(i);
  return frame;
}

std::vector<Fixture> fixtures() {
  std::vector<Fixture> all;

  Fixture empty{"no-hand", some_frame(1)};
  empty.frame.run = {0.02, std::numeric_limits<double>::quiet_NaN(), 1, 0, 0};
  empty.frame.numbers.assign(view_number_names().size(), kNone);
  empty.frame.numbers[kWorldMs] = 7.25F;
  empty.frame.smoke = {4, {-0.18F, -0.18F, 0.0F}, 0.36F, std::vector<std::uint8_t>(64)};
  for (std::size_t i = 0; i < 64; ++i)
    empty.frame.smoke.density[i] = static_cast<std::uint8_t>(4 * i);
  all.push_back(empty);

  Fixture one{"one-hand", some_frame(2)};
  one.frame.run.flags |= kViewPageHand;
  one.frame.hand_count = 1;
  one.frame.hands[0] = some_hand(3, 1);
  one.frame.smoke = empty.frame.smoke;
  one.frame.field_count = 1;
  one.frame.fields = {some_field(3, 5)};
  one.frame.path_count = 2;
  one.frame.paths = {some_path(0, 12), some_path(0, 8)};
  one.frame.gate = {true,   0.875F,  "none",  "64 cm² are pressed, as they should be.", 4, 0.875F,
                    0.625F, 0.0064F, 0.45e-3F};
  all.push_back(one);

  Fixture two{"two-hands", some_frame(4'000'000'000U)};
  two.frame.run.flags |= kViewPaused | kViewFading;
  two.frame.hand_count = 2;
  two.frame.hands = {some_hand(1, 0), some_hand(2, 1)};
  two.frame.field_count = 2;
  two.frame.fields = {some_field(2, 2), some_field(4, 3)};
  two.frame.path_count = 2;
  two.frame.paths = {some_path(0, 9), some_path(1, 10)};
  for (ViewPath& path : two.frame.paths) path.loop = 0.035F;
  two.with_smoke = false;
  all.push_back(two);

  Fixture foci{"foci", some_frame(5)};
  foci.frame.hand_count = 1;
  foci.frame.hands[0] = some_hand(9, 0);
  foci.frame.path_count = 3;
  for (std::uint32_t i = 0; i < 3; ++i) {
    const float x = 0.01F * static_cast<float>(i);
    const float phase = 0.25F * static_cast<float>(i);
    foci.frame.paths.push_back(
        {1, 0, 0.0F, 0.0F, 0.005F, 0.0F, phase, {{x, -x, 0.3F, x, -x, 0.2F}}});
  }
  foci.with_smoke = foci.with_fields = false;
  all.push_back(foci);
  return all;
}

/// Returns null for a number that JSON cannot represent.
Json number(double value) {
  return std::isnan(value) ? Json(nullptr) : Json(value);
}

/// Returns the values expected from the decoder, in wire units.
Json to_json(const Fixture& fixture) {
  const ViewFrame& f = fixture.frame;
  Json json = {{"version", kWireVersion},
               {"sequence", f.sequence},
               {"run",
                {{"time", f.run.time},
                 {"recording_time", number(f.run.recording_time)},
                 {"world_steps", f.run.world_steps},
                 {"plan_updates", f.run.plan_updates},
                 {"flags", f.run.flags}}}};
  for (std::size_t i = 0; i < f.numbers.size(); ++i)
    json["numbers"][std::string(view_number_names()[i])] =
        number(static_cast<double>(f.numbers[i]));
  json["hands"] = Json::array();
  for (std::size_t i = 0; i < f.hand_count; ++i) {
    const ViewHand& h = f.hands[i];
    json["hands"].push_back(
        {{"id", h.id}, {"side", h.side}, {"confidence", h.confidence}, {"joints", h.joints}});
  }
  json["smoke"] = nullptr;
  if (fixture.with_smoke) {
    json["smoke"] = {{"n", f.smoke.n},
                     {"corner", f.smoke.corner},
                     {"edge", f.smoke.edge},
                     {"density", f.smoke.density}};
  }
  json["fields"] = nullptr;
  if (fixture.with_fields) {
    json["fields"] = Json::array();
    for (std::size_t i = 0; i < f.field_count; ++i) {
      const ViewField& p = f.fields[i];
      json["fields"].push_back({{"rows", p.rows},
                                {"cols", p.cols},
                                {"cell", p.cell},
                                {"origin", p.origin},
                                {"X_DP", p.X_DP},
                                {"scale", p.scale},
                                {"height_scale", p.height_scale},
                                {"target", p.target},
                                {"rendered", p.rendered},
                                {"height", p.height},
                                {"skin", p.skin}});
    }
  }
  json["plan"] = Json::array();
  for (std::size_t i = 0; i < f.path_count; ++i) {
    const ViewPath& p = f.paths[i];
    json["plan"].push_back({{"kind", p.kind},
                            {"patch", p.patch},
                            {"length", p.length},
                            {"speed", p.speed},
                            {"period", p.period},
                            {"loop", p.loop},
                            {"phase", p.phase},
                            {"points", p.points}});
  }
  json["gate"] = nullptr;
  if (f.gate) {
    json["gate"] = {
        {"passed", f.gate->passed},   {"share", f.gate->share},     {"maxima", f.gate->maxima},
        {"balance", f.gate->balance}, {"saddle", f.gate->saddle},   {"area", f.gate->area},
        {"force", f.gate->force},     {"problem", f.gate->problem}, {"sentence", f.gate->sentence}};
  }
  return json;
}

std::string fixture_file(const std::string& name) {
  return test::source_file("web/fixtures/" + name);
}

std::string message(const Fixture& fixture) {
  std::vector<std::uint8_t> out;
  encode(fixture.frame, fixture.with_smoke, fixture.with_fields, out);
  return {out.begin(), out.end()};
}

// PROSTM_WRITE_FIXTURES=1 rewrites the files after an intended change of the format.
TEST(Wire, FixturesMatchTheEncoder) {
  const bool write = std::getenv("PROSTM_WRITE_FIXTURES") != nullptr;
  for (const Fixture& fixture : fixtures()) {
    SCOPED_TRACE(fixture.name);
    const std::string bytes = message(fixture), json = to_json(fixture).dump() + "\n";
    if (write) {
      write_file(fixture_file(fixture.name + ".bin"), bytes);
      write_file(fixture_file(fixture.name + ".json"), json);
    }
    EXPECT_TRUE(read_file(fixture_file(fixture.name + ".bin")) == bytes);
    EXPECT_EQ(read_file(fixture_file(fixture.name + ".json")), json);
  }
}

// Walks through a message by the document alone: the header, then each section by its stated
// length.
TEST(Wire, SectionsAreWhereTheDocumentStates) {
  for (const Fixture& fixture : fixtures()) {
    SCOPED_TRACE(fixture.name);
    const std::string bytes = message(fixture);
    const auto u16 = [&](std::size_t at) {
      return static_cast<unsigned>(static_cast<unsigned char>(bytes.at(at)) |
                                   static_cast<unsigned char>(bytes.at(at + 1)) << 8);
    };
    const auto u32 = [&](std::size_t at) {
      return static_cast<std::size_t>(u16(at)) + (static_cast<std::size_t>(u16(at + 2)) << 16);
    };
    EXPECT_EQ(bytes.substr(0, 4), "PSTM");
    EXPECT_EQ(u16(4), 2U);
    EXPECT_EQ(u32(8), fixture.frame.sequence);
    EXPECT_EQ(u32(12), bytes.size());
    std::vector<unsigned> ids;
    std::size_t at = 16;
    for (unsigned left = u16(6); left > 0; --left) {
      EXPECT_EQ(at % 8, 0U);
      ids.push_back(u16(at));
      const std::size_t length = u32(at + 4);
      if (ids.back() == 3) {
        EXPECT_EQ(length, 864U * fixture.frame.hand_count);
      }
      at += 8 + (length + 7) / 8 * 8;
    }
    EXPECT_EQ(at, bytes.size());
    std::vector<unsigned> expected = {1, 2, 3};
    if (fixture.with_smoke) expected.push_back(4);
    if (fixture.with_fields) expected.push_back(5);
    expected.push_back(6);
    if (fixture.frame.gate) expected.push_back(7);
    EXPECT_EQ(ids, expected);
  }
}

TEST(Wire, DoesNotAllocateOnceTheBufferHasGrown) {
  const std::vector<Fixture> all = fixtures();
  std::vector<std::uint8_t> out;
  for (const Fixture& f : all) encode(f.frame, f.with_smoke, f.with_fields, out);
  out.reserve(1 << 16);
  const test::HeapGuard guard;
  for (const Fixture& f : all) encode(f.frame, f.with_smoke, f.with_fields, out);
  EXPECT_EQ(guard.allocations(), 0U);
}

TEST(Wire, NumbersHaveDistinctNames) {
  const auto names = view_number_names();
  ASSERT_GE(names.size(), static_cast<std::size_t>(kPlacedNumbers));
  EXPECT_EQ(names[kSpill], "spill");
  EXPECT_EQ(names[kFeltSkill], "felt_skill");
  EXPECT_EQ(names.back(), "sensation_level");
  for (std::size_t m = 0; m < quantities<Metrics>().size(); ++m)
    EXPECT_EQ(names[view_metric_places()[m]], quantities<Metrics>()[m].name);
  for (std::size_t i = 0; i < names.size(); ++i) {
    EXPECT_FALSE(names[i].empty());
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(names[i], names[j]);
  }
}

}  // namespace
}  // namespace prostm
