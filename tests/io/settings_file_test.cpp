#include "prostm/io/settings_file.hpp"

#include <nlohmann/json.hpp>

#include "prostm/core/file/file.hpp"
#include "support/input_errors.hpp"

namespace prostm {
namespace {

enum class Heat { Low, High };

}  // namespace

template <>
inline constexpr std::array<std::string_view, 2> kNames<Heat> = {"low", "high"};

namespace {

using test::input_error;
using testing::HasSubstr;

struct Stove {
  double power = 1.5;
  int plates = 4;
  bool gas = false;
  std::string maker = "us";
  Heat heat = Heat::Low;
  int rings = 4;
  void visit(SettingsReader& v) const { list(*this, v); }
  void visit(SettingsWriter& v) {
    list(*this, v);
    if (v.replaced({"flame", "", 0, 3, "heat \"high\""})) heat = Heat::High;
  }

 private:
  template <class Self, class Visitor>
  static void list(Self& s, Visitor& v) {
    v.field({"power", "kW", 0, 10, "of all plates"}, s.power);
    v.field({"plates", "", -1, 8, "to cook on"}, s.plates);
    v.field({.name = "gas", .help = "whether it burns"}, s.gas);
    v.field({.name = "maker", .help = "who made it"}, s.maker);
    v.field({.name = "heat", .help = "how hot"}, s.heat);
    v.field({"rings", "", 0, 8, "of the plates"}, s.rings);
  }
};

struct Kitchen {
  Stove stove, oven;
  std::vector<SettingsGroup> groups() { return {group_of("stove", stove), group_of("oven", oven)}; }
};

TEST(Settings, SetTheGivenValuesAndKeepTheRest) {
  Kitchen kitchen;
  settings_from_toml(
      "[stove]\npower = 2\ngas = true\n[oven]\nmaker = \"them\"\nplates = -1\nheat = \"high\"\n",
      "s.toml", kitchen.groups());
  EXPECT_EQ(kitchen.stove.power, 2.0);
  EXPECT_TRUE(kitchen.stove.gas);
  EXPECT_EQ(kitchen.stove.plates, 4);
  EXPECT_EQ(kitchen.oven.maker, "them");
  EXPECT_EQ(kitchen.oven.plates, -1);
  EXPECT_EQ(kitchen.oven.power, 1.5);
  EXPECT_EQ(kitchen.oven.heat, Heat::High);
  EXPECT_EQ(kitchen.stove.heat, Heat::Low);
}

TEST(Settings, RoundTripThroughJson) {
  Kitchen kitchen;
  kitchen.stove.power = 0.1;
  kitchen.oven.maker = "a \"quoted\"\nname";
  const nlohmann::ordered_json json = settings_to_json(kitchen.groups());
  EXPECT_EQ(json["stove"]["power"].get<double>(), 0.1);
  EXPECT_EQ(json["stove"]["plates"], 4);
  EXPECT_EQ(json["stove"]["gas"], false);
  EXPECT_EQ(json["oven"]["maker"], "a \"quoted\"\nname");
  EXPECT_EQ(json["oven"]["heat"], "low");
}

TEST(Settings, ThatWereReplacedSetTheirReplacementWithAWarning) {
  for (const char* value : {"2", "0.5", "true"}) {
    Kitchen kitchen;
    const GivenSettings given = settings_from_toml(
        std::string("[oven]\nplates = 1\nflame = ") + value + "\n", "s.toml", kitchen.groups());
    EXPECT_THAT(given.warnings,
                testing::ElementsAre(
                    "s.toml, line 3: oven.flame was replaced by heat \"high\", which is used"));
    EXPECT_TRUE(given.has("oven.flame"));
    EXPECT_EQ(kitchen.oven.heat, Heat::High);
    EXPECT_EQ(kitchen.stove.heat, Heat::Low);
  }
  for (const char* value : {"0", "0.0", "false"}) {
    Kitchen kitchen;
    const GivenSettings given = settings_from_toml(std::string("[oven]\nflame = ") + value + "\n",
                                                   "s.toml", kitchen.groups());
    EXPECT_THAT(given.warnings, testing::IsEmpty());
    EXPECT_EQ(kitchen.oven.heat, Heat::Low);
  }
}

TEST(Settings, AreReadFromAFile) {
  const test::TemporaryFolder folder;
  Kitchen kitchen;
  write_file(folder.file("s.toml"), "stove.plates = 2\n");
  const GivenSettings given = read_settings(folder.file("s.toml"), kitchen.groups());
  EXPECT_THAT(given.names, testing::ElementsAre("stove.plates"));
  EXPECT_TRUE(given.has("stove.plates"));
  EXPECT_FALSE(given.has("stove.gas"));
  EXPECT_THAT(given.warnings, testing::IsEmpty());
  EXPECT_EQ(kitchen.stove.plates, 2);
  EXPECT_THAT(input_error([&] { read_settings(folder.file("none.toml"), kitchen.groups()); }),
              HasSubstr("cannot be read"));
}

TEST(Settings, MayBeAnEmptyFile) {
  const test::TemporaryFolder folder;
  Kitchen kitchen;
  for (const char* text : {"", "\n", "# nothing yet\n"}) {
    write_file(folder.file("s.toml"), text);
    EXPECT_THAT(read_settings(folder.file("s.toml"), kitchen.groups()).names, testing::IsEmpty());
  }
}

struct Wrong {
  const char* text;
  const char* sentence;
};

TEST(Settings, ReportErrorsWithTheirPosition) {
  const Wrong wrongs[] = {
      {"[stove]\npowr = 1",
       "s.toml, line 2: stove has no setting \"powr\"; did you mean \"power\"?"},
      {"[stove]\nxylophone = 1", "known are power, plates, gas, maker, heat, rings"},
      {"\n[stov]\npower = 1",
       "s.toml, line 2: there is no group of settings \"stov\"; did you mean \"stove\"?"},
      {"[bath]", "known are stove, oven"},
      {"stove = 1", "s.toml, line 1: stove must be a group of settings, written [stove]"},
      {"\npower = 1",
       "s.toml, line 2: \"power\" is outside a group of settings; did you mean [stove] power "
       "or "
       "[oven] power?"},
      {"[power]", "there is no group of settings \"power\""},
      {"[stove]\n\npower = 11", "s.toml, line 3: stove.power = 11 kW must be between 0 and 10 kW"},
      {"[stove]\nplates = -2", "s.toml, line 2: stove.plates = -2 must be between -1 and 8"},
      {"[stove]\npower = \"high\"", "s.toml, line 2: stove.power must be a number"},
      {"[stove]\nflame = 4", "s.toml, line 2: stove.flame = 4 must be between 0 and 3"},
      {"[stove]\nflame = \"hot\"", "s.toml, line 2: stove.flame must be a number"},
      {"[stove]\npower = inf", "stove.power must be finite"},
      {"[stove]\npower = nan", "stove.power must be finite"},
      {"[stove]\nplates = 2.0", "stove.plates must be a whole number"},
      {"[stove]\nplates = 3000000000", "stove.plates must fit into 32 bits"},
      {"[stove]\ngas = 1", "stove.gas must be true or false"},
      {"[stove]\nmaker = 1", "stove.maker must be a string in quotes"},
      {"[stove]\nheat = 1", "stove.heat must be a string in quotes"},
      {"[stove]\nheat = \"warm\"", "s.toml, line 2: stove.heat must be low or high"},
      {"[stove]\nheat = \"hgh\"", "must be low or high; did you mean \"high\"?"},
      {"{\"stove\": {}}", "s.toml: is JSON, not TOML"},
      {"\x89PNG\r\n\x1a\n", "s.toml: is a PNG picture, not TOML"},
      {"[stove]\npower = ", "s.toml, line 2, column 9: is not valid TOML"},
      {"[stove]\npower = 1\npower = 2", "is not valid TOML"},
  };
  for (const Wrong& wrong : wrongs) {
    Kitchen kitchen;
    EXPECT_THAT(input_error([&] { settings_from_toml(wrong.text, "s.toml", kitchen.groups()); }),
                HasSubstr(wrong.sentence))
        << wrong.text;
  }
}

}  // namespace
}  // namespace prostm
