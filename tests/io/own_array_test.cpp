/// An array that prostm does not know, added to the table by another program.

#include <gmock/gmock.h>

#include <vector>

#include "prostm/io/array_file.hpp"
#include "support/input_errors.hpp"

namespace prostm {
namespace {

using testing::HasSubstr;

/// Eight transducers of the first row of usx_array().
TransducerArray row_array() {
  TransducerArray array = usx_array();
  array.name = "row";
  array.position.resize(8);
  array.normal.resize(8);
  return array;
}

std::vector<ArrayKind> kinds_with_row() {
  std::vector<ArrayKind> kinds(array_kinds().begin(), array_kinds().end());
  kinds.push_back({"row", row_array});
  return kinds;
}

TEST(OwnArray, IsKnownByItsName) {
  const std::vector<ArrayKind> kinds = kinds_with_row();
  const TransducerArray array = array_from_name("row", kinds);
  EXPECT_EQ(array.position.size(), 8U);
  EXPECT_NO_THROW(validate(array));
  EXPECT_EQ(array_choices(" (default)", kinds),
            "usx (default), autd3, row, or an array file (.json)");
}

TEST(OwnArray, IsSuggestedForAMisspelling) {
  const std::vector<ArrayKind> kinds = kinds_with_row();
  const std::string sentence = test::input_error([&] { array_from_name("rows", kinds); });
  EXPECT_THAT(sentence, HasSubstr("it must be usx, autd3, row, or an array file"));
  EXPECT_THAT(sentence, HasSubstr("did you mean"));
  EXPECT_THAT(test::input_error([] { array_from_name("row"); }), HasSubstr("array row is unknown"));
}

}  // namespace
}  // namespace prostm
