# test_ultraleap: the adapter to Ultraleap's SDK, compiled against a stand-in of the SDK's interface that is written here.
prostm_test(ultraleap prostm_device prostm_fields)
target_sources(test_ultraleap PRIVATE ${prostm_ultraleap_sources} ultraleap_sdk/library.cpp ultraleap_sdk/streaming.cpp)
target_include_directories(test_ultraleap BEFORE PRIVATE ultraleap_sdk/include)
# the definition of the adapter's sources holds in this folder; they replace those of the library when it is linked
set_source_files_properties(${prostm_ultraleap_sources} PROPERTIES COMPILE_DEFINITIONS PROSTM_ULTRALEAP
                            SKIP_PRECOMPILE_HEADERS ON)
