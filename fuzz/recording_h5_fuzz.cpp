/// Recordings: any file gives valid frames or an InputError. HDF5 reads from a file, so this one is
/// slow.
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <string>

#include "core/input_error.hpp"
#include "io/recorder.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace prostm;
  std::string path = "/tmp/prostm-fuzz-XXXXXX";
  const int fd = ::mkstemp(path.data());
  if (fd < 0 || ::write(fd, data, size) != static_cast<ssize_t>(size)) std::abort();
  ::close(fd);
  try {
    const RecordingReader reader(path);
    static_cast<void>(reader.scene());
    for (int i = 0; i < reader.frames() && i < 4; ++i) static_cast<void>(reader.frame(i));
  } catch (const InputError&) {
    // what bad input must answer
  }
  ::unlink(path.c_str());
  return 0;
}
