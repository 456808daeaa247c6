#include "field/quality_words.hpp"

#include <fmt/format.h>

#include <cmath>

namespace prostm::app {
namespace {

void print_number(std::FILE* out, const char* name, const std::string& value) {
  fmt::print(out, "  {:<18} {}\n", name, value);
}

std::string range(const double Metrics::*metric, const Metrics* lowest, const Metrics* highest,
                  int digits) {
  if (lowest == nullptr || highest == nullptr) return {};
  return fmt::format(" ({:.{}f} to {:.{}f})", lowest->*metric, digits, highest->*metric, digits);
}

}  // namespace

std::string level_words(double level, const SensationInterval& interval) {
  const char* sound = interval.sound == SoundSource::Nominal
                          ? "; no sound level of this array was measured, so this is nominal"
                          : "";
  return sensation_words(level, interval) + sound;
}

std::string quality_line(const Metrics& metrics, const SensationInterval& interval) {
  std::string line = fmt::format("shape by Eq. (1) {:.2f}", metrics.skill_0);
  if (std::isfinite(metrics.felt_skill))
    line += fmt::format(" · felt shape {:.2f}", metrics.felt_skill);
  if (std::isfinite(metrics.sensation_level))
    line += " · felt strength " + level_words(metrics.sensation_level, interval);
  return line + fmt::format(" · spill {:.3f}", metrics.spill);
}

void print_quality_numbers(std::FILE* out, const Metrics& metrics,
                           const SensationInterval& interval, const std::string& unfelt,
                           const Metrics* lowest, const Metrics* highest) {
  const auto number = [&](double Metrics::*metric, int digits) {
    return fmt::format("{:.{}f}{}", metrics.*metric, digits,
                       range(metric, lowest, highest, digits));
  };
  print_number(out, "shape by Eq. (1)", number(&Metrics::skill_0, 2));
  print_number(out, "felt shape",
               std::isfinite(metrics.felt_skill) ? number(&Metrics::felt_skill, 2) : unfelt);
  if (std::isfinite(metrics.sensation_level)) {
    std::string level = level_words(metrics.sensation_level, interval);
    if (lowest != nullptr && highest != nullptr) {
      level += fmt::format("; plans {:.0f} to {:.0f} dB", lowest->sensation_level,
                           highest->sensation_level);
    }
    print_number(out, "felt strength", level);
  }
  print_number(out, "spill", number(&Metrics::spill, 3));
}

}  // namespace prostm::app
