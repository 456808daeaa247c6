#pragma once
/// The trials of one participant. Later trials may depend on the answers to earlier ones.

#include <cstddef>
#include <vector>

#include "prostm/core/random.hpp"
#include "prostm/study/protocol/order.hpp"
#include "prostm/study/task/track.hpp"

namespace prostm {

/// Does not depend on time: the same protocol, participant and answers give the same trials.
///
/// A task without levels has a list of trials. Other tasks have tracks: for each method, in the
/// order of method_order(), `tracks` searches in each scene. Tracks are interleaved: in every round
/// each unfinished track has one trial, in random order. For each trial, the interval that has the
/// level is drawn at random.
class Course {
 public:
  /// A track with its method and scene, and the random numbers for its intervals.
  struct Lane {
    int method = 0, scene = 0;
    Track track;
    Random intervals;
  };

  /// @pre the protocol outlives this.
  Course(const Protocol& protocol, int participant);

  bool is_done() const;
  /// The next trial, or the one in progress. @pre !is_done().
  const Trial& trial() const { return trial_; }
  /// Whether this trial is the first with its method.
  bool starts_method() const { return starts_method_; }
  std::size_t done() const { return given_.size(); }
  std::size_t most() const { return most_; }  ///< total number of trials, or its upper limit
  bool is_open() const { return open_; }      ///< whether most() is only an upper limit

  /// Records an answer. @param felt for staircases: whether the answer was for the level.
  void answer(bool felt);
  /// Changes the previous answer to the other one. @return false, with nothing changed, if that
  /// would change which trials there are. @pre a trial was answered, and it was not an adjustment.
  bool correct();
  /// Changes the level of the adjustment in progress.
  void tune(int steps, bool coarse);
  /// Ends the adjustment at a level.
  void accept(double level);

  /// Tracks, indexed by track number − 1; empty for tasks without levels.
  const std::vector<Lane>& lanes() const { return lanes_; }
  /// Current estimate of a track (numbered from 1); NaN before the first.
  double result(int track) const;

 private:
  void step();
  void next_lane();
  Lane& lane() { return lanes_[static_cast<std::size_t>(trial_.track - 1)]; }

  const Protocol* protocol_;
  int participant_;
  std::vector<Trial> list_;  // for tasks without levels
  std::vector<Lane> lanes_;
  std::vector<int> methods_;
  std::size_t method_ = 0;          // index into methods_
  std::vector<std::size_t> round_;  // lanes left in this round, in reverse order
  Random turns_;
  Trial trial_;
  bool starts_method_ = true, open_ = false;
  std::size_t most_ = 0;
  std::vector<bool> given_;  // answers
};

}  // namespace prostm
