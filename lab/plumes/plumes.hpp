#pragma once
/// Measures the targets that the scenes make on held hands, frame by frame.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "prostm/pipeline/settings.hpp"
#include "prostm/pipeline/smoke/scene.hpp"
#include "prostm/stimulus/stimulus_gate.hpp"
#include "prostm/track/hand_source.hpp"
#include "report.hpp"

namespace prostm::bench {

/// A hand to measure on, and the place of the jets for it.
struct HeldCase {
  std::string name;
  std::function<std::unique_ptr<HandSource>(const PipelineSettings&)> make;
  JetPlace place = JetPlace::Hand;
  bool has_pad = false;  ///< a finger's pad is over the scene's first jet
};

/// Returns the study hand in several sizes, left, to the side, high and low; the scripted hand,
/// still and moving; a finger; and the recordings in `folder` (none if it is empty), with their
/// tremor above this frequency [Hz]; 0: still.
std::vector<HeldCase> held_cases(const std::string& folder, double tremor_above = 0.0);

struct Measured {
  std::vector<FieldShape> frames;
  Distribution pad;   ///< force on the skin within 30 mm of the first jet's axis [mN]
  double size = 1.0;  ///< scale of the scene's place
  double pass = 0.0;  ///< share of frames that the gate passes
  std::string says;   ///< the gate's sentence on the last frame
};

/// Lets the air settle for 5 s, then measures `frames` targets, one per step. @param dt step [s].
Measured measure_plumes(const HeldCase& held, const PipelineSettings& settings, double dt,
                        int frames);

/// Adds rows of the results: the share of frames with the right number of maxima that are all at
/// least 0.8 of the largest, and with saddles of at most 0.7; balance, saddle, spacing, area,
/// force and largest pressure over the frames.
void add_rows(const std::string& name, const Measured& measured, int maxima,
              std::vector<Row>& rows);

}  // namespace prostm::bench
