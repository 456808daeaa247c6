#include "prostm/figure/detail/canvas.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>

#include "prostm/core/file/file.hpp"
#include "prostm/figure/detail/colours.hpp"
#include "prostm/io/field/field_file.hpp"
#include "support/full_disk.hpp"
#include "support/input_errors.hpp"

namespace prostm::figure {
namespace {

using test::input_error;
using testing::HasSubstr;
using testing::Not;

/// Returns the page's luminances, row 0 at the bottom, two pixels per point.
TargetField pixels_of(Canvas& canvas, const std::string& path) {
  canvas.save();
  return read_field(path, {.cell_mm = 1.0});
}

/// Returns CIE L*, 0 black to 100 white.
double lightness(const Colour& c) {
  const auto linear = [](double x) {
    return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
  };
  const double y = 0.2126 * linear(c.r) + 0.7152 * linear(c.g) + 0.0722 * linear(c.b);
  return y > 0.008856 ? 116.0 * std::cbrt(y) - 16.0 : 903.3 * y;
}

TEST(Canvas, PutsTheFirstRowOfCellsAtTheBottom) {
  const test::TemporaryFolder folder;
  Canvas canvas(folder.file("a.png"), 40, 30);
  canvas.cells({10, 5, 20, 20}, 2, 2, [](int row, int col) {
    const double grey = 0.2 + 0.4 * row + 0.2 * col;
    return Colour{grey, grey, grey};
  });
  const TargetField page = pixels_of(canvas, folder.file("a.png"));
  ASSERT_EQ(page.rows, 60);
  ASSERT_EQ(page.cols, 80);
  const auto at = [&](double x, double y) {
    return page.pressure[page.index(59 - static_cast<int>(2 * y), static_cast<int>(2 * x))];
  };
  EXPECT_NEAR(at(15, 20), 0.2, 0.01);
  EXPECT_NEAR(at(25, 20), 0.4, 0.01);
  EXPECT_NEAR(at(15, 10), 0.6, 0.01);
  EXPECT_NEAR(at(25, 10), 0.8, 0.01);
  EXPECT_NEAR(at(19.2, 15.8), 0.2, 0.01);  // sharp up to the edge
  EXPECT_EQ(at(5, 15), 1.0);
}

TEST(Canvas, ClipsDrawing) {
  const test::TemporaryFolder folder;
  Canvas canvas(folder.file("a.png"), 20, 20);
  canvas.clip({0, 0, 10, 20});
  canvas.fill({0, 0, 20, 20}, {0, 0, 0});
  canvas.unclip();
  const TargetField page = pixels_of(canvas, folder.file("a.png"));
  EXPECT_EQ(page.pressure[page.index(20, 5)], 0.0);
  EXPECT_EQ(page.pressure[page.index(20, 35)], 1.0);
}

TEST(Canvas, WritesTextAtItsPosition) {
  const test::TemporaryFolder folder;
  Canvas canvas(folder.file("a.png"), 60, 20);
  const TextStyle style{.size = 14.0, .colour = {0, 0, 0}, .align = Align::Right};
  EXPECT_GT(canvas.text_width("mmm", style), 2.0 * canvas.text_width("m", style));
  canvas.text(Vec2(58, 15), "m", style);
  const TargetField page = pixels_of(canvas, folder.file("a.png"));
  double left = 0.0, right = 0.0;
  for (int row = 0; row < page.rows; ++row) {
    for (int col = 0; col < page.cols; ++col) {
      (col < 60 ? left : right) += 1.0 - page.pressure[page.index(row, col)];
    }
  }
  EXPECT_EQ(left, 0.0);
  EXPECT_GT(right, 20.0);
}

TEST(Canvas, ShortensTextBetweenCharacters) {
  const test::TemporaryFolder folder;
  Canvas canvas(folder.file("a.png"), 60, 20);
  const TextStyle style{.size = 14.0};
  const std::string text = "äöüß and more";
  const double width = canvas.text_width(text, style);
  EXPECT_EQ(canvas.shortened(text, width, style), text);
  for (double w = width - 1.0; w > 20.0; w -= 3.0) {
    std::string shorter = canvas.shortened(text, w, style);
    EXPECT_LE(canvas.text_width(shorter, style), w);
    ASSERT_TRUE(shorter.ends_with("…"));
    shorter.resize(shorter.size() - std::string("…").size());
    EXPECT_TRUE(text.starts_with(shorter));
    EXPECT_NE(static_cast<unsigned char>(text[shorter.size()]) & 0xC0U, 0x80U);
  }
  EXPECT_EQ(canvas.shortened(text, 0.0, style), "…");
}

TEST(Canvas, ReportsWhyItCannotWrite) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(input_error([&] { Canvas(folder.file("a.gif"), 10, 10); }),
              HasSubstr("must end in .png, .svg or .pdf"));
  for (const char* name : {"none/a.png", "none/a.svg", "none/a.pdf"}) {
    Canvas canvas(folder.file(name), 10, 10);
    EXPECT_THAT(input_error([&] { canvas.save(); }),
                AllOf(HasSubstr(name), HasSubstr("No such file")));
  }
  std::filesystem::create_directory(folder.file("b.png"));
  Canvas canvas(folder.file("b.png"), 10, 10);
  EXPECT_THAT(input_error([&] { canvas.save(); }), HasSubstr("b.png is a folder"));
  EXPECT_EQ(folder.entries(), 1u);
}

TEST(Canvas, KeepsTheOldFileWhenTheDiskIsFull) {
  const test::TemporaryFolder folder;
  for (const char* name : {"a.png", "a.svg", "a.pdf"}) {
    const std::string path = folder.file(name);
    write_file(path, "old");
    Canvas canvas(path, 100, 100);
    std::string sentence;
    {
      const test::FullDisk disk(50);
      sentence = input_error([&] { canvas.save(); });
    }
    EXPECT_THAT(sentence, AllOf(HasSubstr(name), HasSubstr("File too large")));
    EXPECT_EQ(read_file(path), "old");
  }
  EXPECT_EQ(folder.entries(), 3u);
}

TEST(Canvas, WritesVectorGraphics) {
  const test::TemporaryFolder folder;
  Canvas canvas(folder.file("a.svg"), 30, 20);
  canvas.disc(Vec2(10, 10), 5, kInk);
  canvas.save();
  EXPECT_THAT(read_file(folder.file("a.svg")), AllOf(HasSubstr("<svg"), HasSubstr("</svg>")));
}

TEST(Canvas, WritesPagesWithoutATimestamp) {
  const test::TemporaryFolder folder;
  Canvas canvas(folder.file("a.pdf"), 30, 20);
  canvas.disc(Vec2(10, 10), 5, kInk);
  canvas.save();
  const std::string page = read_file(folder.file("a.pdf"));
  EXPECT_TRUE(page.starts_with("%PDF"));
  EXPECT_THAT(page, AllOf(HasSubstr("%%EOF"), Not(HasSubstr("CreationDate"))));
}

TEST(FieldColour, IncreasesEvenlyInLightness) {
  double previous = 0.0, smallest = 100.0, largest = 0.0;
  for (int i = 0; i <= 100; ++i) {
    const Colour c = field_colour(i / 100.0);
    for (const double channel : {c.r, c.g, c.b}) {
      EXPECT_GE(channel, 0.0);
      EXPECT_LE(channel, 1.0);
    }
    const double now = lightness(c);
    if (i > 0) {
      smallest = std::min(smallest, now - previous);
      largest = std::max(largest, now - previous);
    }
    previous = now;
  }
  EXPECT_GT(smallest, 0.4);
  EXPECT_LT(largest, 1.6);
  EXPECT_LT(lightness(field_colour(0.0)), 15.0);
  EXPECT_GT(lightness(field_colour(1.0)), 85.0);
  EXPECT_EQ(lightness(field_colour(-1.0)), lightness(field_colour(0.0)));
  EXPECT_EQ(lightness(field_colour(2.0)), lightness(field_colour(1.0)));
}

}  // namespace
}  // namespace prostm::figure
