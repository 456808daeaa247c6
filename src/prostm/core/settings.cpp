#include "prostm/core/settings.hpp"

#include <algorithm>

#include "prostm/core/require.hpp"

namespace prostm {
namespace {

int to_int(double bound) {
  return static_cast<int>(
      std::clamp<double>(bound, std::numeric_limits<int>::min(), std::numeric_limits<int>::max()));
}

class BoundsCheck : public SettingsReader {
 public:
  void field(const Setting& s, const double& value) override {
    require_between(s.name, value, s.least, s.most, s.unit);
  }
  void field(const Setting& s, const int& value) override {
    require_between(s.name, value, to_int(s.least), to_int(s.most), s.unit);
  }
  void field(const Setting&, const bool&) override {}
  void field(const Setting&, const std::string&) override {}
  void choice(const Setting&, std::span<const std::string_view>, int) override {}
};

}  // namespace

void require_bounds(const ReadSettings& settings) {
  BoundsCheck check;
  settings(check);
}

}  // namespace prostm
