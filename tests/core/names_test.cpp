#include "prostm/core/text/names.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "prostm/core/text/lower_case.hpp"
#include "prostm/core/text/nearest_name.hpp"
#include "prostm/core/text/number_text.hpp"

namespace prostm {
namespace {

TEST(NearestName, HasTheMostSimilarSpelling) {
  const std::vector<std::string> commands = {"run", "plan", "capture", "am"};
  EXPECT_EQ(nearest_name("runn", commands), "run");
  EXPECT_EQ(nearest_name("plann", commands), "plan");
  EXPECT_EQ(nearest_name("captrue", commands), "capture");
  EXPECT_EQ(nearest_name("aim", commands), "am");
  EXPECT_EQ(nearest_name("cap", commands), "capture");
  EXPECT_FALSE(nearest_name("dance", commands));
  // two wrong letters make it another name
  EXPECT_FALSE(nearest_name("xy", {"am"}));
  EXPECT_FALSE(nearest_name("foo", {"lap", "now"}));
  EXPECT_EQ(nearest_name("npw", {"lap", "now"}), "now");
  EXPECT_FALSE(nearest_name("x", {}));
}

TEST(Suggestion, NamesTheNearestOrAll) {
  EXPECT_EQ(suggestion("runn", {"run", "plan"}), "did you mean \"run\"?");
  EXPECT_EQ(suggestion("dance", {"run", "plan"}), "known are run, plan");
  EXPECT_EQ(suggestion("dance", {}), "no names are allowed here");
}

TEST(Listed, SeparatesThreeAndMoreByCommas) {
  EXPECT_EQ(listed({}), "");
  EXPECT_EQ(listed(std::vector<std::string>{"a"}), "a");
  EXPECT_EQ(listed(std::vector<std::string>{"a", "b"}), "a or b");
  EXPECT_EQ(listed(std::vector<std::string>{"a", "b (default)", "c"}, "and"),
            "a, b (default), and c");
}

TEST(LowerCase, ChangesOnlyAToZ) {
  EXPECT_EQ(lower_case("Leap.JSON @[`{"), "leap.json @[`{");
  EXPECT_EQ(lower_case("Ä Ω"), "Ä Ω");
  EXPECT_EQ(lower_case(""), "");
}

TEST(NumberText, HasTheFewestDigitsThatRoundTrip) {
  EXPECT_EQ(number_text(0.0086), "0.0086");
  EXPECT_EQ(number_text(0.1 + 0.2), "0.30000000000000004");
  EXPECT_EQ(number_text(-2.0), "-2");
  EXPECT_EQ(number_text(100'000), "100000");
  EXPECT_EQ(number_text(2147483647), "2147483647");
  EXPECT_EQ(number_text(1e300), "1e300");
  EXPECT_EQ(number_text(1e-6), "1e-6");
  EXPECT_EQ(number_text(1.5e-300), "1.5e-300");
  EXPECT_EQ(number_text(std::numeric_limits<double>::infinity()), "inf");
  EXPECT_EQ(number_text(std::numeric_limits<double>::quiet_NaN()), "nan");
}

}  // namespace
}  // namespace prostm
