#pragma once
/// Collects the frames of a hand recording and drops what is bad. Private to io.

#include <functional>
#include <string>
#include <vector>

#include "prostm/track/hand_json.hpp"
#include "prostm/track/hand_source.hpp"

namespace prostm {

/// How a format writes times and lengths.
struct HandUnits {
  const char* stamp;        ///< the member with a frame's time
  double second;            ///< in the unit of `stamp`
  const char* time_unit;    ///< of `stamp`
  double metre;             ///< in the unit of positions
  const char* length_unit;  ///< of positions
};

/// Takes the frames of one file. A bad hand costs that hand, a bad frame or time that frame; a file
/// with more than a quarter of either is refused.
class HandCollector {
 public:
  HandCollector(std::string name, const HandUnits& units);

  /// Reads a frame, whose time is in seconds of any origin; `read` throws HandError for a fault of
  /// the whole frame, and counts faults of its hands.
  void add(const std::string& where,
           const std::function<HandFrame(const HandFrame* before, HandFaults& faults)>& read);
  /// Notes the distance between the knuckles of the index and the little finger, in the file's
  /// unit, of a hand that may be bad.
  void note_span(double span);
  /// Notes a frame rate that the tracker gives [Hz].
  void note_rate(double rate);

  /// @throws InputError: no frames, too many bad ones, a rate that no tracker has, more than a day.
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
