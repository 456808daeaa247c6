#pragma once
/// A cache of judgements in a file, since the same plans are judged again and again.

#include <cstdint>
#include <map>
#include <optional>
#include <shared_mutex>
#include <string>
#include <vector>

#include "felt/judge.hpp"

namespace prostm::bench {

/// Judgements by a key of the plan, the target and everything else that determines the scores,
/// except the program itself: remove the file when emission, acoustics or skin change. The map
/// Judged::percept is kept only without a file. Thread-safe.
class Kept {
 public:
  /// @param path of the file, which need not exist; empty: nothing is stored. @throws InputError
  /// for a file of another kind.
  explicit Kept(std::string path);

  std::optional<Judged> find(const std::string& key) const;
  void add(const std::string& key, const Judged& judged);
  /// Writes the file, if it has a name. @throws InputError when it cannot be written.
  void write() const;

 private:
  std::string path_;
  mutable std::shared_mutex mutex_;
  std::map<std::string, Judged> all_;
};

/// Returns the key of a judgement. @param names those of skins and disturbances.
std::string key_of(const Plan& plan, const TargetField& target,
                   const std::vector<std::string>& names, std::uint64_t seed);

}  // namespace prostm::bench
