#include <cmath>
#include <nlohmann/json.hpp>

#include "io/examples.hpp"
#include "io/random_field.hpp"
#include "prostm/core/file/file.hpp"
#include "prostm/core/text/json.hpp"
#include "prostm/io/field/field_file.hpp"
#include "support/shared.hpp"

namespace prostm {
namespace {

using test::input_error;
using testing::HasSubstr;

constexpr const char* kField =
    R"({"format": "prostm-field/1", "cell_mm": 5, "origin_mm": [-10, 20.5],
 "rows": 2, "cols": 3, "pressure": [[0, 1.5, null], [2e-3, 4, 0.25]],
 "height_mm": [[1, 2, null], [3, 4.5, -6]],
 "weight": [[1, 7, null], [0, 1.5, 2]],
 "plane": {"origin_mm": [1, 2, 180], "x": [0, 1, 0], "y": [-1, 0, 0]}})";

TEST(FieldJson, ReadsEveryMember) {
  const TargetField field = field_from_json(kField, "a.json");
  validate(field);
  EXPECT_EQ(field.rows, 2);
  EXPECT_EQ(field.cols, 3);
  EXPECT_EQ(field.cell, 0.005);
  EXPECT_EQ(field.origin, Vec2(-0.01, 0.0205));
  EXPECT_THAT(field.pressure, testing::ElementsAre(0, 1.5, 0, 2e-3, 4, 0.25));
  EXPECT_THAT(field.skin, testing::ElementsAre(1, 1, 0, 1, 1, 1));
  EXPECT_EQ(field.height[4], 0.0045);
  EXPECT_TRUE(field.height[2] == 0.002 || field.height[2] == -0.006);  // from a cell with skin
  EXPECT_THAT(field.weight, testing::ElementsAre(1, 7, 0, 0, 1.5, 2));
  EXPECT_TRUE(
      (field.X_DP * Vec3(0.01, 0.02, 0.03)).isApprox(Vec3(0.001 - 0.02, 0.002 + 0.01, 0.21)));
}

TEST(FieldJson, LiesAboveTheArrayByDefault) {
  const TargetField field = field_from_json(
      R"({"format":"prostm-field/1","cell_mm":1,"origin_mm":[0,0],"rows":1,"cols":1,"pressure":[[3]]})",
      "a");
  EXPECT_TRUE(field.X_DP.isApprox(TargetField::default_plane()));
  EXPECT_EQ(field.height[0], 0.0);
  EXPECT_TRUE(field.weight.empty());
}

TEST(FieldJson, RoundTripsExactly) {
  Random random(5);
  for (int trial = 0; trial < 200; ++trial) {
    const TargetField field = test::random_field(random);
    const std::string text = field_to_json(field);
    const TargetField back = field_from_json(text, "a.json");
    test::expect_same_raster(back, field);
    EXPECT_TRUE(back.X_DP.isApprox(field.X_DP, 1e-14));
    EXPECT_EQ(field_to_json(back), text);
  }
}

TEST(FieldJson, AcceptsNearlyOrthonormalAxes) {
  const TargetField field =
      field_from_json(test::replaced(kField, "[0, 1, 0], \"y\": [-1, 0, 0]",
                                     "[0, 1.0000004, 0], \"y\": [-1, 3e-7, 0]"),
                      "a");
  EXPECT_NO_THROW(validate(field));
  EXPECT_NEAR(
      (field.X_DP.linear().transpose() * field.X_DP.linear() - Eigen::Matrix3d::Identity()).norm(),
      0.0, 1e-15);
}

