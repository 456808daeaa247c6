#pragma once
/// A page to draw on, as PNG, SVG or PDF. Private to figure. Coordinates are in points, y down.

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "prostm/core/geometry.hpp"
#include "prostm/figure/detail/colours.hpp"

namespace prostm::figure {

enum class Align : std::uint8_t { Left, Centre, Right };

struct TextStyle {
  double size = 12.0;
  Colour colour = kInk;
  Align align = Align::Left;
  bool bold = false;
  bool upwards = false;  ///< rotated by 90°, reading upwards
};

struct Box {
  double x = 0.0, y = 0.0, width = 0.0, height = 0.0;
};

class Canvas {
 public:
  /// @throws InputError unless `path` ends in .png, .svg or .pdf. PNG pages have two pixels per
  /// point.
  Canvas(const std::string& path, double width, double height);
  ~Canvas();

  void fill(const Box& box, const Colour& colour);
  void frame(const Box& box, const Colour& colour, double line_width);
  void line(std::span<const Vec2> points, bool closed, const Colour& colour, double line_width);
  void disc(const Vec2& centre, double radius, const Colour& colour);
  void triangle(const Vec2& a, const Vec2& b, const Vec2& c, const Colour& colour);
  /// `at` is the start, middle or end of the baseline.
  void text(const Vec2& at, const std::string& text, const TextStyle& style);
  double text_width(const std::string& text, const TextStyle& style);
  /// The text, or its beginning and "…" if it would be wider than `width`.
  std::string shortened(const std::string& text, double width, const TextStyle& style);
  /// Fills the box with cols × rows sharp-edged cells, row 0 at the bottom; any number of cells is
  /// allowed.
  void cells(const Box& box, int rows, int cols,
             const std::function<Colour(int row, int col)>& colour);
  /// Clips everything drawn until unclip() to the box.
  void clip(const Box& box);
  void unclip();

  /// Writes the file completely, or not at all. @throws InputError when it cannot be written.
  void save();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace prostm::figure
