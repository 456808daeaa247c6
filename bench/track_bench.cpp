/// Errors of the assumed hand positions some time after a tracker's frame: held at the last frame
/// or predicted as CausalTrack does. Uses real recordings, if available, and the scripted hand at
/// 110 frames a second.
///
/// usage: track_bench [--json FILE] [--recordings FOLDER]

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "program.hpp"
#include "prostm/io/hand/hand_file.hpp"
#include "prostm/track/detail/causal_track.hpp"

namespace prostm {
namespace {

constexpr double kHorizons[] = {0.010, 0.020, 0.030, 0.040};  // [s]
constexpr std::array<std::size_t, 6> kJoints = {kPalm,      kThumbTip, kIndexTip,
                                                kMiddleTip, kRingTip,  kLittleTip};

/// Interpolates the true hand linearly between the recording's frames; false if it is not tracked.
bool truth(const HandRecording& recording, const Hand& hand, double time, Hand& out) {
  const auto after = std::upper_bound(recording.frames.begin(), recording.frames.end(), time,
                                      [](double t, const HandFrame& f) { return t < f.time; });
  if (after == recording.frames.begin() || after == recording.frames.end()) return false;
  const HandFrame &late = *after, &early = *std::prev(after);
  const auto find = [&](const HandFrame& frame) {
    return std::find_if(frame.hands.begin(), frame.hands.end(), [&](const Hand& other) {
      return other.id == hand.id && other.side == hand.side;
    });
  };
  const auto a = find(early), b = find(late);
  if (a == early.hands.end() || b == late.hands.end()) return false;
  const double u = (time - early.time) / (late.time - early.time);
  for (std::size_t j = 0; j < kJointCount; ++j)
    out.position[j] = a->position[j] + u * (b->position[j] - a->position[j]);
  return true;
}

/// Returns the errors of palm and finger tips [mm], `horizon` [s] after each frame.
std::vector<double> errors(const HandRecording& recording, double horizon, bool predicted) {
  TrackSettings settings;
  settings.prediction = predicted ? horizon : 0.0;
  CausalTrack track(settings);
  std::vector<double> mm;
  HandFrame out;
  Hand there;
  for (const HandFrame& frame : recording.frames) {
    track.add(frame);
    track.sample(frame.time, out);
    for (const Hand& hand : out.hands) {
      if (!truth(recording, hand, frame.time + horizon, there)) continue;
      for (const std::size_t j : kJoints)
        mm.push_back(1e3 * (hand.position[j] - there.position[j]).norm());
    }
  }
  return mm;
}

Summary summary_of(const std::vector<double>& values) {
  Distribution all(values.size() + 1);
  for (const double value : values) all.add(value);
  return all.summary();
}

HandRecording scripted(double jitter) {
  ScriptedHandSettings settings;
  settings.jitter = jitter;
  TrackSettings unsmoothed;
  const auto source = make_scripted_hand(settings, unsmoothed);
  HandRecording recording;
  // at the tracker's own instants, so that no noise is averaged between frames
  for (int i = 0; i < 4400; ++i) {
    source->sample(i / 110.0, recording.frames.emplace_back());
  }
  return recording;
}

void add_rows(const std::string& name, const HandRecording& recording,
              std::vector<bench::Row>& rows) {
  for (const double horizon : kHorizons) {
    const std::vector<double> held = errors(recording, horizon, false),
                              ahead = errors(recording, horizon, true);
    const auto line = [&](const char* how, const std::vector<double>& mm) {
      fmt::print("{:<28} {:>4.0f} ms  {:<10} {:>8.2f} {:>8.2f} {:>8.2f}\n", name, horizon * 1e3,
                 how, quantile(mm, 0.5), quantile(mm, 0.95), quantile(mm, 1.0));
    };
    line("held", held);
    line("predicted", ahead);
    rows.push_back({fmt::format("{}, {:.0f} ms ahead", name, horizon * 1e3), "mm",
                    summary_of(ahead), "held", quantile(held, 0.5)});
  }
}

std::vector<bench::Row> measure(const std::string& folder) {
  fmt::print("error [mm]                                           p50      p95      max\n");
  std::vector<bench::Row> rows;
  add_rows("scripted", scripted(0.0), rows);
  add_rows("scripted, 0.3 mm of noise", scripted(3e-4), rows);
  if (!std::filesystem::is_directory(folder)) {
    fmt::print("{} not found: no real recordings\n", folder);
    return rows;
  }
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().string().ends_with(".hands.jsonl")) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  for (const auto& file : files)
    add_rows(file.stem().stem().string(), read_hand_recording(file.string()), rows);
  return rows;
}

}  // namespace
}  // namespace prostm

int main(int argc, char** argv) {
  prostm::bench::Program program("The error of predicted hands.");
  std::string folder = "../shared/data/hands";
  program.option("--recordings", folder, "folder with recordings, NAME.hands.jsonl");
  return program.run(argc, argv, [&] { return prostm::measure(folder); });
}
