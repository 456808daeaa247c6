#include "prostm/io/hand/detail/frame_order.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace prostm {
namespace {

constexpr std::size_t kNone = static_cast<std::size_t>(-1);

/// The longest subsequence of strictly increasing times; the first of equal times.
std::vector<std::size_t> longest_increasing(std::span<const FrameTime> frames) {
  std::vector<std::size_t> last;  // last frame of the best sequence of each length
  std::vector<std::size_t> before(frames.size(),
                                  kNone);  // predecessor in the best sequence to each frame
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto at =
        std::lower_bound(last.begin(), last.end(), frames[i].time,
                         [&](std::size_t n, double time) { return frames[n].time < time; });
    if (at != last.end() && frames[*at].time == frames[i].time) continue;
    if (at != last.begin()) before[i] = *(at - 1);
    if (at == last.end()) {
      last.push_back(i);
    } else {
      *at = i;
    }
  }
  std::vector<std::size_t> kept;
  for (std::size_t i = last.empty() ? kNone : last.back(); i != kNone; i = before[i])
    kept.push_back(i);
  std::reverse(kept.begin(), kept.end());
  return kept;
}

/// Compares intervals with the usual one.
class Fit {
 public:
  Fit(std::span<const FrameTime> frames, double interval) : frames_(frames), interval_(interval) {}

  /// Deviation of frame i from the usual interval to both neighbours, as a sum of logarithms;
  /// nothing if it is not between them.
  std::optional<double> misfit(std::size_t before, std::size_t i, std::size_t after) const {
    double sum = 0.0;
    for (const auto& [a, b] : {std::pair(before, i), std::pair(i, after)}) {
      if (a == kNone || b == kNone) continue;
      const double step = (frames_[b].time - frames_[a].time) /
                          static_cast<double>(frames_[b].place - frames_[a].place);
      if (!(step > 0.0)) return {};
      sum += std::abs(std::log(step / interval_));
    }
    return sum;
  }

 private:
  std::span<const FrameTime> frames_;
  double interval_;
};

/// Replaces a frame in `kept` by an omitted neighbour that fits better.
void mend(std::size_t left_out, const Fit& fit, std::vector<std::size_t>& kept) {
  constexpr double kClearly = 0.5;  // a factor of 1.6 in an interval
  const auto n =
      static_cast<std::size_t>(std::lower_bound(kept.begin(), kept.end(), left_out) - kept.begin());
  const auto at = [&](std::size_t k) { return k < kept.size() ? kept[k] : kNone; };
  for (const std::size_t k : {n, n - 1}) {
    if (k >= kept.size()) continue;
    const std::size_t before = k > 0 ? kept[k - 1] : kNone, after = at(k + 1);
    if ((before != kNone && before >= left_out) || (after != kNone && after <= left_out)) continue;
    const auto mine = fit.misfit(before, left_out, after), its = fit.misfit(before, kept[k], after);
    if (!mine || !its || !(*mine < *its - kClearly)) continue;
    kept[k] = left_out;
    return;
  }
}

}  // namespace

double usual_interval(std::span<const double> times) {
  if (times.size() < 2) return 0.0;
  std::vector<double> steps;
  for (std::size_t i = 1; i < times.size(); ++i) steps.push_back(times[i] - times[i - 1]);
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

std::vector<std::size_t> frames_in_order(std::span<const FrameTime> frames) {
  std::vector<std::size_t> kept = longest_increasing(frames);
  if (kept.size() == frames.size()) return kept;
  if (kept.size() < 2) return {0};
  std::vector<double> times;
  for (const std::size_t i : kept) times.push_back(frames[i].time);
  const Fit fit(frames, usual_interval(times));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!std::binary_search(kept.begin(), kept.end(), i)) mend(i, fit, kept);
  }
  return kept;
}

}  // namespace prostm
