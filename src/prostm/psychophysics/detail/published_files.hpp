#pragma once
/// The files of data/experiments and data/psychophysics, which the build compiles in.

#include <span>
#include <string_view>

namespace prostm {

struct PublishedFile {
  std::string_view name, text;
};
/// Returns the experiments, ordered by name.
std::span<const PublishedFile> published_files();
/// Returns the frozen parameters of the observers, and the file's SHA-256 in hexadecimal digits.
PublishedFile observers_file();
std::string_view observers_hash();

}  // namespace prostm
