#pragma once
/// Collects the frames of a hand recording, and drops bad frames and hands. Private to io.

#include <functional>
#include <string>
#include <vector>

#include "prostm/track/hand_json.hpp"
#include "prostm/track/hand_source.hpp"

namespace prostm {

/// The units of times and lengths in a format.
struct HandUnits {
  const char* stamp;        ///< the member with a frame's time
  double second;            ///< one second in the unit of `stamp`
  const char* time_unit;    ///< name of the unit of `stamp`
  double metre;             ///< one metre in the unit of positions
  const char* length_unit;  ///< name of the unit of positions
};

/// Collects the frames of one file. A bad hand is dropped, as is a frame with a fault or a bad
/// time; a file that loses more than a quarter of its frames or hands is refused.
class HandCollector {
 public:
  HandCollector(std::string name, const HandUnits& units);

  /// Adds a frame, with its time in seconds from any origin. `read` throws HandError for a fault of
  /// the whole frame, and counts faults of its hands.
  void add(const std::string& where,
           const std::function<HandFrame(const HandFrame* before, HandFaults& faults)>& read);
  /// Records the distance between the knuckles of index and little finger, in the file's unit, also
  /// of bad hands.
  void note_span(double span);
  /// Records a frame rate reported by the tracker [Hz].
  void note_rate(double rate);

  /// @throws InputError: no frames, too many bad ones, an impossible frame rate, a duration above a
  /// day.
  HandRecording finish();

 private:
  struct Frame {
    HandFrame frame;
    std::size_t place;
    std::string where;
  };
  void drop_astray();
  void drop(std::size_t i);
  void check_rate() const;
  void check_shares() const;
  std::string guess_of_lengths() const;

  std::string name_;
  HandUnits units_;
  HandReading reading_;
  std::vector<Frame> frames_;
  std::vector<double> spans_, rates_;
};

}  // namespace prostm
