#pragma once
/// Data that is not part of the project: tests that use it skip when it is absent.

#include <gtest/gtest.h>

#include <filesystem>

#include "support/places.hpp"

/// Skips the running test when `name` (relative to ../shared) is not there.
#define PROSTM_NEEDS_SHARED(name)                                \
  if (!std::filesystem::exists(prostm::test::shared_file(name))) \
  GTEST_SKIP() << "needs " << (name) << " in ../shared, which is not part of the project"
