#pragma once
/// Data from outside the project: tests that use them are skipped if they are missing.

#include <gtest/gtest.h>

#include <filesystem>

#include "support/places.hpp"

/// Skips the running test if `name` (relative to ../shared) is missing.
#define PROSTM_NEEDS_SHARED(name)                                \
  if (!std::filesystem::exists(prostm::test::shared_file(name))) \
  GTEST_SKIP() << "needs " << (name) << " in ../shared, which is not part of the project"
