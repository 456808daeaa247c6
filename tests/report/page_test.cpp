#include "prostm/report/page.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "prostm/core/file/file.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/report/detail/inline_svg.hpp"
#include "prostm/report/verdict.hpp"

namespace prostm::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kPicture =
    "<?xml version=\"1.0\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"20pt\" "
    "viewBox=\"0 0 20 10\"><g id=\"glyph\"><path d=\"M 1.23456 -0.5 L 12 3.1\"/></g>"
    "<use xlink:href=\"#glyph\"/><g clip-path=\"url(#glyph)\"/></svg>";

Part part_with(const Json& blocks) {
  return {"a-part",
          {{"format", "prostm-report-part/1"},
           {"title", "A & B"},
           {"asked", {{"seed", 1}}},
           {"values", {{"n", 7}, {"x", -0.0004}, {"word", "<b>"}}},
           {"blocks", blocks},
           {"timing", Json::array()}}};
}

std::string html_of(const Json& blocks) {
  const Part part = part_with(blocks);
  return page_html("T", std::span(&part, 1), [](const std::string&) { return kPicture; });
}

bool has(const std::string& text, const std::string& piece) {
  return text.find(piece) != text.npos;
}

TEST(Page, EscapesCharactersThatHtmlInterprets) {
  const std::string page = html_of(Json::array({text_block("1 < 2 {/values/word}")}));
  EXPECT_TRUE(has(page, "1 &lt; 2 <span data-from=\"a-part.json#/values/word\">&lt;b&gt;</span>"));
  EXPECT_TRUE(has(page, ">A &amp; B</h2>"));
}

TEST(Page, RoundsWithoutANegativeZero) {
  EXPECT_EQ(rounded(-0.0004, 3), "0.000");
  EXPECT_EQ(rounded(-0.0006, 3), "-0.001");
  EXPECT_EQ(rounded(2.5e6, 0), "2500000");
}

TEST(Page, RecordsThePositionOfEachNumber) {
  const std::string page = html_of(Json::array(
      {text_block("{/values/n} and {/values/x:2}"),
       table_block("T", {{"a", "A", "mm", 1}}, Json::array({{{"a", 1.26}}, {{"a", nullptr}}}))}));
  EXPECT_TRUE(
      has(page, "<span data-from=\"a-part.json#/values/n\" data-digits=\"0\" class=\"n\">7<"));
  EXPECT_TRUE(has(page, "#/values/x\" data-digits=\"2\" class=\"n\">0.00<"));
  EXPECT_TRUE(has(page, "#/blocks/1/table/rows/0/a\" data-digits=\"1\" class=\"n\">1.3</td>"));
  EXPECT_TRUE(has(page, "#/blocks/1/table/rows/1/a\" class=\"n\">–</td>"));
  EXPECT_TRUE(has(page, "<small data-from=\"a-part.json#/blocks/1/table/columns/0/unit\">mm<"));
}

TEST(Page, ARowMayHaveItsOwnDigitsAndBeMarked) {
  const std::string page = html_of(Json::array({table_block(
      "T", {{"a", "A"}}, Json::array({{{"a", 1.0}, {"digits", 0}, {"marked", true}}}))}));
  EXPECT_TRUE(has(page, "<tr class=\"marked\">"));
  EXPECT_TRUE(has(page, "data-digits=\"0\" class=\"n\">1</td>"));
}

TEST(Page, RejectsPointersWithoutATarget) {
  EXPECT_THROW(html_of(Json::array({text_block("{/values/none}")})), std::invalid_argument);
  EXPECT_THROW(html_of(Json::array({text_block("{/values")})), std::invalid_argument);
  EXPECT_THROW(html_of(Json::array({text_block("{/values}")})), std::invalid_argument);
  EXPECT_THROW(html_of(Json::array({Json{{"film", "x"}}})), std::invalid_argument);
}

