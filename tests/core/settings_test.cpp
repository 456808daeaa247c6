#include "prostm/core/settings.hpp"

#include <gtest/gtest.h>

#include <array>
#include <stdexcept>

namespace prostm {
namespace {

enum class Colour { Red, Green, Blue };

}  // namespace

template <>
inline constexpr std::array<std::string_view, 3> kNames<Colour> = {"red", "green", "blue"};

namespace {

struct Paint {
  double litres = 1.0;
  int coats = 2;
  Colour colour = Colour::Green;
  bool glossy = false;
  std::string maker = "a \"b\" \\ \n";
  void visit(SettingsReader& v) const { list(*this, v); }
  void visit(SettingsWriter& v) { list(*this, v); }

 private:
  template <class Self, class Visitor>
  static void list(Self& s, Visitor& v) {
    v.field({"litres", "l", 0.1, 10, "in the pot"}, s.litres);
    v.field({"coats", "", 1, 5, "on the wall"}, s.coats);
    v.field({.name = "colour", .help = "of it"}, s.colour);
    v.field({.name = "glossy", .help = "whether it shines"}, s.glossy);
    v.field({.name = "maker", .help = "who made it"}, s.maker);
  }
};

template <class Call>
std::string refusal(const Call& call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Names, ConvertBothWays) {
  for (const Colour colour : {Colour::Red, Colour::Green, Colour::Blue})
    EXPECT_EQ(from_name<Colour>(name_of(colour), "colour"), colour);
  EXPECT_FALSE(value_named<Colour>("violet").has_value());
  EXPECT_EQ(refusal([] { from_name<Colour>("violet", "colour"); }),
            "colour \"violet\" is unknown: it must be red, green or blue");
}

TEST(Names, SuggestTheNearest) {
  EXPECT_EQ(refusal([] { from_name<Colour>("gren", "colour"); }),
            "colour \"gren\" is unknown: it must be red, green or blue; did you mean \"green\"?");
}

TEST(Bounds, AreFormattedForReaders) {
  EXPECT_EQ(bounds_text({"speed", "m/s", 0.1, 100}), "0.1 to 100 m/s");
  EXPECT_EQ(bounds_text({"tries", "", 0, 2147483647}), "0 to 2147483647");
  EXPECT_EQ(bounds_text({"pressure", "Pa", 1e-300, 1e300}), "1e-300 to 1e300 Pa");
  EXPECT_EQ(bounds_text({.name = "age", .unit = "s", .least = 0}), "at least 0 s");
  EXPECT_EQ(bounds_text({.name = "age", .most = -1}), "at most -1");
  EXPECT_EQ(bounds_text({.name = "any"}), "");
}

TEST(SettingRows, FollowTheListInTheOrderOfTheFile) {
  Paint paint;
  paint.litres = 8.6e-3;
  const std::vector<SettingRow> rows =
      setting_rows([&paint](SettingsReader& v) { std::as_const(paint).visit(v); });
  ASSERT_EQ(rows.size(), 5u);
  const auto shown = [](const SettingRow& row) {
    return std::string(row.setting.name) + " (" + row.type + ") = " + row.value + ", " + row.bounds;
  };
  EXPECT_EQ(shown(rows[0]), "litres (float) = 0.0086, 0.1 to 10 l");
  EXPECT_EQ(shown(rows[1]), "coats (integer) = 2, 1 to 5");
  EXPECT_EQ(shown(rows[2]), "colour (string) = \"green\", red, green or blue");
  EXPECT_EQ(shown(rows[3]), "glossy (boolean) = false, true or false");
  EXPECT_EQ(shown(rows[4]), "maker (string) = \"a \\\"b\\\" \\\\ \\u000a\", ");
  EXPECT_EQ(rows[2].choices, (std::vector<std::string_view>{"red", "green", "blue"}));
  EXPECT_STREQ(rows[0].setting.help, "in the pot");
}

TEST(Bounds, AreCheckedForEverySetting) {
  Paint paint;
  EXPECT_EQ(refusal([&] { require_bounds(paint); }), "accepted");
  paint.litres = 11.0;
  EXPECT_EQ(refusal([&] { require_bounds(paint); }), "litres = 11 l must be between 0.1 and 10 l");
  paint.litres = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(refusal([&] { require_bounds(paint); }), "accepted");
  paint = {};
  paint.coats = 0;
  EXPECT_EQ(refusal([&] { require_bounds(paint); }), "coats = 0 must be between 1 and 5");
}

/// Sets every field to a different value.
class Changer : public SettingsWriter {
 public:
  void field(const Setting&, double& value) override { value *= 2.0; }
  void field(const Setting&, int& value) override { ++value; }
  void field(const Setting&, bool& value) override { value = !value; }
  void field(const Setting&, std::string& value) override { value += "!"; }
  void choice(const Setting&, std::span<const std::string_view> names, int& index) override {
    index = (index + 1) % static_cast<int>(names.size());
  }
};

TEST(SettingsGroup, ReadsAndWritesItsMembers) {
  Paint paint;
  Changer changer;
  const SettingsGroup group = group_of("paint", paint);
  group.write(changer);
  EXPECT_EQ(paint.litres, 2.0);
  EXPECT_EQ(paint.coats, 3);
  EXPECT_EQ(paint.colour, Colour::Blue);
  const Paint fixed;
  EXPECT_FALSE(group_of("fixed", fixed).write);
}

}  // namespace
}  // namespace prostm
