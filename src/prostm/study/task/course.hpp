#pragma once
/// The trials of one participant, of which the later ones may depend on the answers to the earlier.

#include <cstddef>
#include <vector>

#include "prostm/core/random.hpp"
#include "prostm/study/protocol/order.hpp"
#include "prostm/study/task/track.hpp"

namespace prostm {

/// A state without a clock: the same protocol, participant and answers lead to the same trials.
///
/// A task without levels has a list of trials. Other tasks have tracks: for each method, in the
/// order of method_order(), `tracks` searches in each scene. They are taken in turn: in every round
/// each that is not done comes once, in a random order. Which interval is the level's is drawn for
/// each trial.
class Course {
 public:
  /// A track, and what it is presented with.
  struct Lane {
    int method = 0, scene = 0;
    Track track;
    Random intervals;
  };

  /// @pre the protocol outlives this.
  Course(const Protocol& protocol, int participant);

  bool is_done() const;
  /// The trial that is next or under way. @pre !is_done().
  const Trial& trial() const { return trial_; }
  /// Whether it is the first with its method.
  bool starts_method() const { return starts_method_; }
  std::size_t done() const { return given_.size(); }
  std::size_t most() const { return most_; }  ///< trials in all, or at most
  bool is_open() const { return open_; }      ///< whether they may become fewer

  /// Takes an answer. @param felt of a staircase: it was for the level.
  void answer(bool felt);
  /// The other answer to the trial before. @return false, and nothing is changed: that would change
  /// which trials there are. @pre one was answered, and not an adjustment.
  bool correct();
  /// Changes the level of an adjustment that is under way.
  void tune(int steps, bool coarse);
  /// Ends it at a level.
  void accept(double level);

  /// Tracks by their number less 1; none without levels.
  const std::vector<Lane>& lanes() const { return lanes_; }
  /// The level that a track, from 1, has found so far; NaN before there is any.
  double result(int track) const;

 private:
  void step();
  void next_lane();
  Lane& lane() { return lanes_[static_cast<std::size_t>(trial_.track - 1)]; }

  const Protocol* protocol_;
  int participant_;
  std::vector<Trial> list_;  // of a task without levels
  std::vector<Lane> lanes_;
  std::vector<int> methods_;
  std::size_t method_ = 0;          // place in methods_
  std::vector<std::size_t> round_;  // lanes that are still to come in this round, backwards
  Random turns_;
  Trial trial_;
  bool starts_method_ = true, open_ = false;
  std::size_t most_ = 0;
  std::vector<bool> given_;  // answers
};

}  // namespace prostm
