#include "run/mute_watch.hpp"

#include <string_view>
#include <utility>

#include "prostm/core/stage_timer.hpp"

namespace prostm::app {
namespace {

constexpr double kLook = 0.02;  // [s]

/// Characters that mute. A terminal does not report the position of a key, so these are M, and the
/// characters that layouts of other scripts have at its position (xkeyboard-config) or as their m.
constexpr std::u32string_view kMuteKeys =
    U" mM\uff4d\uff2d"                                   // Latin, and full width
    U"\u00b5\u03bc\u039c"                                // Greek
    U"\u044c\u042c\u043c\u041c\u043f\u041f\u0442\u0422"  // Cyrillic
    U"\u0584\u0554\u0574\u0544\u10db\u1c9b"              // Armenian, Georgian
    U"\u05e6\u05de\u0629\u0645\u067e\u0626"              // Hebrew, Arabic, Persian
    U"\u0938\u092e\u09ae\u09b8\u0a2e\u0aae\u0b2e\u0bae\u0c2e\u0cae\u0d2e\u0db8"  // of India
    U"\u0e17\u0e97\u1019\u1798"   // Thai, Lao, Burmese, Khmer
    U"\u30e2\u3082\u3129\u3161";  // Japanese, Bopomofo, Korean

}  // namespace

MuteWatch::MuteWatch(std::shared_ptr<Mute> mute, bool keys) : mute_(std::move(mute)) {
  if (keys) keys_.emplace();
}

std::optional<std::string> MuteWatch::help() const {
  if (!keys_ || !keys_->available()) return std::nullopt;
  return "Keys: m or space mutes the array, and unmutes it; Ctrl-C ends the run.";
}

std::optional<std::string> MuteWatch::look() {
  const double now = steady_now();
  if (now - looked_ >= kLook) {
    looked_ = now;
    while (const std::optional<char32_t> key = keys_ ? keys_->next() : std::nullopt) {
      if (kMuteKeys.find(*key) != kMuteKeys.npos)
        mute_->set(MuteReason::Person, !mute_->on(MuteReason::Person));
    }
  }
  const auto changed = [this](MuteReason reason, bool& known) {
    const bool before = std::exchange(known, mute_->on(reason));
    return known != before;
  };
  if (changed(MuteReason::Calibration, calibrating_)) {
    return calibrating_ ? "The array is muted for the calibration of the tracker."
                        : "The calibration is over: the array is not muted any more.";
  }
  if (changed(MuteReason::Person, by_person_)) {
    return by_person_ ? "The array is muted." : "The array is not muted any more.";
  }
  if (changed(MuteReason::Hot, hot_)) {
    return hot_ ? "The array is too hot, so it is muted until it has cooled down."
                : "The array has cooled down: it is not muted any more.";
  }
  return std::nullopt;
}

}  // namespace prostm::app
