# find_package(prostm) gives prostm::target, prostm::plan, prostm::am, prostm::emit, prostm::acoustics, prostm::device and
# prostm::score. find_package(prostm COMPONENTS pipeline) gives prostm::track, prostm::hand, prostm::contact, prostm::fluid
# and prostm::pipeline too.
include(CMakeFindDependencyMacro)
find_dependency(Threads)
find_dependency(Eigen3 3.4 NO_MODULE)
find_dependency(hwy)
find_dependency(Boost 1.81)
find_dependency(fmt)
find_dependency(nlohmann_json)
include(${CMAKE_CURRENT_LIST_DIR}/prostmTargets.cmake)

foreach(component ${prostm_FIND_COMPONENTS})
  if(component STREQUAL "pipeline" AND EXISTS ${CMAKE_CURRENT_LIST_DIR}/prostmPipelineTargets.cmake)
    find_dependency(OpenXR)
    include(${CMAKE_CURRENT_LIST_DIR}/prostmPipelineTargets.cmake)
    set(prostm_pipeline_FOUND TRUE)
  elseif(prostm_FIND_REQUIRED_${component})
    set(prostm_FOUND FALSE)
    set(prostm_NOT_FOUND_MESSAGE "prostm has no component '${component}' here: it may be pipeline, built with PROSTM_PROGRAM=ON")
  endif()
endforeach()
