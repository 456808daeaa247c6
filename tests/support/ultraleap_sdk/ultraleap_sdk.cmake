# test_ultraleap: the adapter to Ultraleap's SDK, compiled against a stand-in of the SDK's interface that is written here.
set(prostm_alone_ultraleap "UltraleapArray*")
prostm_test(ultraleap prostm_device prostm_fields)
target_sources(test_ultraleap PRIVATE ${prostm_ultraleap_sources} support/ultraleap_sdk/library.cpp
               support/ultraleap_sdk/streaming.cpp)
target_include_directories(test_ultraleap BEFORE PRIVATE support/ultraleap_sdk/include)
# the definition of the adapter's sources holds in this folder; they replace those of the library when it is linked
set_source_files_properties(${prostm_ultraleap_sources} PROPERTIES COMPILE_DEFINITIONS PROSTM_ULTRALEAP
                            SKIP_PRECOMPILE_HEADERS ON)

get_target_property(eigen Eigen3::Eigen INTERFACE_INCLUDE_DIRECTORIES)
add_test(NAME ultraleap.compilers COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/support/ultraleap_sdk/compile_adapter.py
         ${PROJECT_SOURCE_DIR} ${eigen})
set_tests_properties(ultraleap.compilers PROPERTIES TIMEOUT 900 SKIP_RETURN_CODE 77)
