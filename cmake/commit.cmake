# The library prostm_commit: the commit that was built, read from git at each build and compiled into one source, so that
# a new commit links the programs anew and compiles nothing else.
set(commit_source ${PROJECT_BINARY_DIR}/commit/commit.cpp)
add_custom_target(prostm_read_commit
  COMMAND ${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR} -DOUT=${commit_source}
          -P ${PROJECT_SOURCE_DIR}/cmake/read_commit.cmake
  BYPRODUCTS ${commit_source} COMMENT "Reading the commit" VERBATIM)
add_library(prostm_commit STATIC ${commit_source})
target_include_directories(prostm_commit PUBLIC ${PROJECT_SOURCE_DIR}/src)
target_compile_features(prostm_commit PUBLIC cxx_std_20)
add_dependencies(prostm_commit prostm_read_commit)
