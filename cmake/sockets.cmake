# The library prostm_sockets: the parts of Boost's sockets that are not templates, compiled once.
set(sockets_source ${PROJECT_BINARY_DIR}/sockets.cpp)
file(CONFIGURE OUTPUT ${sockets_source} CONTENT "#include <boost/asio/impl/src.hpp>\n#include <boost/beast/src.hpp>\n")
add_library(prostm_sockets STATIC ${sockets_source})
set_target_properties(prostm_sockets PROPERTIES EXPORT_NAME sockets)
target_compile_definitions(prostm_sockets PUBLIC BOOST_ASIO_SEPARATE_COMPILATION BOOST_BEAST_SEPARATE_COMPILATION)
target_link_libraries(prostm_sockets PUBLIC Boost::headers Threads::Threads)
