# Writes ${OUT}, a source file with the commit of the sources in ${SOURCE}, if it has changed. The commit comes from git,
# or from commit.txt in an archive that git made; elsewhere it is empty. Run by cmake -P from commit.cmake.
set(commit "")
find_program(git git)
if(git)
  execute_process(COMMAND ${git} -c safe.directory=* -C ${SOURCE} rev-parse --show-toplevel
                  OUTPUT_VARIABLE top OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  # a checkout of another project may hold the sources
  file(REAL_PATH ${SOURCE} source)
  if(top STREQUAL source)
    execute_process(COMMAND ${git} -c safe.directory=* -C ${SOURCE} describe --always --exclude=* --abbrev=12 --dirty
                    OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  endif()
endif()
if(NOT commit)
  file(STRINGS ${SOURCE}/cmake/commit.txt commit REGEX "^[0-9a-f]+$" LIMIT_COUNT 1)
  string(SUBSTRING "${commit}" 0 12 commit)
endif()
file(CONFIGURE OUTPUT ${OUT} @ONLY CONTENT [[
#include "prostm/commit.hpp"

namespace prostm {

std::string_view commit() {
  return "@commit@";
}

}  // namespace prostm
]])
