# Installs headers, libraries, the CMake package and the pkg-config file of the planner's library, and, if it is built,
# the program with its libraries.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/prostm)

# prostm_install(EXPORT STAGE…): EXPORT is the name of the targets' file
function(prostm_install export)
  foreach(stage ${ARGN})
    target_include_directories(prostm_${stage} PUBLIC $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
    install(TARGETS prostm_${stage} EXPORT ${export} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
    # public headers may hold types of detail/, so it is installed with them
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/src/prostm/${stage} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/prostm
            FILES_MATCHING PATTERN *.hpp)
  endforeach()
  install(EXPORT ${export} NAMESPACE prostm:: DESTINATION ${package_folder})
endfunction()

install(FILES ${PROJECT_SOURCE_DIR}/src/prostm/prostm.hpp ${PROJECT_SOURCE_DIR}/src/prostm/version.hpp
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/prostm)
prostm_install(prostmTargets core target acoustics felt plan am emit device score)

# before 1.0 a minor version may change anything
write_basic_package_version_file(${PROJECT_BINARY_DIR}/prostmConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_SOURCE_DIR}/cmake/prostmConfig.cmake ${PROJECT_BINARY_DIR}/prostmConfigVersion.cmake
        DESTINATION ${package_folder})
# the prefix relative to the pkg-config file, so that the installed tree can be moved
cmake_path(RELATIVE_PATH CMAKE_INSTALL_PREFIX BASE_DIRECTORY ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig
           OUTPUT_VARIABLE up_to_prefix)
configure_file(${PROJECT_SOURCE_DIR}/cmake/prostm.pc.in ${PROJECT_BINARY_DIR}/prostm.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/prostm.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

if(PROSTM_PROGRAM)
  install(TARGETS prostm_sockets EXPORT prostmPipelineTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  prostm_install(prostmPipelineTargets track hand stimulus contact fluid pipeline)
  install(TARGETS prostm RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
