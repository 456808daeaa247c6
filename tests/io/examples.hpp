#pragma once
/// Shared parts of the file formats' tests: a small plan, comparisons, broken documents.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <initializer_list>
#include <string>

#include "prostm/plan/plan.hpp"
#include "prostm/target/target_field.hpp"
#include "support/input_errors.hpp"

namespace prostm::test {

/// Returns a path along the triangle with sides of 30, 40 and 50 mm, with a pressure of 2.5.
inline Plan triangle_plan() {
  FocalPath path;
  for (const Vec2& x : {Vec2(0, 0), Vec2(0.03, 0), Vec2(0.03, 0.04)}) {
    path.points.push_back(x);
    path.pressure.push_back(2.5);
  }
  path.length = 0.12;
  path.speed = 7.0;
  path.period = path.length / path.speed;
  Plan plan;
  plan.paths.push_back(path);
  return plan;
}

/// Compares everything except the planes' poses, exactly.
inline void expect_same_raster(const TargetField& a, const TargetField& b) {
  EXPECT_EQ(a.rows, b.rows);
  EXPECT_EQ(a.cols, b.cols);
  EXPECT_EQ(a.cell, b.cell);
  EXPECT_EQ(a.origin, b.origin);
  EXPECT_EQ(a.pressure, b.pressure);
  EXPECT_EQ(a.skin, b.skin);
  EXPECT_EQ(a.height, b.height);
  EXPECT_EQ(a.weight, b.weight);
}

/// Returns `document` with the first occurrence of `old_text` replaced.
inline std::string replaced(std::string document, const std::string& old_text,
                            const std::string& new_text) {
  const std::size_t at = document.find(old_text);
  if (at == document.npos) {
    ADD_FAILURE() << old_text << " is not in " << document;
    return document;
  }
  return document.replace(at, old_text.size(), new_text);
}

/// A piece of a document, its faulty replacement, and part of the expected message.
struct Wrong {
  const char* old_text;
  const char* new_text;
  const char* sentence;
};

/// Checks each fault in `document`. @param read reads a document under the name `name`, with which
/// each message must begin.
inline void expect_refused(const std::string& document, const std::string& name,
                           std::initializer_list<Wrong> wrongs,
                           const std::function<void(const std::string&)>& read) {
  for (const Wrong& wrong : wrongs) {
    const std::string broken = replaced(document, wrong.old_text, wrong.new_text);
    EXPECT_THAT(
        input_error([&] { read(broken); }),
        testing::AllOf(testing::StartsWith(name + ": "), testing::HasSubstr(wrong.sentence)))
        << wrong.new_text;
  }
}

}  // namespace prostm::test
