#include "prostm/io/array_file.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "io/examples.hpp"
#include "prostm/core/random.hpp"

namespace prostm {
namespace {

using test::input_error;
using testing::HasSubstr;

std::string example() {
  return R"({"format": "prostm-array/1", "name": "two", "frequency_hz": 40000, "radius_mm": 4.5,
 "directivity": "piston", "amplitude_pa_m": 3.4, "amplitude_interval_pa_m": [2.5, 8],
 "measured_amplitude_pa_m": 1.1, "transducers_mm": [[-5, 0, 0], [5, 0.5, 0]], "normals": [[0, 0, 1], [0.6, 0, 0.8]]})";
}

TransducerArray random_array(Random& random) {
  TransducerArray array;
  array.name = "random \"array\" 5 µm";
  array.frequency = random.uniform(20e3, 100e3);
  array.radius = random.uniform(0.1e-3, 50e-3);
  array.directivity = static_cast<Directivity>(random.below(3));
  array.amplitude = random.uniform(1.0, 5.0);
  array.amplitude_low = array.amplitude - random.uniform();
  array.amplitude_high = array.amplitude + random.uniform();
  if (random.below(2) == 1) array.measured_amplitude = random.uniform(0.1, 5.0);
  const int count = 1 + random.below(40);
  for (int i = 0; i < count; ++i) {
    array.position.emplace_back(0.01 * i, random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
    array.normal.push_back(Vec3(random.normal(), random.normal(), random.normal()).normalized());
  }
  return array;
}

void expect_same(const TransducerArray& a, const TransducerArray& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.frequency, b.frequency);
  EXPECT_NEAR(a.radius, b.radius, 1e-17);
  EXPECT_EQ(a.directivity, b.directivity);
  EXPECT_EQ(a.amplitude, b.amplitude);
  EXPECT_EQ(a.amplitude_low, b.amplitude_low);
  EXPECT_EQ(a.amplitude_high, b.amplitude_high);
  EXPECT_EQ(a.measured_amplitude, b.measured_amplitude);
  ASSERT_EQ(a.position.size(), b.position.size());
  ASSERT_EQ(a.normal.size(), b.normal.size());
  for (std::size_t i = 0; i < a.position.size(); ++i) {
    EXPECT_LT((a.position[i] - b.position[i]).norm(), 1e-15);
    EXPECT_LT((a.normal[i] - b.normal[i]).norm(), 1e-15);
  }
}

TEST(ArrayFile, RoundTripsAnyArray) {
  Random random(41);
  for (int trial = 0; trial < 200; ++trial) {
    const TransducerArray array = random_array(random);
    expect_same(array_from_json(array_to_json(array), "a.json"), array);
  }
  for (const TransducerArray& array : {usx_array(), autd3_array()}) {
    const std::string text = array_to_json(array);
    EXPECT_EQ(text.find("normals"), text.npos);  // all normals are +z
    const TransducerArray back = array_from_json(text, "a.json");
    expect_same(back, array);
    EXPECT_EQ(back.normal, array.normal);
    EXPECT_EQ(array_to_json(back), text);
  }
}

TEST(ArrayFile, ReadsEveryMember) {
  const TransducerArray array = array_from_json(example(), "a.json");
  EXPECT_EQ(array.name, "two");
  EXPECT_EQ(array.frequency, 40e3);
  EXPECT_DOUBLE_EQ(array.radius, 4.5e-3);
  EXPECT_EQ(array.directivity, Directivity::Piston);
  EXPECT_EQ(array.amplitude, 3.4);
  EXPECT_EQ(array.amplitude_low, 2.5);
  EXPECT_EQ(array.amplitude_high, 8.0);
  EXPECT_EQ(array.measured_amplitude, 1.1);
  ASSERT_EQ(array.position.size(), 2u);
  EXPECT_EQ(array.position[1], Vec3(0.005, 0.0005, 0.0));
  EXPECT_TRUE(array.normal[1].isApprox(Vec3(0.6, 0.0, 0.8), 1e-15));
}

