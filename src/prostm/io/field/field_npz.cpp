/// NumPy's .npz: a zip archive of .npy files (numpy.savez and numpy.savez_compressed).
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <zip.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "prostm/core/file/file_kind.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/core/text/nearest_name.hpp"
#include "prostm/io/field/field_file.hpp"

namespace prostm {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{1} << 30;  // largest size of an array
constexpr zip_int64_t kMaxArrays = 10'000;
constexpr std::string_view kEnding = ".npy";

struct ArchiveDeleter {
  void operator()(zip_t* archive) const { zip_discard(archive); }
};
struct MemberDeleter {
  void operator()(zip_file_t* member) const { zip_fclose(member); }
};
using Archive = std::unique_ptr<zip_t, ArchiveDeleter>;

[[noreturn]] void broken(const std::string& name, const std::string& why) {
  throw InputError(
      fmt::format("{}: the archive is truncated or damaged ({}); save it again", name, why));
}

/// @pre bytes outlive the archive.
Archive open_archive(std::string_view bytes, const std::string& name) {
  if (!bytes.starts_with("PK")) {
    throw InputError(name + " " + is_not(bytes, "an NPZ archive") +
                     "; save arrays with numpy.savez");
  }
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, &error);
  Archive archive(source == nullptr ? nullptr : zip_open_from_source(source, ZIP_RDONLY, &error));
  const std::string why = archive ? "" : zip_error_strerror(&error);
  zip_error_fini(&error);
  if (archive) return archive;
  if (source != nullptr) zip_source_free(source);
  broken(name, why);
}

/// The names of the arrays, in order.
std::vector<std::string> arrays_of(zip_t* archive) {
  std::vector<std::string> names;
  const zip_int64_t count = std::min<zip_int64_t>(zip_get_num_entries(archive, 0), kMaxArrays);
  for (zip_int64_t i = 0; i < count; ++i) {
    const char* member = zip_get_name(archive, static_cast<zip_uint64_t>(i), ZIP_FL_ENC_GUESS);
    if (member == nullptr || !std::string_view(member).ends_with(kEnding)) continue;
    names.emplace_back(member, std::string_view(member).size() - kEnding.size());
  }
  return names;
}

/// The requested array, or the only one. @throws InputError if it does not exist.
std::string chosen_array(const std::vector<std::string>& arrays, const std::string& name,
                         const FieldFileOptions& options) {
  if (arrays.empty()) throw InputError(name + ": holds no array; save one with numpy.savez");
  if (options.variable.empty() && arrays.size() == 1) return arrays.front();
  if (std::ranges::find(arrays, options.variable) != arrays.end()) return options.variable;
  std::vector<std::string> shown;
  constexpr std::size_t kMostShown = 20;
  for (std::size_t i = 0; i < std::min(arrays.size(), kMostShown); ++i)
    shown.push_back(shown_name(arrays[i]));
  const std::string all =
      fmt::format("{}{}", fmt::join(shown, ", "), arrays.size() > kMostShown ? ", …" : "");
  if (options.variable.empty()) {
    throw InputError(fmt::format("{}: holds {} arrays; choose one with {}: {}", name, arrays.size(),
                                 options.names.variable, all));
  }
  throw InputError(
      fmt::format("{}: has no array \"{}\"; it has {}", name, shown_name(options.variable), all));
}

std::string read_member(zip_t* archive, const std::string& array, const std::string& name) {
  const std::string member = array + std::string(kEnding);
  zip_stat_t status;
  zip_stat_init(&status);
  if (zip_stat(archive, member.c_str(), ZIP_FL_ENC_GUESS, &status) != 0)
    broken(name, zip_strerror(archive));
  if (status.size > kMaxBytes) {
    throw InputError(fmt::format("{}: array {} is larger than the {} MB that it may have", name,
                                 shown_name(array), kMaxBytes >> 20));
  }
  const std::unique_ptr<zip_file_t, MemberDeleter> file(
      zip_fopen(archive, member.c_str(), ZIP_FL_ENC_GUESS));
  if (!file) broken(name, zip_strerror(archive));

  // in parts: the size stated in an archive may be wrong, so it is not allocated in advance
  std::string bytes, part(1 << 16, '\0');
  for (;;) {
    const zip_int64_t n = zip_fread(file.get(), part.data(), part.size());
    if (n < 0) broken(name, zip_file_strerror(file.get()));
    if (n == 0) return bytes;
    bytes.append(part, 0, static_cast<std::size_t>(n));
    if (bytes.size() > kMaxBytes) broken(name, "an array is larger than the archive states");
  }
}

}  // namespace

TargetField field_from_npz(std::string_view bytes, const std::string& name, double cell_mm,
                           const FieldFileOptions& options) {
  const Archive archive = open_archive(bytes, name);
  const std::string array = chosen_array(arrays_of(archive.get()), name, options);
  return field_from_npy(read_member(archive.get(), array, name),
                        fmt::format("{}, array {}", name, shown_name(array)), cell_mm,
                        options.frame, options.names.frame);
}

}  // namespace prostm
