/// Fields as arrays (NPY) and images (PNG).
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include "io/png_writer.hpp"
#include "prostm/core/file/file.hpp"
#include "prostm/io/field/field_file.hpp"
#include "support/input_errors.hpp"

namespace prostm {
namespace {

using test::input_error;
using testing::ElementsAre;
using testing::HasSubstr;

std::string npy(const std::string& dictionary, const std::string& data, int version = 1) {
  std::string header = dictionary + "\n";
  std::string bytes("\x93NUMPY", 6);
  bytes += static_cast<char>(version);
  bytes += '\0';
  for (int i = 0; i < (version == 1 ? 2 : 4); ++i)
    bytes += static_cast<char>(header.size() >> (8 * i) & 255);
  return bytes + header + data;
}

std::string dictionary(const std::string& descr, const std::string& shape, bool fortran = false) {
  return "{'descr': '" + descr + "', 'fortran_order': " + (fortran ? "True" : "False") +
         ", 'shape': " + shape + ", }";
}

/// Returns numbers as bytes, high byte first if `big_endian`.
template <class T>
std::string bytes_of(std::initializer_list<T> values, bool big_endian = false) {
  std::string bytes;
  for (const T value : values) {
    std::string one(sizeof(T), '\0');
    std::memcpy(one.data(), &value, sizeof(T));
    if (big_endian != (std::endian::native == std::endian::big))
      one.assign(one.rbegin(), one.rend());
    bytes += one;
  }
  return bytes;
}

TEST(FieldNpy, ReadsEveryTypeOfNumber) {
  const auto pressure = [](const std::string& descr, const std::string& data) {
    return field_from_npy(npy(dictionary(descr, "(2, 3)"), data), "a.npy", 5.0).pressure;
  };
  const auto expected = ElementsAre(0, 1, 2, 3, 4, 100);
  EXPECT_THAT(pressure("<f4", bytes_of<float>({0, 1, 2, 3, 4, 100})), expected);
  EXPECT_THAT(pressure(">f4", bytes_of<float>({0, 1, 2, 3, 4, 100}, true)), expected);
  EXPECT_THAT(pressure("<f8", bytes_of<double>({0, 1, 2, 3, 4, 100})), expected);
  EXPECT_THAT(pressure(">f8", bytes_of<double>({0, 1, 2, 3, 4, 100}, true)), expected);
  EXPECT_THAT(pressure("|i1", bytes_of<std::int8_t>({0, 1, 2, 3, 4, 100})), expected);
  EXPECT_THAT(pressure("|u1", bytes_of<std::uint8_t>({0, 1, 2, 3, 4, 100})), expected);
  EXPECT_THAT(pressure(">i2", bytes_of<std::int16_t>({0, 1, 2, 3, 4, 100}, true)), expected);
  EXPECT_THAT(pressure("<u2", bytes_of<std::uint16_t>({0, 1, 2, 3, 4, 100})), expected);
  EXPECT_THAT(pressure("<i4", bytes_of<std::int32_t>({0, 1, 2, 3, 4, 100})), expected);
  EXPECT_THAT(pressure(">u4", bytes_of<std::uint32_t>({0, 1, 2, 3, 4, 100}, true)), expected);
  EXPECT_THAT(pressure("<i8", bytes_of<std::int64_t>({0, 1, 2, 3, 4, 100})), expected);
  EXPECT_THAT(pressure(">u8", bytes_of<std::uint64_t>({0, 1, 2, 3, 4, 100}, true)), expected);
  EXPECT_THAT(pressure("<f2", bytes_of<std::uint16_t>({0, 0x3c00, 0x4000, 0x4200, 0x4400, 0x5640})),
              expected);
  EXPECT_THAT(pressure("|b1", bytes_of<std::uint8_t>({0, 1, 1, 0, 1, 1})),
              ElementsAre(0, 1, 1, 0, 1, 1));
}

TEST(FieldNpy, ReadsBothOrdersAndVersions) {
  const std::string row_major = bytes_of<double>({1, 2, 3, 4, 5, 6});
  const std::string column_major = bytes_of<double>({1, 4, 2, 5, 3, 6});
  for (const int version : {1, 2, 3}) {
    const TargetField c =
        field_from_npy(npy(dictionary("<f8", "(2, 3)"), row_major, version), "a", 2.5);
    const TargetField f =
        field_from_npy(npy(dictionary("<f8", "(2, 3)", true), column_major, version), "a", 2.5);
    EXPECT_EQ(c.rows, 2);
    EXPECT_EQ(c.cell, 0.0025);
    EXPECT_THAT(c.pressure, ElementsAre(1, 2, 3, 4, 5, 6));
    EXPECT_EQ(f.pressure, c.pressure);
  }
}

TEST(FieldNpy, TreatsNanAsNoSkinEvenIfSignalling) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const TargetField field =
      field_from_npy(npy(dictionary("<f8", "(1, 3)"), bytes_of<double>({1, kNan, 0})), "a", 5.0);
  EXPECT_THAT(field.skin, ElementsAre(1, 0, 1));
  EXPECT_THAT(field.pressure, ElementsAre(1, 0, 0));
  const TargetField signalling = field_from_npy(
      npy(dictionary("<f4", "(1, 2)"), bytes_of<std::uint32_t>({0x7f800001U, 0xff800001U})), "a",
      5.0);
  EXPECT_THAT(signalling.skin, ElementsAre(0, 0));
}

TEST(FieldNpy, ReadsTheExtremesOfFloat16) {
  // the smallest number, the largest below 1, the largest, and two NaN
  const TargetField field =
      field_from_npy(npy(dictionary(">f2", "(1, 5)"),
                         bytes_of<std::uint16_t>({0x0001, 0x3bff, 0x7bff, 0x7e00, 0xfc01}, true)),
                     "a", 5.0);
  EXPECT_THAT(field.pressure,
              ElementsAre(std::ldexp(1.0, -24), 1.0 - std::ldexp(1.0, -11), 65504.0, 0.0, 0.0));
  EXPECT_THAT(field.skin, ElementsAre(1, 1, 1, 0, 0));
  EXPECT_THAT(input_error([] {
                field_from_npy(npy(dictionary("<f2", "(1, 1)"), bytes_of<std::uint16_t>({0x7c00})),
                               "a", 5.0);
              }),
              HasSubstr("is inf"));
}

TEST(FieldNpy, TakesAFrameOfAThreeDimensionalArray) {
  const std::string row_major = bytes_of<double>({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12});
  const std::string column_major = bytes_of<double>({1, 7, 4, 10, 2, 8, 5, 11, 3, 9, 6, 12});
  for (const bool fortran : {false, true}) {
    const std::string bytes =
        npy(dictionary("<f8", "(2, 2, 3)", fortran), fortran ? column_major : row_major);
    EXPECT_THAT(field_from_npy(bytes, "a", 5.0, 0).pressure, ElementsAre(1, 2, 3, 4, 5, 6));
    EXPECT_THAT(field_from_npy(bytes, "a", 5.0, 1).pressure, ElementsAre(7, 8, 9, 10, 11, 12));
    const auto refusal = [&](std::optional<int> frame) {
      return input_error([&] { field_from_npy(bytes, "a", 5.0, frame); });
    };
    EXPECT_THAT(refusal({}), HasSubstr("2 frames of 2 x 3 cells; choose one with --frame, 0 to 1"));
    EXPECT_THAT(refusal(2), HasSubstr("has no frame 2; it has 2 frames"));
    EXPECT_THAT(refusal(-1), HasSubstr("has no frame -1"));
  }
  // axes of length 1 are dropped
  for (const char* shape : {"(1, 2, 3)", "(2, 3, 1)", "(1, 2, 3, 1)"}) {
    const TargetField field =
        field_from_npy(npy(dictionary("<f8", shape), row_major.substr(0, 48)), "a", 5.0);
    EXPECT_EQ(field.rows, 2);
    EXPECT_THAT(field.pressure, ElementsAre(1, 2, 3, 4, 5, 6));
  }
  EXPECT_THAT(input_error([&] {
                field_from_npy(npy(dictionary("<f8", "(2, 3)"), row_major.substr(0, 48)), "a", 5.0,
                               1);
              }),
              HasSubstr("holds one field; leave out --frame"));
}

TEST(FieldNpy, TreatsRoundingErrorsOfASolverAsZero) {
  const auto read = [](std::initializer_list<double> values) {
    return field_from_npy(npy(dictionary("<f8", "(1, 2)"), bytes_of<double>(values)), "a", 5.0)
        .pressure;
  };
  EXPECT_THAT(read({-1e-18, 1.0}), ElementsAre(0.0, 1.0));
  EXPECT_THAT(read({-0.9e-6 * 3e5, 3e5}), ElementsAre(0.0, 3e5));
  EXPECT_THAT(input_error([&] { read({-1.1e-6, 1.0}); }), HasSubstr("column 0 is -1.1e-06"));
  EXPECT_THAT(input_error([&] { read({-1e-18, 0.0}); }), HasSubstr("is -1e-18"));
}

TEST(FieldNpy, ReportsErrors) {
  const std::string data = bytes_of<double>({1, 2, 3, 4, 5, 6});
  const auto sentence = [&](const std::string& bytes, double cell = 5.0) {
    return input_error([&] { field_from_npy(bytes, "a.npy", cell); });
  };
  const std::string good = npy(dictionary("<f8", "(2, 3)"), data);
  EXPECT_THAT(sentence("PK\x03\x04 not an array"), HasSubstr("is a zip archive, not an NPY file"));
  EXPECT_THAT(sentence("\x89PNG\r\n\x1a\n"), HasSubstr("is a PNG picture, not an NPY file"));
  EXPECT_THAT(sentence(good.substr(0, 30)), HasSubstr("header is cut off"));
  EXPECT_THAT(sentence(good.substr(0, good.size() - 1)), HasSubstr("holds 47 bytes of numbers"));
  EXPECT_THAT(sentence(good + "x"), HasSubstr("must be 48"));
  EXPECT_THAT(sentence(npy(dictionary("<f8", "(2, 3)"), data, 4)), HasSubstr("version 4"));
  EXPECT_THAT(sentence(npy(dictionary("<c16", "(2, 3)"), data)), HasSubstr("of type '<c16'"));
  EXPECT_THAT(sentence(npy(dictionary("<f8", "(6,)"), data)), HasSubstr("of 1 dimensions"));
  EXPECT_THAT(sentence(npy(dictionary("<f8", "()"), data)), HasSubstr("of 0 dimensions"));
  EXPECT_THAT(sentence(npy(dictionary("<f8", "(20000, 20000)"), data)), HasSubstr("20000 x 20000"));
  EXPECT_THAT(sentence(npy(dictionary("<f8", "(999999999999999, 999999999999999)"), data)),
              HasSubstr("cells; a field"));
  EXPECT_THAT(sentence(npy(dictionary("<f8", "(0, 3)"), "")), HasSubstr("0 x 3"));
  EXPECT_THAT(
      sentence(npy("{'descr': [('x', '<f8')], 'fortran_order': False, 'shape': (2, 3)}", data)),
      HasSubstr("structured"));
  EXPECT_THAT(sentence(npy("{'descr': '<f8', 'shape': (2, 3)}", data)),
              HasSubstr("header is broken"));
  EXPECT_THAT(sentence(npy("nonsense", data)), HasSubstr("header is broken"));
  EXPECT_THAT(sentence(npy(dictionary("<f8", "(2, 3)"), bytes_of<double>({1, 2, 3, 4, -5, 6}))),
              HasSubstr("pressure at row 1, column 1 is -5"));
  EXPECT_THAT(sentence(npy(dictionary("<f8", "(1, 1)"),
                           bytes_of<double>({std::numeric_limits<double>::infinity()}))),
              HasSubstr("row 0, column 0 is inf"));
  EXPECT_THAT(sentence(good, 0.0), HasSubstr("the cell size is 0"));
  EXPECT_THAT(sentence(good, -1.0), HasSubstr("the cell size is -1"));
}

TEST(FieldPng, TakesLuminanceAndPutsRowZeroAtTheLargestY) {
  const std::string samples(
      "\x00\x00\x00\xff\xff\xff\x33\x33\x33"
      "\xff\x00\x00\x00\xff\x00\x00\x00\xff",
      18);
  const TargetField field = field_from_png(test::png(3, 2, 2, 8, samples), "a.png", 4.0);
  EXPECT_EQ(field.rows, 2);
  EXPECT_EQ(field.cols, 3);
  EXPECT_EQ(field.cell, 0.004);
  EXPECT_THAT(field.pressure, ElementsAre(0.2126, 0.7152, 0.0722, 0.0, 1.0, 0.2));
  EXPECT_THAT(field.skin, testing::Each(1));
}

TEST(FieldPng, ReadsGreyOfEightAndSixteenBits) {
  const TargetField eight =
      field_from_png(test::png(3, 1, 0, 8, std::string("\x00\x80\xff", 3)), "a", 4.0);
  EXPECT_THAT(eight.pressure, ElementsAre(0.0, 128.0 / 255.0, 1.0));
  const TargetField sixteen =
      field_from_png(test::png(3, 1, 0, 16, std::string("\x00\x00\x80\x00\xff\xff", 6)), "a", 4.0);
  EXPECT_THAT(sixteen.pressure, ElementsAre(0.0, 32768.0 / 65535.0, 1.0));
}

TEST(FieldPng, KeepsAllSixteenBits) {
  const std::string weak("\x00\x01\x00\xff\x12\x34", 6);
  EXPECT_THAT(field_from_png(test::png(3, 1, 0, 16, weak), "a", 4.0).pressure,
              ElementsAre(1.0 / 65535.0, 255.0 / 65535.0, 4660.0 / 65535.0));
  // red, green, blue, and an alpha that is 0 in its upper byte only
  const std::string colour("\x00\x00\x00\x07\x00\x00\x00\x01", 8);
  const TargetField field = field_from_png(test::png(1, 1, 6, 16, colour), "a", 4.0);
  EXPECT_THAT(field.skin, ElementsAre(1));
  EXPECT_THAT(field.pressure, ElementsAre(7152.0 * 7 / (10000.0 * 65535.0)));
}

TEST(FieldPng, TreatsATransparentColourAsNoSkin) {
  std::string eight = test::png(3, 1, 0, 8, std::string("\x00\x80\xff", 3));
  eight.insert(33, test::png_chunk("tRNS", std::string("\x00\x80", 2)));
  EXPECT_THAT(field_from_png(eight, "a", 4.0).skin, ElementsAre(1, 0, 1));
  std::string sixteen = test::png(2, 1, 0, 16, std::string("\x12\x34\x12\x35", 4));
  sixteen.insert(33, test::png_chunk("tRNS", "\x12\x34"));
  EXPECT_THAT(field_from_png(sixteen, "a", 4.0).skin, ElementsAre(0, 1));
}

TEST(FieldPng, TreatsAlphaZeroAsNoSkinAndIgnoresOtherAlpha) {
  const std::string samples("\xff\x00\x80\xff\xff\x80\x80\x40", 8);  // grey, alpha
  const TargetField field = field_from_png(test::png(4, 1, 4, 8, samples), "a.png", 4.0);
  EXPECT_THAT(field.skin, ElementsAre(0, 1, 1, 1));
  EXPECT_THAT(field.pressure,
              ElementsAre(0.0, testing::DoubleNear(128.0 / 255.0, 1e-12),
                          testing::DoubleNear(1.0, 1e-12), testing::DoubleNear(0.5, 0.01)));
}

TEST(ReadField, ScalesFieldsByTheirWidthAndInvertsImages) {
  const test::TemporaryFolder folder;
  const std::string picture = folder.file("a.png"), array = folder.file("a.npy");
  write_file(picture, test::png(4, 1, 4, 8, std::string("\xff\x00\x00\xff\xff\xff\x33\xff", 8)));
  write_file(array, npy(dictionary("<f8", "(1, 2)"), bytes_of<double>({1, 7})));
  const TargetField black = read_field(picture, {.width_mm = 20.0, .invert = true});
  EXPECT_EQ(black.cell, 0.005);
  EXPECT_THAT(black.skin, ElementsAre(0, 1, 1, 1));
  EXPECT_THAT(black.pressure, ElementsAre(0.0, 1.0, 0.0, testing::DoubleNear(0.8, 1e-12)));
  const TargetField white = read_field(picture, {.cell_mm = 5.0});
  EXPECT_THAT(white.pressure, ElementsAre(0.0, 0.0, 1.0, testing::DoubleNear(0.2, 1e-12)));
  EXPECT_EQ(read_field(array, {.width_mm = 5.0}).cell, 0.0025);

  const auto refusal = [&](const FieldFileOptions& options) {
    return input_error([&] { read_field(array, options); });
  };
  EXPECT_THAT(refusal({}), HasSubstr("--width-mm"));
  EXPECT_THAT(refusal({.cell_mm = 5.0, .width_mm = 5.0}), HasSubstr("exclude each other"));
  EXPECT_THAT(refusal({.width_mm = 5.0, .invert = true}), HasSubstr("is not a picture"));
  EXPECT_THAT(refusal({.width_mm = -5.0}), HasSubstr("--width-mm -5 over 2 columns is -2.5"));
  EXPECT_THAT(refusal({.width_mm = std::numeric_limits<double>::quiet_NaN()}),
              HasSubstr("from 0.01 to 1000 mm"));
}

TEST(FieldPng, ReportsErrors) {
  const std::string good = test::png(40, 30, 0, 8, std::string(1200, '\x12'));
  const auto sentence = [](const std::string& bytes, double cell = 5.0) {
    return input_error([&] { field_from_png(bytes, "a.png", cell); });
  };
  EXPECT_EQ(field_from_png(good, "a.png", 5.0).size(), 1200u);
  EXPECT_THAT(sentence("GIF89a and so on, not a PNG"), HasSubstr("is not a PNG picture"));
  EXPECT_THAT(sentence("{\"format\": 1}"), HasSubstr("is JSON, not a PNG picture"));
  EXPECT_THAT(sentence(good.substr(0, 20)), HasSubstr("is not a PNG picture"));
  EXPECT_THAT(sentence(good.substr(0, good.size() / 2)), HasSubstr("truncated or damaged"));
  std::string palette = good.substr(16, 13);  // indexed colours, but no palette
  palette[9] = 3;
  EXPECT_THAT(sentence(good.substr(0, 8) + test::png_chunk("IHDR", palette) + good.substr(33)),
              AllOf(HasSubstr("truncated or damaged"), Not(HasSubstr("memory"))));
  std::string huge = good;
  huge.replace(16, 8, std::string("\0\0\x4e\x20\0\0\x4e\x20", 8));
  EXPECT_THAT(sentence(huge), HasSubstr("20000 x 20000"));
  EXPECT_THAT(sentence(good, 1e9), HasSubstr("the cell size is 1000000000"));
}

}  // namespace
}  // namespace prostm