TEST(FieldJson, ReportsErrors) {
  test::expect_refused(
      kField, "a.json",
      {
          {"prostm-field/1", "prostm-field/2", "must be \"prostm-field/1\""},
          {"\"format\": \"prostm-field/1\", ", "", "\"format\" is missing"},
          {"\"cell_mm\": 5", "\"cell_mm\": 0", "\"cell_mm\" is 0; it must be the edge of a cell"},
          {"\"cell_mm\": 5", "\"cell_mm\": -5", "\"cell_mm\" is -5"},
          {"\"cell_mm\": 5", "\"cell_mm\": 1e200", "\"cell_mm\" is 1e+200"},
          {"\"cell_mm\": 5", "\"cell_mm\": \"5\"", "\"cell_mm\" is \"5\"; it must be a number"},
          {"\"cell_mm\": 5, ", "", "\"cell_mm\" is missing; it must be the edge"},
          {"[-10, 20.5]", "[-10]", "\"origin_mm\" has 1 numbers; it must have 2"},
          {"[-10, 20.5]", "[-10, 1e12]", "\"origin_mm\"[1] is 1000000000000"},
          {"\"rows\": 2", "\"rows\": 3", "\"pressure\" has 2 rows; it must have \"rows\" = 3"},
          {"\"rows\": 2, \"cols\": 3", "\"rows\": 20000, \"cols\": 20000",
           "from 1 to 1000000 cells"},
          {"\"rows\": 2", "\"rows\": 0", "has 0 x 3 cells"},
          {"\"rows\": 2", "\"rows\": 2.5", "\"rows\" is 2.5; it must be a whole number"},
          {"2e-3, 4, 0.25", "2e-3, 4",
           "\"pressure\"[1] has 2 numbers; every row must have \"cols\" = 3"},
          {"2e-3, 4, 0.25", "2e-3, -4, 0.25", "pressure at row 1, column 1 is -4"},
          {"2e-3, 4, 0.25", "2e-3, 4e200, 0.25", "pressure at row 1, column 1 is 4e+200"},
          {"2e-3, 4, 0.25", "2e-3, \"4\", 0.25", "\"pressure\"[1][1] is not a number"},
          {"2e-3, 4, 0.25", "2e-3, NaN, 0.25", "not valid JSON at line 2, column 60"},
          {"[3, 4.5, -6]", "[3, null, -6]", "\"height_mm\"[1][1] is null; there is skin"},
          {"[[1, 2, null], ", "[", "\"height_mm\" has 1 rows; it must have \"rows\" = 2"},
          {"[3, 4.5, -6]", "[3, 4.5]", "\"height_mm\"[1] has 2 numbers"},
          {"[0, 1.5, 2]", "[0, null, 2]", "\"weight\"[1][1] is null; there is skin"},
          {"[0, 1.5, 2]", "[0, -1.5, 2]", "\"weight\"[1][1] is -1.5; it must be from 0 to"},
          {"[0, 1.5, 2]", "[0, 1e200, 2]", "\"weight\"[1][1] is 1e+200; it must be from 0 to"},
          {"[0, 1.5, 2]", "[0, \"a\", 2]", "\"weight\"[1][1] is not a number"},
          {"[0, 1.5, 2]", "[0, 1.5]", "\"weight\"[1] has 2 numbers; every row must have"},
          {"[[1, 7, null], [0, 1.5, 2]]", "[[0, 0, null], [0, 0, 0]]",
           "\"weight\" is 0 on all skin; at least one weight must be above 0"},
          {"[[1, 7, null], ", "[", "\"weight\" has 1 rows"},
          {"[0, 1, 0]", "[0, 1.1, 0]", "unit vectors at a right angle"},
          {"[0, 1, 0]", "[-1, 0, 0]", "unit vectors at a right angle"},
          {"[0, 1, 0]", "[0, 1]", "\"plane\".x has 2 numbers; it must have 3"},
          {"\"x\": [0, 1, 0], ", "", "\"plane\".x is missing"},
          {"{\"origin_mm\": [1, 2, 180]", "{\"origin_mm\": [1, null, 180]",
           "is null; it must be a number"},
          {"[-1, 0, 0]", "[1, 0, 0]", "\"plane\" faces away from the array"},
          {"\"height_mm\"", "\"hieght_mm\"",
           "the document has no member \"hieght_mm\"; did you mean \"height_mm\"?"},
          {"\"weight\"", "\"notes\"", "no member \"notes\"; known are format, cell_mm"},
          {"\"origin_mm\": [1, 2, 180]", "\"origin\": [1, 2, 180], \"origin_mm\": [1, 2, 180]",
           "\"plane\" has no member \"origin\""},
      },
      [](const std::string& text) { field_from_json(text, "a.json"); });
}

