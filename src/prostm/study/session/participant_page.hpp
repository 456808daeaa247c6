#pragma once
/// The requirements on the participant's page in a study, and the page's reports.

#include <array>
#include <bitset>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "prostm/core/text/names.hpp"

namespace prostm {

/// State of the masking noise of a page.
enum class PageNoise : std::uint8_t {
  Off,     ///< the browser blocks audio: the button was not pressed since the page loaded
  Silent,  ///< audio is allowed, but no noise is measured in the output
  Playing  ///< noise is measured in the output
};
template <>
inline constexpr std::array<std::string_view, 3> kNames<PageNoise> = {"off", "silent", "playing"};

/// A report of a page about itself (docs/reference/wire.md).
struct PageReport {
  bool visible = false;  ///< the tab is in front and its window is not minimised
  PageNoise noise = PageNoise::Off;
  bool picture = false;  ///< the simulation is being drawn
};

/// Current state of the participant's page.
struct ParticipantPage {
  bool open = false;  ///< connected
  /// The newest report; none before the first, or if the page has stopped reporting.
  std::optional<PageReport> report;
};

/// Requirements of a trial, or of training, on the page.
enum class PageNeed : std::uint8_t { Open, Report, Visible, Noise, Picture };
template <>
inline constexpr std::array<std::string_view, 5> kNames<PageNeed> = {"open", "report", "visible",
                                                                     "noise", "picture"};
using PageNeeds = std::bitset<kNames<PageNeed>.size()>;  ///< indexed by PageNeed

/// Current requirements on the page.
struct PageTask {
  bool open = false;  ///< a page must be open; otherwise requirements apply to open pages only
  PageNoise noise = PageNoise::Off;  ///< minimum state
  bool picture = false;              ///< the simulation must be shown
};

/// Returns the unmet needs. An open page must always report and be visible.
PageNeeds missing(const PageTask& task, const ParticipantPage& page);

/// The names of the needs in a set.
std::vector<std::string_view> names_of(const PageNeeds& needs);

/// The first missing need and its remedy, for the experimenter; empty if none is missing.
std::string sentence(const PageNeeds& missing);

}  // namespace prostm
