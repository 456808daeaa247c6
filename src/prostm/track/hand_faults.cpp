#include "prostm/track/hand_faults.hpp"

#include <fmt/format.h>

namespace prostm {
namespace {

std::int64_t sum(const HandFaults& faults, bool of_frames) {
  std::int64_t count = 0;
  for (std::size_t f = 0; f < kHandFaults; ++f) {
    if (costs_frame(static_cast<HandFault>(f)) == of_frames) count += faults.count[f];
  }
  return count;
}

}  // namespace

std::int64_t HandFaults::frames() const {
  return sum(*this, true);
}
std::int64_t HandFaults::hands() const {
  return sum(*this, false);
}

void HandFaults::add(HandFault fault, const std::string& sentence) {
  if (!any()) first = sentence;
  last = sentence;
  ++count[static_cast<std::size_t>(fault)];
}

void HandFaults::add(const HandFaults& later) {
  if (!later.any()) return;
  if (!any()) first = later.first;
  last = later.last;
  for (std::size_t f = 0; f < kHandFaults; ++f) count[f] += later.count[f];
}

std::string causes_of(const HandFaults& faults) {
  std::string words;
  for (std::size_t f = 0; f < kHandFaults; ++f) {
    if (faults.count[f] == 0) continue;
    words += fmt::format("{}{} {}", words.empty() ? "" : ", ", faults.count[f],
                         name_of(static_cast<HandFault>(f)));
  }
  return words;
}

}  // namespace prostm