TEST(FieldJson, ReportsThePositionOfASyntaxError) {
  const std::string text = kField;
  EXPECT_THAT(input_error([&] { field_from_json(text.substr(0, text.size() / 2), "a.json"); }),
              HasSubstr("ends too early"));
  EXPECT_THAT(input_error([&] { field_from_json("\n  x", "a.json"); }),
              HasSubstr("line 2, column 3"));
  EXPECT_THAT(input_error([&] { field_from_json("[1]", "a.json"); }),
              HasSubstr("must be an object"));
  EXPECT_THAT(input_error([&] { field_from_json(std::string(1000000, '['), "a.json"); }),
              HasSubstr("deeper than 32"));
  EXPECT_NO_THROW(
      parse_json("[\"" + std::string(100, '[') + "\\\"" + std::string(100, '{') + "\"]", "a"));
}

TEST(FieldJson, RejectsNumbersOutsideTheRangeOfDoubles) {
  const test::WithoutTraps scope;
  EXPECT_THAT(input_error([&] {
                field_from_json(test::replaced(kField, "4, 0.25", "1e999, 0.25"), "a.json");
              }),
              HasSubstr("the number '1e999' is out of range"));
}

TEST(FieldJson, EveryCutAndFlipIsRejectedOrValid) {
  Random random(8);
  const std::string text = kField;
  for (int trial = 0; trial < 3000; ++trial) {
    std::string broken =
        text.substr(0, static_cast<std::size_t>(random.below(static_cast<int>(text.size()))));
    if (trial % 2 == 0) {
      broken = text;
      broken[static_cast<std::size_t>(random.below(static_cast<int>(text.size())))] =
          static_cast<char>(random.below(128));
    }
    const test::WithoutTraps scope;
    try {
      const TargetField field = field_from_json(broken, "a.json");
      EXPECT_NO_THROW(validate(field)) << broken;
    } catch (const InputError& e) {
      EXPECT_THAT(e.what(), testing::StartsWith("a.json: "));
    }
  }
}

TEST(ToMilli, ReadsBackExactlyWithFewDigits) {
  EXPECT_EQ(to_milli(0.0318), 31.8);
  EXPECT_EQ(to_milli(0.14), 140.0);
  Random random(2);
  for (int trial = 0; trial < 10000; ++trial) {
    const double mm = random.uniform(-500.0, 500.0);
    EXPECT_EQ(from_milli(to_milli(from_milli(mm))), from_milli(mm));
  }
}

TEST(ReadField, ChoosesTheFormatByExtensionAndChecksOptions) {
  const test::TemporaryFolder folder;
  const std::string json = folder.file("a.json");
  write_file(json, kField);
  EXPECT_EQ(read_field(json).size(), 6u);
  FieldFileOptions options;
  options.cell_mm = 5;
  EXPECT_THAT(input_error([&] { read_field(json, options); }), HasSubstr("leave out --cell-mm"));
  options = {};
  options.frame = 2;
  EXPECT_THAT(input_error([&] { read_field(json, options); }), HasSubstr("leave out --frame"));
  EXPECT_THAT(input_error([&] { read_field(folder.file("a.VTK")); }), HasSubstr("z, y, x"));
  EXPECT_THAT(input_error([&] { read_field(folder.file("a.tiff")); }),
              HasSubstr("of an unknown kind"));
  write_file(folder.file("a.npy"), "x");
  EXPECT_THAT(input_error([&] { read_field(folder.file("a.npy")); }), HasSubstr("--cell-mm"));
  EXPECT_THAT(input_error([&] { read_field(folder.file("b.json")); }), HasSubstr("cannot be read"));
}

TEST(ReadField, ReadsThePapersTarget) {
  PROSTM_NEEDS_SHARED("data/paper/fig2.field.json");
  const TargetField field = read_field(test::shared_file("data/paper/fig2.field.json"));
  validate(field);
  EXPECT_EQ(field.rows, 39);
  EXPECT_EQ(field.cols, 30);
}

}  // namespace
}  // namespace prostm
