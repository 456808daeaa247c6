# The library prostm_page: the page of web/, built by npm and embedded into the program as bytes.
set(web ${PROJECT_SOURCE_DIR}/web)
set(page_source ${PROJECT_BINARY_DIR}/page/page_files.cpp)
if(PROSTM_PAGE)
  file(GLOB_RECURSE page_inputs CONFIGURE_DEPENDS ${web}/src/* ${web}/public/*)
  list(APPEND page_inputs ${web}/index.html ${web}/experimenter.html ${web}/participant.html ${web}/package.json ${web}/package-lock.json ${web}/vite.config.ts)
else()
  set(page_inputs "")
endif()
add_custom_command(
  OUTPUT ${page_source}
  COMMAND ${CMAKE_COMMAND} -DWEB=${web} -DOUT=${page_source} -DPAGE=${PROSTM_PAGE}
          -P ${PROJECT_SOURCE_DIR}/cmake/build_page.cmake
  DEPENDS ${page_inputs} ${PROJECT_SOURCE_DIR}/cmake/build_page.cmake
  COMMENT "Building the page" VERBATIM)
add_library(prostm_page STATIC ${page_source})
target_include_directories(prostm_page PUBLIC ${PROJECT_SOURCE_DIR}/src)
