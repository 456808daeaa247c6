#include "prostm/figure/detail/canvas.hpp"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <cairo.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>
#include <vector>

#include "prostm/core/file/file.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/core/units.hpp"
#include "prostm/figure/figures.hpp"

namespace prostm {
namespace {

bool ends_in(const std::string& path, std::string_view ending) {
  return path.size() > ending.size() &&
         path.compare(path.size() - ending.size(), ending.size(), ending) == 0;
}

void check_ending(const std::string& path) {
  if (!ends_in(path, ".png") && !ends_in(path, ".svg") && !ends_in(path, ".pdf")) {
    throw InputError(path + " is not a known kind of figure; it must end in .png, .svg or .pdf");
  }
}

}  // namespace

void check_figure(const std::string& path) {
  check_ending(path);
  check_writable(path);
}

namespace figure {
namespace {

constexpr double kPixelsPerPoint = 2.0;  // resolution of PNG pages

cairo_status_t append_bytes(void* closure, const unsigned char* data, unsigned int length) {
  auto& bytes = *static_cast<std::string*>(closure);
  std::transform(data, data + length, std::back_inserter(bytes),
                 [](unsigned char c) { return static_cast<char>(c); });
  return CAIRO_STATUS_SUCCESS;
}

struct Destroy {
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
  void operator()(cairo_t* context) const { cairo_destroy(context); }
};
using Surface = std::unique_ptr<cairo_surface_t, Destroy>;

std::uint32_t pixel_of(const Colour& colour) {
  const auto channel = [&](double x) {
    return static_cast<std::uint32_t>(std::lround(255.0 * std::clamp(x * colour.a, 0.0, 1.0)));
  };
  const auto alpha = static_cast<std::uint32_t>(std::lround(255.0 * colour.a));
  return alpha << 24 | channel(colour.r) << 16 | channel(colour.g) << 8 | channel(colour.b);
}

/// Pixels along a side of `cells` cells. Cells of several pixels stay sharp when scaled; a side has
/// at most 2048 pixels. Few cells give a small picture, which dominates the size of a vector file.
int picture_side(int cells) {
  if (cells > 512) return std::min(cells, 2048);
  return cells * ((cells > 128 ? 1024 : 512) / cells);
}

}  // namespace

struct Canvas::Impl {
  std::string path, bytes;
  bool is_png = false;
  Surface surface;
  std::unique_ptr<cairo_t, Destroy> context;

