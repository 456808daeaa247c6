/// The hand of a study, which needs no file and does not move.

#include "prostm/track/detail/hand_skeleton.hpp"
#include "prostm/track/detail/track_settings.hpp"
#include "prostm/track/hand_source.hpp"

namespace prostm {
namespace {

class StudyHand final : public HandSource {
 public:
  explicit StudyHand(const StudyHandSettings& settings) {
    validate(settings);
    Pose X_TH = Pose::Identity();
    X_TH.translation() = Vec3(0.0, settings.height, 0.0);
    pose_flat_hand(X_TH, settings.size, settings.side, hand_);
    hand_.id = 1;
    hand_.velocity.fill(Vec3::Zero());
  }

  void sample(double time, HandFrame& out) override {
    out.time = time;
    out.age = 0.0;
    out.hands.clear();
    if (time >= 0.0) out.hands.push_back(hand_);
  }

 private:
  Hand hand_;
};

}  // namespace

std::unique_ptr<HandSource> make_study_hand(const StudyHandSettings& settings) {
  return std::make_unique<StudyHand>(settings);
}

}  // namespace prostm
