#include "prostm/track/detail/hand_ids.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>

namespace prostm {
namespace {

/// A hand as it was last seen, with the id that its tracker gave it and the id that it keeps.
struct KnownHand {
  std::int64_t given = 0, kept = 0;
  Side side = Side::Right;
  Vec3 palm = Vec3::Zero();
  double time = 0.0;
};

class Renamer {
 public:
  Renamer(const HandRecording& recording, const TrackSettings& settings) : settings_(settings) {
    for (const HandFrame& frame : recording.frames) {
      for (const Hand& hand : frame.hands) next_ = std::max(next_, hand.id + 1);
    }
  }

  void rename(HandFrame& frame) {
    std::erase_if(known_, [&](const KnownHand& known) {
      return frame.time - known.time > settings_.max_gap;
    });
    const HandFrame given = frame;
    for (std::size_t h = 0; h < frame.hands.size(); ++h) {
      KnownHand& known = known_hand(given, given.hands[h]);
      joined_ = joined_ || known.time < frame.time;
      known.given = given.hands[h].id;
      known.palm = given.hands[h].position[kPalm];
      known.time = frame.time;
      frame.hands[h].id = known.kept;
    }
  }
  /// Whether any hand was in two frames.
  bool joined() const { return joined_; }

 private:
  static bool is(const KnownHand& known, const Hand& hand) {
    return known.given == hand.id && known.side == hand.side;
  }

  KnownHand& known_hand(const HandFrame& frame, const Hand& hand) {
    const auto own =
        std::find_if(known_.begin(), known_.end(), [&](const auto& k) { return is(k, hand); });
    if (own != known_.end()) return *own;
    KnownHand* nearest = nullptr;
    double least = settings_.max_speed;  // [m/s]
    for (KnownHand& known : known_) {
      const bool kept = std::any_of(frame.hands.begin(), frame.hands.end(),
                                    [&](const Hand& other) { return is(known, other); });
      if (kept || known.side != hand.side || !(known.time < frame.time)) continue;
      const double speed = (hand.position[kPalm] - known.palm).norm() / (frame.time - known.time);
      if (speed > least) continue;
      least = speed;
      nearest = &known;
    }
    return nearest != nullptr ? *nearest : add(frame, hand);
  }

  KnownHand& add(const HandFrame& frame, const Hand& hand) {
    const bool taken = std::any_of(known_.begin(), known_.end(),
                                   [&](const KnownHand& known) { return known.kept == hand.id; });
    known_.push_back({hand.id, taken ? next_++ : hand.id, hand.side, Vec3::Zero(), frame.time});
    return known_.back();
  }

  const TrackSettings& settings_;
  std::vector<KnownHand> known_;
  std::int64_t next_ = 0;  // an unused id
  bool joined_ = false;
};

}  // namespace

void keep_ids(HandRecording& recording, const TrackSettings& settings) {
  Renamer renamer(recording, settings);
  int with_hands = 0;
  for (HandFrame& frame : recording.frames) {
    with_hands += frame.hands.empty() ? 0 : 1;
    renamer.rename(frame);
  }
  if (with_hands < 2 || renamer.joined()) return;
  std::ostringstream sentence;
  sentence << "no hand of the recording is in two frames within max_gap = " << settings.max_gap
           << " s, so it never moves; frames must come faster, or max_gap must be longer";
  throw std::invalid_argument(sentence.str());
}

}  // namespace prostm
