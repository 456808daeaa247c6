# Headers that most sources include and that take longest to read are precompiled, once for the libraries and once for
# the tests. Every source still includes what it uses, which tools/check_includes.py checks. nlohmann/json.hpp is not among
# them: g++ instantiates half a second of it in every source that sees it, even unused.
set(prostm_slow_headers <Eigen/Core> <Eigen/Geometry> <boost/container/static_vector.hpp> <algorithm> <chrono> <complex>
    <condition_variable> <functional> <memory> <mutex> <optional> <random> <span> <string> <thread> <variant> <vector>)

# prostm_optimize_less(TARGET): options, JSON, messages and assertions take longest to optimize and gain nothing from it.
# Not for what is installed: where a program and a library both compile an inline function, the linker keeps the
# program's. Targets with a common precompiled header are optimized alike.
function(prostm_optimize_less target)
  if(PROSTM_SANITIZE)
    target_compile_options(${target} PRIVATE -O0)
  else()
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release,RelWithDebInfo>:-O1>)
  endif()
endfunction()

# prostm_precompile(TARGET HOST HEADER…): HOST is the target that makes the precompiled header; it has the flags of the
# others, and no definition that one of them lacks
function(prostm_precompile target host)
  if(target STREQUAL host)
    target_precompile_headers(${target} PRIVATE ${ARGN})
  else()
    target_precompile_headers(${target} REUSE_FROM ${host})
  endif()
endfunction()

# the hosts of the libraries
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/slow_headers.cpp CONTENT "")
foreach(host prostm_slow_headers prostm_slow_headers_of_text)
  add_library(${host} STATIC EXCLUDE_FROM_ALL ${PROJECT_BINARY_DIR}/slow_headers.cpp)
  target_link_libraries(${host} PRIVATE Eigen3::Eigen Boost::headers Threads::Threads)
  prostm_precompile(${host} ${host} ${prostm_slow_headers})
endforeach()
prostm_optimize_less(prostm_slow_headers_of_text)
# Stages, and tests of stages, that mostly handle text: the sanitizers optimize them less.
set(prostm_text_stages track report study viewer)
set(prostm_text_tests core device figure io report study track ultraleap viewer)

# prostm_stage(NAME …): one static library per folder of src/prostm/, with its subfolders. tools/check_layers.py checks
# which folder may include which.
function(prostm_stage name)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/prostm/${name}/*.cpp)
  add_library(prostm_${name} STATIC ${sources})
  add_library(prostm::${name} ALIAS prostm_${name})
  set_target_properties(prostm_${name} PROPERTIES EXPORT_NAME ${name})
  target_compile_features(prostm_${name} PUBLIC cxx_std_20)
  target_include_directories(prostm_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src>)
  target_link_libraries(prostm_${name} ${ARGN})
  if(PROSTM_SANITIZE AND name IN_LIST prostm_text_stages)
    prostm_optimize_less(prostm_${name})
    prostm_precompile(prostm_${name} prostm_slow_headers_of_text)
  else()
    prostm_precompile(prostm_${name} prostm_slow_headers)
  endif()
endfunction()

# One test program per folder of tests/, from all *_test.cpp in it and its subfolders; each case is one ctest entry. The
# target prostm_tests builds them all. Filters of GoogleTest name the exceptions: cases of prostm_alone_NAME keep real
# time and run beside no other; those of prostm_together_NAME share what takes long to compute, and are one entry.
function(prostm_test name)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/${name}/*_test.cpp)
  if(PROSTM_SANITIZE STREQUAL "thread" AND DEFINED prostm_threaded_${name})
    foreach(source ${sources})
      file(STRINGS ${source} threads REGEX "^#include <(thread|atomic|mutex)>" LIMIT_COUNT 1)
      if(NOT threads AND NOT source MATCHES ${prostm_threaded_${name}})
        list(REMOVE_ITEM sources ${source})
      endif()
    endforeach()
  endif()
  if(sources)
    add_executable(test_${name} ${sources})
    target_link_libraries(test_${name} PRIVATE ${ARGN} prostm_test_support GTest::gmock)
    set(host test_core)
    if(PROSTM_SANITIZE AND NOT name IN_LIST prostm_text_tests)
      set(host test_target)
    else()
      prostm_optimize_less(test_${name})
    endif()
    prostm_precompile(test_${name} ${host} ${prostm_slow_headers} <gmock/gmock.h> <gtest/gtest.h>)
    add_dependencies(prostm_tests test_${name})
    if(DEFINED prostm_alone_${name})
      gtest_discover_tests(test_${name} TEST_PREFIX "${name}." TEST_FILTER "${prostm_alone_${name}}"
                           TEST_LIST ${name}_alone DISCOVERY_TIMEOUT 60
                           PROPERTIES TIMEOUT 900 LABELS "${name}" RUN_SERIAL ON)
    endif()
    if(DEFINED prostm_together_${name})
      add_test(NAME ${name}.together COMMAND test_${name} --gtest_brief=1 "--gtest_filter=${prostm_together_${name}}")
      set_tests_properties(${name}.together PROPERTIES TIMEOUT 900 LABELS "${name}")
    endif()
    gtest_discover_tests(test_${name} TEST_PREFIX "${name}."
                         TEST_FILTER "-${prostm_alone_${name}}:${prostm_together_${name}}"
                         DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT 900 LABELS "${name}")
  endif()
endfunction()