TEST(Page, ShowsVerdictsAndOpenBlocksAtOnceAndFoldsTheRest) {
  Json blocks = Json::array({text_block("folded"), open_block(text_block("shown"))});
  add_verdicts(blocks,
               {not_comparable("<no> number."), compare("It is", 9.0, {5.0, 8.0}, {1, " m/s"})});
  const std::string page = html_of(blocks);
  const std::size_t details = page.find("<details>");
  ASSERT_NE(details, page.npos);
  EXPECT_LT(page.find(">shown<"), details);
  EXPECT_GT(page.find(">folded<"), details);
  EXPECT_LT(page.find("class=\"verdict differs\""), page.find("class=\"verdict not-comparable\""));
  EXPECT_LT(page.find("&lt;no&gt; number."), details);
  EXPECT_FALSE(has(html_of(Json::array({open_block(text_block("shown"))})), "<details>"));
}

TEST(Page, LeavesOutPartsWithoutBlocks) {
  EXPECT_FALSE(has(html_of(Json::array()), "a-part"));
}

TEST(Page, PicturesOfOnePageShareNoIdentifiers) {
  const std::string page = html_of(Json::array(
      {figure_block("one.svg", "", "first \"picture\""), figure_block("two.svg", "", "second")}));
  for (const char* name : {"one", "two"}) {
    EXPECT_TRUE(has(page, std::string(" id=\"") + name + "-glyph\""));
    EXPECT_TRUE(has(page, std::string(" href=\"#") + name + "-glyph\""));
    EXPECT_TRUE(has(page, std::string("url(#") + name + "-glyph)"));
  }
  EXPECT_TRUE(has(page, "aria-label=\"first &quot;picture&quot;\""));
  EXPECT_FALSE(has(page, "http"));
  EXPECT_FALSE(has(page, "<?xml"));
}

TEST(Page, OutlinesAreRoundedToHundredths) {
  EXPECT_TRUE(has(detail::inline_svg(kPicture, "p"), "d=\"M 1.23 -0.5 L 12 3.1\""));
  EXPECT_THROW(detail::inline_svg("<p>", "p"), std::invalid_argument);
  EXPECT_THROW(detail::inline_svg("<svg>", "p"), std::invalid_argument);
}

class Folder : public testing::Test {
 protected:
  // each case is a separate process, and they run at the same time
  std::string name_ = testing::TempDir() + "report_parts_" +
                      testing::UnitTest::GetInstance()->current_test_info()->name();
  void SetUp() override { std::filesystem::remove_all(name_); }
};

TEST_F(Folder, APartIsReadIfItsInputsMatch) {
  const PartFolder folder(name_);
  Part part = part_with(Json::array({figure_block("f.svg", "", "")}));
  folder.write(part);
  EXPECT_FALSE(folder.read("a-part", {{"seed", 1}})) << "its picture is missing";
  write_file(folder.path("f.svg"), kPicture);
  ASSERT_TRUE(folder.read("a-part", {{"seed", 1}}));
  EXPECT_EQ(folder.read("a-part", {{"seed", 1}})->document, part.document);
  EXPECT_FALSE(folder.read("a-part", {{"seed", 2}}));
  EXPECT_FALSE(folder.read("another", {{"seed", 1}}));
}

TEST_F(Folder, ABrokenPartIsNotRead) {
  const PartFolder folder(name_);
  for (const char* text : {"", "{", "[]", "{\"format\": \"prostm-report-part/1\"}",
                           "{\"format\": \"prostm-report-part/1\", \"asked\": {\"seed\": 1}, "
                           "\"blocks\": 3, \"timing\": []}"}) {
    write_file(folder.path("a-part.json"), text);
    EXPECT_FALSE(folder.read("a-part", {{"seed", 1}})) << text;
  }
}

TEST_F(Folder, AFileIsRejectedAsAFolder) {
  write_file(name_, "x");
  EXPECT_THROW(PartFolder{name_}, InputError);
  std::filesystem::remove(name_);
}

}  // namespace
}  // namespace prostm::report
