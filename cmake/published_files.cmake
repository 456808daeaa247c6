# Compiles data/experiments/*.json and data/psychophysics/observers.json into the library prostm_psychophysics.
set(published_source ${PROJECT_BINARY_DIR}/psychophysics/published_files.cpp)
file(GLOB published CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/data/experiments/*.json)
list(SORT published)
set(observers ${PROJECT_SOURCE_DIR}/data/psychophysics/observers.json)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${published} ${observers})
set(published_rows "")
foreach(path ${published})
  get_filename_component(name ${path} NAME)
  file(READ ${path} text)
  string(APPEND published_rows "    {\"${name}\", R\"prostm(${text})prostm\"},\n")
endforeach()
file(READ ${observers} observers_text)
file(SHA256 ${observers} observers_hash)
file(CONFIGURE OUTPUT ${published_source} @ONLY CONTENT [=[
#include "prostm/psychophysics/detail/published_files.hpp"

#include <array>

namespace prostm {
namespace {

constexpr auto kFiles = std::to_array<PublishedFile>({
@published_rows@});

}  // namespace

std::span<const PublishedFile> published_files() {
  return kFiles;
}

PublishedFile observers_file() {
  return {"observers.json", R"prostm(@observers_text@)prostm"};
}

std::string_view observers_hash() {
  return "@observers_hash@";
}

}  // namespace prostm
]=])
target_sources(prostm_psychophysics PRIVATE ${published_source})
