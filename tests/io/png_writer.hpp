#pragma once
/// A minimal PNG writer: stored (uncompressed) deflate blocks, any colour type. Independent of
/// the reader.

#include <array>
#include <cstdint>
#include <string>

namespace prostm::test {

inline void append_big_endian(std::string& bytes, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 255U);
}

inline std::uint32_t crc32(const std::string& bytes) {
  std::uint32_t crc = 0xffffffffU;
  for (const char c : bytes) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc & 1U) != 0 ? 0xedb88320U : 0U);
  }
  return ~crc;
}

inline std::string png_chunk(const std::string& type, const std::string& data) {
  std::string bytes;
  append_big_endian(bytes, static_cast<std::uint32_t>(data.size()));
  bytes += type + data;
  append_big_endian(bytes, crc32(type + data));
  return bytes;
}

/// @param colour 0 grey, 2 RGB, 4 grey and alpha, 6 RGB and alpha. @param samples row by row, top
/// row first, `depth` / 8 bytes each, high byte first.
inline std::string png(int width, int height, int colour, int depth, const std::string& samples) {
  const int channels = std::array<int, 7>{1, 0, 3, 0, 2, 0, 4}[static_cast<std::size_t>(colour)];
  const auto line = static_cast<std::size_t>(width * channels * depth / 8);
  std::string raw;
  for (int y = 0; y < height; ++y) {
    raw += '\0' + samples.substr(static_cast<std::size_t>(y) * line, line);
  }

  // one stored block, then the checksum of its contents
  std::string stream("\x78\x01\x01", 3);
  const auto size = static_cast<std::uint32_t>(raw.size());
  for (const std::uint32_t n : {size, ~size}) {
    stream += static_cast<char>(n & 255U);
    stream += static_cast<char>(n >> 8 & 255U);
  }
  stream += raw;
  std::uint32_t a = 1, b = 0;
  for (const char c : raw) {
    a = (a + static_cast<unsigned char>(c)) % 65521U;
    b = (b + a) % 65521U;
  }
  append_big_endian(stream, b << 16 | a);

  std::string header;
  append_big_endian(header, static_cast<std::uint32_t>(width));
  append_big_endian(header, static_cast<std::uint32_t>(height));
  header += static_cast<char>(depth);
  header += static_cast<char>(colour);
  header += std::string(3, '\0');
  return "\x89PNG\r\n\x1a\n" + png_chunk("IHDR", header) + png_chunk("IDAT", stream) +
         png_chunk("IEND", "");
}

}  // namespace prostm::test
