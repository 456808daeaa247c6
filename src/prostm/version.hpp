#pragma once
/// The version; CMakeLists.txt reads it from here.

#define PROSTM_VERSION "0.1.0"
#define PROSTM_VERSION_MAJOR 0
#define PROSTM_VERSION_MINOR 1
#define PROSTM_VERSION_PATCH 0
