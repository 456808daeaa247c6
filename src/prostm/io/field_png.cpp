#include <cairo.h>
#include <fmt/format.h>

#include <cstdint>
#include <cstring>
#include <memory>

#include "prostm/core/file_kind.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/io/detail/raster_json.hpp"
#include "prostm/io/field_file.hpp"

namespace prostm {
namespace {

struct SurfaceDeleter {
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
};
using Surface = std::unique_ptr<cairo_surface_t, SurfaceDeleter>;

/// Width and height from the first chunk, so that a huge picture is refused before it is decoded.
void check_size(std::string_view bytes, const std::string& name) {
  constexpr std::string_view kStart("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16);
  if (bytes.size() < 24 || bytes.substr(0, kStart.size()) != kStart) {
    throw InputError(name + " " + is_not(bytes, "a PNG picture") + "; save it as PNG");
  }
  const auto big_endian = [&](std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = at; i < at + 4; ++i) {
      value = value << 8 | static_cast<unsigned char>(bytes[i]);
    }
    return static_cast<double>(value);
  };
  check_raster_size(big_endian(20), big_endian(16), name);
}

cairo_status_t read_bytes(void* closure, unsigned char* out, unsigned int length) {
  auto& rest = *static_cast<std::string_view*>(closure);
  if (rest.size() < length) return CAIRO_STATUS_READ_ERROR;
  std::memcpy(out, rest.data(), length);
  rest.remove_prefix(length);
  return CAIRO_STATUS_SUCCESS;
}

Surface decode(std::string_view bytes, const std::string& name) {
  Surface surface(cairo_image_surface_create_from_png_stream(read_bytes, &bytes));
  const cairo_status_t status = cairo_surface_status(surface.get());
  if (status != CAIRO_STATUS_SUCCESS) {
    // whatever libpng finds wrong, cairo calls it a lack of memory
    throw InputError(name +
                     ": the PNG picture cannot be decoded; it is cut off or broken, so save it "
                     "again");
  }
  const cairo_format_t format = cairo_image_surface_get_format(surface.get());
  if (format != CAIRO_FORMAT_ARGB32 && format != CAIRO_FORMAT_RGB24) {
    throw InputError(name + ": the PNG picture must have 8 bits a channel");
  }
  return surface;
}

/// Rec. 709 luminance of a pixel over that of white. Channels are multiplied by alpha, as cairo
/// keeps them.
double luminance(std::uint32_t pixel, std::uint32_t alpha) {
  const std::uint32_t r = pixel >> 16 & 255U, g = pixel >> 8 & 255U, b = pixel & 255U;
  return (2126U * r + 7152U * g + 722U * b) / (10000.0 * alpha);
}

}  // namespace

TargetField field_from_png(std::string_view bytes, const std::string& name, double cell_mm) {
  TargetField field;
  field.cell = checked_cell(cell_mm, name, "the cell size");
  check_size(bytes, name);
  const Surface surface = decode(bytes, name);
  const bool has_alpha = cairo_image_surface_get_format(surface.get()) == CAIRO_FORMAT_ARGB32;
  field.resize(cairo_image_surface_get_height(surface.get()),
               cairo_image_surface_get_width(surface.get()));

  // the picture's top row is the largest y, so the field's last row
  const unsigned char* pixels = cairo_image_surface_get_data(surface.get());
  const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface.get()));
  for (int row = 0; row < field.rows; ++row) {
    const unsigned char* line = pixels + static_cast<std::size_t>(field.rows - 1 - row) * stride;
    for (int col = 0; col < field.cols; ++col) {
      std::uint32_t pixel = 0;
      std::memcpy(&pixel, line + 4 * static_cast<std::size_t>(col), sizeof pixel);
      const std::uint32_t alpha = has_alpha ? pixel >> 24 : 255U;
      if (alpha == 0) continue;
      const std::size_t i = field.index(row, col);
      field.skin[i] = 1;
      field.pressure[i] = luminance(pixel, alpha);
    }
  }
  return field;
}

}  // namespace prostm