TEST(ArrayFile, NormalsIntervalAndMeasurementAreOptional) {
  auto json = nlohmann::json::parse(example());
  json.erase("normals");
  json.erase("amplitude_interval_pa_m");
  json.erase("measured_amplitude_pa_m");
  const TransducerArray array = array_from_json(json.dump(), "a.json");
  EXPECT_EQ(array.normal[0], Vec3::UnitZ());
  EXPECT_EQ(array.normal[1], Vec3::UnitZ());
  EXPECT_EQ(array.amplitude_low, 3.4);
  EXPECT_EQ(array.amplitude_high, 3.4);
  EXPECT_EQ(array.measured_amplitude, 0.0);
}

TEST(ArrayFile, NearlyUnitNormalsAreNormalised) {
  const auto with = [](const char* normal) {
    return array_from_json(test::replaced(example(), "[0, 0, 1]", normal), "a.json").normal[0];
  };
  EXPECT_EQ(with("[0, 0, 1.0009]"), Vec3::UnitZ());
  EXPECT_EQ(with("[0, -0.9991, 0]"), Vec3(0.0, -1.0, 0.0));
  EXPECT_NEAR(with("[0.577, 0.577, 0.577]").norm(), 1.0, 1e-15);
}

TEST(ArrayFile, ReportsErrors) {
  test::expect_refused(
      example(), "a.json",
      {
          {"prostm-array/1", "prostm-plan/1", "must be \"prostm-array/1\""},
          {"\"name\": \"two\"", "\"name\": 2", "\"name\" is 2; it must be a string"},
          {"40000", "19999", "\"frequency_hz\" is 19999; it must be from 20000 to 100000"},
          {"40000", "100001", "\"frequency_hz\" is 100001; it must be from 20000 to 100000"},
          {"4.5", "0", "\"radius_mm\" is 0; it must be from 0.1 to 50"},
          {"\"piston\"", "\"horn\"",
           R"("directivity" is not a directivity; it must be "piston", "t4010a1" or "omni")"},
          {"\"amplitude_pa_m\"", "\"amplitude\"", "no member \"amplitude\"; known are"},
          {"\"amplitude_pa_m\": 3.4,", "", "\"amplitude_pa_m\" is missing; it must be"},
          {"3.4", "0", "\"amplitude_pa_m\" is 0; it must be from"},
          {"[2.5, 8]", "[2.5]", "has 1 numbers; it must have 2"},
          {"[2.5, 8]", "[3.5, 8]",
           "is [3.5, 8]; it must be [low, high] with \"amplitude_pa_m\" = 3.4 in it"},
          {"[2.5, 8]", "[2.5, 3]", "it must be [low, high]"},
          {"[[-5, 0, 0], [5, 0.5, 0]]", "[]",
           "has 0 transducers; an array must have from 1 to 4096"},
          {"[-5, 0, 0]", "[-5, 0]", "[0] has 2 numbers; it must have 3"},
          {"[-5, 0, 0]", "[-5, NaN, 0]", "is not valid JSON at line 3"},
          {"[-5, 0, 0]", "[-5, null, 0]", "[0][1] is null; it must be a number"},
          {"[-5, 0, 0]", "[-5, 1e9, 0]", "must be from -10000 to 10000"},
          {"[-5, 0, 0]", "[5, 0.5, 0.05]",
           "transducers 0 and 1 (from 0) are at the same place; they must be at least 0.1 mm"},
          {"[0, 0, 1], ", "", "has 1 normals; it must have one for each of the 2 transducers"},
          {"[0, 0, 1]", "[0, 0, 0]", "[0] has the length 0; it must be a unit vector"},
          {"[0, 0, 1]", "[0, 0, 0.998]", "[0] has the length 0.998; it must be a unit vector"},
          {"[0, 0, 1]", "[0, 0, 2]", "[0][2] is 2; it must be from"},
      },
      [](const std::string& text) { array_from_json(text, "a.json"); });
}

TEST(ArrayFile, RejectsTooManyTransducers) {
  const auto with = [](int count) {
    auto json = nlohmann::json::parse(example());
    json.erase("normals");
    json["transducers_mm"] = nlohmann::json::array();
    for (int i = 0; i < count; ++i) json["transducers_mm"].push_back({0, 0, 0.5 * i});
    return json.dump();
  };
  EXPECT_EQ(array_from_json(with(4096), "a.json").position.size(), 4096u);
  EXPECT_THAT(input_error([&] { array_from_json(with(4097), "a.json"); }),
              HasSubstr("has 4097 transducers; an array must have from 1 to 4096"));
}

}  // namespace
}  // namespace prostm
