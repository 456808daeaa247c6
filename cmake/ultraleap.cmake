# The adapter to Ultraleap's Haptics SDK 3, which is its vendor's and not part of prostm. Where the SDK is found, the
# library prostm_device is built with it; elsewhere `prostm devices` says how to get it. Linux: give the folder that holds
# include/ and lib/. Windows: the vendor's installer uses C:/Program Files/Ultraleap Haptics; never tried there.
set(PROSTM_ULTRALEAP_ROOT "" CACHE PATH "Folder of Ultraleap's Haptics SDK 3; empty: the usual places")
set(ultraleap_places ${PROSTM_ULTRALEAP_ROOT} "$ENV{ProgramFiles}/Ultraleap Haptics" /opt/ultraleap-haptics
    /usr/share/ultraleap-haptics)
find_path(PROSTM_ULTRALEAP_INCLUDE ultraleap/haptics/streaming.hpp HINTS ${ultraleap_places} PATH_SUFFIXES include)
find_library(PROSTM_ULTRALEAP_LIBRARY UltraleapHaptics HINTS ${ultraleap_places} PATH_SUFFIXES lib bin)
mark_as_advanced(PROSTM_ULTRALEAP_INCLUDE PROSTM_ULTRALEAP_LIBRARY)

# the sources whose code depends on the SDK
set(prostm_ultraleap_sources
    ${PROJECT_SOURCE_DIR}/src/prostm/device/ultraleap/ultraleap_kind.cpp
    ${PROJECT_SOURCE_DIR}/src/prostm/device/ultraleap/ultraleap.cpp
    ${PROJECT_SOURCE_DIR}/src/prostm/device/ultraleap/ultraleap_array.cpp
    ${PROJECT_SOURCE_DIR}/src/prostm/device/ultraleap/detail/ultraleap_emission.cpp
    ${PROJECT_SOURCE_DIR}/src/prostm/device/ultraleap/detail/ultraleap_session.cpp)

if(PROSTM_ULTRALEAP_INCLUDE AND PROSTM_ULTRALEAP_LIBRARY)
  message(STATUS "Ultraleap Haptics SDK: ${PROSTM_ULTRALEAP_LIBRARY}")
  set_source_files_properties(${prostm_ultraleap_sources} PROPERTIES COMPILE_DEFINITIONS PROSTM_ULTRALEAP
                              SKIP_PRECOMPILE_HEADERS ON)
  target_include_directories(prostm_device SYSTEM PRIVATE ${PROSTM_ULTRALEAP_INCLUDE})
  target_link_libraries(prostm_device PRIVATE ${PROSTM_ULTRALEAP_LIBRARY})
elseif(PROSTM_ULTRALEAP_ROOT)
  message(FATAL_ERROR "PROSTM_ULTRALEAP_ROOT is ${PROSTM_ULTRALEAP_ROOT}, but ultraleap/haptics/streaming.hpp or the "
                      "library UltraleapHaptics is not there: name the folder that holds the SDK's include and lib")
endif()
