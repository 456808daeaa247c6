# find_package(prostm) provides the planner's library: prostm::core, target, acoustics, felt, plan, am, emit, device and
# score. find_package(prostm COMPONENTS pipeline) adds prostm::track, hand, stimulus, contact, fluid and
# pipeline.
foreach(component ${prostm_FIND_COMPONENTS})
  if(component STREQUAL "pipeline" AND EXISTS ${CMAKE_CURRENT_LIST_DIR}/prostmPipelineTargets.cmake)
    set(prostm_pipeline_FOUND TRUE)
  elseif(prostm_FIND_REQUIRED_${component})
    set(prostm_FOUND FALSE)
    string(CONCAT prostm_NOT_FOUND_MESSAGE "this prostm has no component '${component}'; the only one is pipeline, "
           "in a prostm built with PROSTM_PROGRAM=ON; the planner's libraries need no component")
    return()
  endif()
endforeach()

include(CMakeFindDependencyMacro)
find_dependency(Threads)
find_dependency(Eigen3 3.4 NO_MODULE)
find_dependency(hwy)
find_dependency(Boost 1.81)
find_dependency(fmt)
find_dependency(nlohmann_json)
include(${CMAKE_CURRENT_LIST_DIR}/prostmTargets.cmake)
if(prostm_pipeline_FOUND)
  find_dependency(OpenXR)
  include(${CMAKE_CURRENT_LIST_DIR}/prostmPipelineTargets.cmake)
endif()
