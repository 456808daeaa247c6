#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstdint>
#include <cstring>
#include <vector>

#include "prostm/core/file/file_kind.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/io/detail/raster_json.hpp"
#include "prostm/io/field/field_file.hpp"

namespace prostm {
namespace {

/// Checks width and height in the first chunk, so that a huge picture is refused before decoding.
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

/// A picture with 8 or 16 bits per channel, high byte first: grey, grey and alpha, RGB, or RGB and
/// alpha.
struct Picture {
  int rows = 0, cols = 0, channels = 0, channel_bytes = 0;
  std::vector<unsigned char> bytes;
  std::size_t row_bytes = 0;
};

/// Reads one picture with libpng, which reports errors by longjmp: no stack frame skipped by it has
/// an object with a destructor.
class Decoder {
 public:
  explicit Decoder(std::string_view bytes) : rest_(bytes) {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, on_error, on_warning);
    if (png_ != nullptr) info_ = png_create_info_struct(png_);
  }
  ~Decoder() { png_destroy_read_struct(&png_, &info_, nullptr); }
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;

  const char* reason() const { return reason_.data(); }

  /// Reads up to the pixels, and requests channels of whole bytes. @return false on failure.
  bool read_header(Picture& picture) {
    if (png_ == nullptr || info_ == nullptr || setjmp(png_jmpbuf(png_)) != 0) return false;
    png_set_read_fn(png_, this, on_read);
    png_set_chunk_malloc_max(png_, kMaxChunkBytes);
    png_read_info(png_, info_);
    png_set_expand(png_);  // palettes to RGB, fewer than 8 bits to 8, transparent colours to alpha
    png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    picture.rows = static_cast<int>(png_get_image_height(png_, info_));
    picture.cols = static_cast<int>(png_get_image_width(png_, info_));
    picture.channels = png_get_channels(png_, info_);
    picture.channel_bytes = png_get_bit_depth(png_, info_) / 8;
    picture.row_bytes = png_get_rowbytes(png_, info_);
    return true;
  }
  /// Reads the pixels. @param lines the start of each row's bytes. @return false on failure.
  bool read_pixels(unsigned char** lines) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_read_image(png_, lines);
    png_read_end(png_, nullptr);
    return true;
  }

 private:
  static constexpr png_alloc_size_t kMaxChunkBytes = 16 << 20;

  static void on_read(png_structp png, png_bytep out, std::size_t length) {
    std::string_view& rest = static_cast<Decoder*>(png_get_io_ptr(png))->rest_;
    if (rest.size() < length) png_error(png, "it ends too early");
    std::memcpy(out, rest.data(), length);
    rest.remove_prefix(length);
  }
  static void on_error(png_structp png, png_const_charp message) {
    auto& reason = static_cast<Decoder*>(png_get_error_ptr(png))->reason_;
    std::strncpy(reason.data(), message, reason.size() - 1);
    png_longjmp(png, 1);
  }
  static void on_warning(png_structp, png_const_charp) {}

  std::string_view rest_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  std::array<char, 128> reason_{};
};

Picture decode(std::string_view bytes, const std::string& name) {
  Decoder decoder(bytes);
  Picture picture;
  bool done = decoder.read_header(picture);
  if (done) {
    picture.bytes.resize(static_cast<std::size_t>(picture.rows) * picture.row_bytes);
    std::vector<unsigned char*> lines;
    for (int row = 0; row < picture.rows; ++row)
      lines.push_back(picture.bytes.data() + static_cast<std::size_t>(row) * picture.row_bytes);
    done = decoder.read_pixels(lines.data());
  }
  if (!done) {
    throw InputError(fmt::format("{}: the PNG picture is truncated or damaged ({}); save it again",
                                 name, decoder.reason()));
  }
  return picture;
}

/// Rec. 709 luminance of a pixel over that of white. @param channel its channels.
double luminance(const std::array<std::uint32_t, 4>& channel, int channels, double white) {
  if (channels < 3) return channel[0] / white;
  const std::uint32_t sum = 2126U * channel[0] + 7152U * channel[1] + 722U * channel[2];
  return sum / (10000.0 * white);
}

}  // namespace

TargetField field_from_png(std::string_view bytes, const std::string& name, double cell_mm) {
  TargetField field;
  field.cell = checked_cell(cell_mm, name, "the cell size");
  check_size(bytes, name);
  const Picture picture = decode(bytes, name);
  const bool has_alpha = picture.channels % 2 == 0;
  const double white = picture.channel_bytes == 2 ? 65535.0 : 255.0;
  field.resize(picture.rows, picture.cols);

  // the picture's top row is the largest y, so the field's last row
  for (int row = 0; row < field.rows; ++row) {
    const unsigned char* byte =
        picture.bytes.data() + static_cast<std::size_t>(field.rows - 1 - row) * picture.row_bytes;
    for (int col = 0; col < field.cols; ++col) {
      std::array<std::uint32_t, 4> channel{};
      for (int c = 0; c < picture.channels; ++c) {
        auto& value = channel[static_cast<std::size_t>(c)];
        for (int k = 0; k < picture.channel_bytes; ++k) value = value << 8 | *byte++;
      }
      if (has_alpha && channel[static_cast<std::size_t>(picture.channels - 1)] == 0) continue;
      const std::size_t i = field.index(row, col);
      field.skin[i] = 1;
      field.pressure[i] = luminance(channel, picture.channels, white);
    }
  }
  return field;
}

}  // namespace prostm
