#include "prostm/study/session/detail/session_lines.hpp"

#include <fmt/format.h>

#include <boost/crc.hpp>
#include <utility>

#include "prostm/core/input_error.hpp"
#include "prostm/io/settings_file.hpp"
#include "prostm/study/task/line_keys.hpp"
#include "prostm/study/task/task.hpp"

namespace prostm::study {

/// [s, x, y, z in mm, quaternion x, y, z, w]
nlohmann::ordered_json pose_json(double time, const Pose& X_DP) {
  nlohmann::ordered_json json = {rounded(time, 3)};
  for (int axis = 0; axis < 3; ++axis) json.push_back(rounded(1e3 * X_DP.translation()[axis], 1));
  const Quat q(X_DP.rotation());
  for (const double part : {q.x(), q.y(), q.z(), q.w()}) json.push_back(rounded(part, 4));
  return json;
}

nlohmann::ordered_json gate_json(const std::optional<GateResult>& gate) {
  if (!gate) return nullptr;
  return {{"pass", gate->pass},
          {"share", rounded(gate->share, 3)},
          {"problem", name_of(gate->finding.problem)},
          {"maxima", gate->shape.count()},
          {"balance", rounded(gate->shape.balance, 3)},
          {"saddle", rounded(gate->shape.saddle, 3)},
          {"area_cm2", rounded(1e4 * gate->shape.area, 1)},
          {"force_mn", rounded(1e3 * gate->shape.force, 3)}};
}

std::string stimulus_hash(const Protocol& protocol, const Trial& trial) {
  PipelineSettings settings = protocol.methods[static_cast<std::size_t>(trial.method)].settings;
  if (trial.level) set_level(settings, protocol.level.setting, *trial.level);
  boost::crc_32_type sum;
  const std::string text = settings_to_json(study_settings_groups(settings)).dump() +
                           protocol.scenes[static_cast<std::size_t>(trial.scene)].name;
  sum.process_bytes(text.data(), text.size());
  return fmt::format("{:08x}", sum.checksum());
}

double number_in(const ResponseLine& line, const char* key, const std::string& file) {
  const auto found = line.find(key);
  if (found != line.end() && found->is_number()) return found->get<double>();
  throw InputError(
      fmt::format("{}: the line of kind \"{}\" of trial {} has no number \"{}\", so the session "
                  "cannot be resumed",
                  file, line.value(line::kKind, ""), line.value(line::kTrial, 0), key));
}

std::string bound_sentence(const Protocol& protocol, const Course::Lane& lane) {
  const AtBound bound = lane.track.at_bound();
  std::string where = "an end of its range";
  if (!protocol.study.blind) {
    where =
        fmt::format("the {} end of its range ({} = {:g}; {} with {})", bound.low ? "low" : "high",
                    protocol.level.setting, bound.low ? protocol.level.low : protocol.level.high,
                    protocol.scenes[static_cast<std::size_t>(lane.scene)].name,
                    protocol.methods[static_cast<std::size_t>(lane.method)].name);
  }
  if (protocol.trials.task->is_tuned())
    return "An adjustment was accepted at " + where + ", so the result may lie beyond it.";
  return fmt::format(
      "{} answers in a row left a staircase at {}, so the threshold may lie beyond it. Check that "
      "the participant has understood the question and does not always give the same answer.",
      bound.answers, where);
}

ResponseLine stamped(ResponseLine line, const StudySight& sight) {
  line["utc"] = utc_text(sight.utc);
  line["time_s"] = rounded(sight.time, 4);
  return line;
}

}  // namespace prostm::study
