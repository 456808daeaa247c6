#pragma once
/// A protocol and a stand-in for a run, for tests of studies.

#include <nlohmann/json.hpp>
#include <string>

#include "prostm/study/session/session.hpp"
#include "prostm/study/task/protocol_file.hpp"

namespace prostm::test {

/// Facts about the run, for the first line of a participant's file.
inline const nlohmann::ordered_json kFacts = {{"prostm", "test"}, {"rehearsal", false}};

inline Protocol study_protocol(const std::string& more = "", const std::string& methods =
                                                                 "[method.am.pipeline]\n"
                                                                 "method = \"am\"\n"
                                                                 "[method.pro-stm]\n") {
  return protocol_from_toml(
      "[study]\ntitle = \"Plumes\"\nseed = 3\n" + more +
          "[scene.one-plume]\nquestion = \"One?\"\n[scene.four-plumes]\nquestion = \"Four?\"\n" +
          methods,
      "p.toml", PipelineSettings{});
}

/// A hand held still, in a run that obeys at once.
inline StudySight sight_at(double time) {
  StudySight sight;
  sight.time = time;
  sight.utc = 1.7e9 + time;
  sight.in_force = true;
  sight.palm = Pose(Eigen::Translation3d(0.01, 0.02, 0.2));
  sight.target_force = sight.rendered_force = 4e-4;
  return sight;
}

}  // namespace prostm::test