  void set(const Colour& c) { cairo_set_source_rgba(context.get(), c.r, c.g, c.b, c.a); }
  void set_font(const TextStyle& style) {
    cairo_select_font_face(context.get(), "sans", CAIRO_FONT_SLANT_NORMAL,
                           style.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(context.get(), style.size);
  }
  double advance(const std::string& text) {
    cairo_text_extents_t extents;
    cairo_text_extents(context.get(), text.c_str(), &extents);
    return extents.x_advance;
  }
};

Canvas::Canvas(const std::string& path, double width, double height)
    : impl_(std::make_unique<Impl>()) {
  check_ending(path);
  impl_->path = path;
  impl_->is_png = ends_in(path, ".png");
  if (ends_in(path, ".svg")) {
    impl_->surface.reset(
        cairo_svg_surface_create_for_stream(append_bytes, &impl_->bytes, width, height));
  } else if (ends_in(path, ".pdf")) {
    impl_->surface.reset(
        cairo_pdf_surface_create_for_stream(append_bytes, &impl_->bytes, width, height));
    // no date, so that equal pictures give equal files
    cairo_pdf_surface_set_metadata(impl_->surface.get(), CAIRO_PDF_METADATA_CREATE_DATE, "");
  } else {
    impl_->surface.reset(cairo_image_surface_create(CAIRO_FORMAT_ARGB32,
                                                    static_cast<int>(width * kPixelsPerPoint),
                                                    static_cast<int>(height * kPixelsPerPoint)));
  }
  impl_->context.reset(cairo_create(impl_->surface.get()));
  if (impl_->is_png) cairo_scale(impl_->context.get(), kPixelsPerPoint, kPixelsPerPoint);
  cairo_set_line_join(impl_->context.get(), CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_cap(impl_->context.get(), CAIRO_LINE_CAP_ROUND);
  fill({0.0, 0.0, width, height}, kPaper);
}

Canvas::~Canvas() = default;

void Canvas::fill(const Box& box, const Colour& colour) {
  impl_->set(colour);
  cairo_rectangle(impl_->context.get(), box.x, box.y, box.width, box.height);
  cairo_fill(impl_->context.get());
}

void Canvas::frame(const Box& box, const Colour& colour, double line_width) {
  impl_->set(colour);
  cairo_set_line_width(impl_->context.get(), line_width);
  cairo_rectangle(impl_->context.get(), box.x, box.y, box.width, box.height);
  cairo_stroke(impl_->context.get());
}

void Canvas::line(std::span<const Vec2> points, bool closed, const Colour& colour,
                  double line_width) {
  impl_->set(colour);
  cairo_set_line_width(impl_->context.get(), line_width);
  cairo_new_path(impl_->context.get());
  for (const Vec2& x : points) cairo_line_to(impl_->context.get(), x.x(), x.y());
  if (closed) cairo_close_path(impl_->context.get());
  cairo_stroke(impl_->context.get());
}

void Canvas::disc(const Vec2& centre, double radius, const Colour& colour) {
  impl_->set(colour);
  cairo_new_path(impl_->context.get());
  cairo_arc(impl_->context.get(), centre.x(), centre.y(), radius, 0.0, 2.0 * kPi);
  cairo_fill(impl_->context.get());
}

void Canvas::triangle(const Vec2& a, const Vec2& b, const Vec2& c, const Colour& colour) {
  impl_->set(colour);
  cairo_new_path(impl_->context.get());
  for (const Vec2& x : {a, b, c}) cairo_line_to(impl_->context.get(), x.x(), x.y());
  cairo_close_path(impl_->context.get());
  cairo_fill(impl_->context.get());
}

void Canvas::text(const Vec2& at, const std::string& text, const TextStyle& style) {
  cairo_t* context = impl_->context.get();
  cairo_save(context);
  impl_->set_font(style);
  impl_->set(style.colour);
  const double share = style.align == Align::Left ? 0.0 : style.align == Align::Centre ? 0.5 : 1.0;
  cairo_translate(context, at.x(), at.y());
  if (style.upwards) cairo_rotate(context, -0.5 * kPi);
  cairo_move_to(context, -share * impl_->advance(text), 0.0);
  cairo_show_text(context, text.c_str());
  cairo_restore(context);
}

double Canvas::text_width(const std::string& text, const TextStyle& style) {
  impl_->set_font(style);
  return impl_->advance(text);
}

std::string Canvas::shortened(const std::string& text, double width, const TextStyle& style) {
  if (text_width(text, style) <= width) return text;
  std::string begin = text;
  while (!begin.empty() && text_width(begin + "…", style) > width) {
    const auto inside = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; };
    while (inside(begin.back())) begin.pop_back();  // the rest of a multi-byte character
    begin.pop_back();
  }
  return begin + "…";
}

void Canvas::cells(const Box& box, int rows, int cols,
                   const std::function<Colour(int row, int col)>& colour) {
  // one image for all cells, to avoid visible seams between them
  const int width = picture_side(cols), height = picture_side(rows);
  const Surface picture(cairo_image_surface_create(CAIRO_FORMAT_ARGB32, width, height));
  cairo_surface_flush(picture.get());
  unsigned char* data = cairo_image_surface_get_data(picture.get());
  const int stride = cairo_image_surface_get_stride(picture.get());
  std::vector<std::uint32_t> line(static_cast<std::size_t>(width));
  int drawn_row = -1;
  for (int y = 0; y < height; ++y) {
    const int row = static_cast<int>(static_cast<long long>(height - 1 - y) * rows / height);
    for (int x = 0; x < width && row != drawn_row; ++x) {
      line[static_cast<std::size_t>(x)] =
          pixel_of(colour(row, static_cast<int>(static_cast<long long>(x) * cols / width)));
    }
    drawn_row = row;
    std::copy(line.begin(), line.end(),
              reinterpret_cast<std::uint32_t*>(data + static_cast<std::ptrdiff_t>(y) * stride));
  }
  cairo_surface_mark_dirty(picture.get());

  cairo_t* context = impl_->context.get();
  cairo_save(context);
  cairo_translate(context, box.x, box.y);
  cairo_scale(context, box.width / width, box.height / height);
  cairo_set_source_surface(context, picture.get(), 0.0, 0.0);
  cairo_pattern_set_extend(cairo_get_source(context), CAIRO_EXTEND_PAD);
  cairo_rectangle(context, 0.0, 0.0, width, height);
  cairo_fill(context);
  cairo_restore(context);
}

void Canvas::clip(const Box& box) {
  cairo_save(impl_->context.get());
  cairo_rectangle(impl_->context.get(), box.x, box.y, box.width, box.height);
  cairo_clip(impl_->context.get());
}

void Canvas::unclip() {
  cairo_restore(impl_->context.get());
}

void Canvas::save() {
  impl_->context.reset();
  cairo_surface_t* surface = impl_->surface.get();
  if (!impl_->is_png) cairo_surface_finish(surface);
  const cairo_status_t status =
      impl_->is_png ? cairo_surface_write_to_png_stream(surface, append_bytes, &impl_->bytes)
                    : cairo_surface_status(surface);
  if (status != CAIRO_STATUS_SUCCESS) {
    throw InputError(
        fmt::format("{} cannot be drawn ({})", impl_->path, cairo_status_to_string(status)));
  }
  write_file(impl_->path, impl_->bytes);
}

}  // namespace figure
}  // namespace prostm
