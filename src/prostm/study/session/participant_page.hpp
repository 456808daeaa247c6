#pragma once
/// The duties of the participant's page in a study, and its reports.

#include <array>
#include <bitset>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "prostm/core/text/names.hpp"

namespace prostm {

/// The masking noise of a page.
enum class PageNoise : std::uint8_t {
  Off,     ///< the browser does not let the page play: its button was not pressed since it loaded
  Silent,  ///< it may play, and no noise is measured in its output
  Playing  ///< it is measured
};
template <>
inline constexpr std::array<std::string_view, 3> kNames<PageNoise> = {"off", "silent", "playing"};

/// A report of a page about itself (docs/reference/wire.md).
struct PageReport {
  bool visible = false;  ///< its tab is in front, its window not minimised
  PageNoise noise = PageNoise::Off;
  bool picture = false;  ///< the simulation is being drawn
};

/// The participant's page now.
struct ParticipantPage {
  bool open = false;  ///< connected
  /// The newest report. None before the first, and none of a page that has stopped reporting.
  std::optional<PageReport> report;
};

/// Needs of a trial, or of training, that the page must meet.
enum class PageNeed : std::uint8_t { Open, Report, Visible, Noise, Picture };
template <>
inline constexpr std::array<std::string_view, 5> kNames<PageNeed> = {"open", "report", "visible",
                                                                     "noise", "picture"};
using PageNeeds = std::bitset<kNames<PageNeed>.size()>;  ///< by the place of each

/// Demands on the page now.
struct PageTask {
  bool open = false;                 ///< it must be there; otherwise only what is open counts
  PageNoise noise = PageNoise::Off;  ///< at least
  bool picture = false;              ///< the simulation is shown
};

/// Returns the needs that are not met. A page that is open must report and be visible, whatever
/// else is asked of it.
PageNeeds missing(const PageTask& task, const ParticipantPage& page);

/// The names of the needs in a set.
std::vector<std::string_view> names_of(const PageNeeds& needs);

/// The first need that is missing and the remedy, for the experimenter; empty where nothing is.
std::string sentence(const PageNeeds& missing);

}  // namespace prostm
