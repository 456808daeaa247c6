#include "prostm/study/session/detail/session_lines.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <boost/crc.hpp>
#include <cmath>
#include <utility>

#include "prostm/core/input_error.hpp"
#include "prostm/io/settings_file.hpp"
#include "prostm/study/session/session.hpp"
#include "prostm/study/task/track.hpp"

namespace prostm::study {

/// A number with so many decimals, so that files stay small.
double rounded(double value, int decimals) {
  const double scale = std::pow(10.0, decimals);
  return std::round(scale * value) / scale;
}

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
  const std::string text = settings_to_json(settings_groups(std::as_const(settings))).dump() +
                           protocol.scenes[static_cast<std::size_t>(trial.scene)].name;
  sum.process_bytes(text.data(), text.size());
  return fmt::format("{:08x}", sum.checksum());
}

void add_stimulus(ResponseLine& line, const Protocol& protocol, const Trial& trial) {
  const auto name_of_scene = [&](int scene) {
    return protocol.scenes[static_cast<std::size_t>(scene)].name;
  };
  line["method"] = protocol.methods[static_cast<std::size_t>(trial.method)].name;
  line["scene"] = name_of_scene(trial.scene);
  if (!trial.level) {
    line["question"] = name_of_scene(trial.question);
    return;
  }
  line["track"] = trial.track;
  line["level"] = *trial.level;
  if (protocol.trials.task == StudyTask::Judgement) return;
  if (protocol.standard) {
    line["reference"] = protocol.standard->name;
  } else {
    line["reference"] = protocol.level.reference;
  }
  if (protocol.trials.task == StudyTask::ForcedChoice) line["interval"] = trial.level_first ? 1 : 2;
}

bool felt(const Protocol& protocol, const Trial& trial, bool chosen) {
  return protocol.trials.task == StudyTask::ForcedChoice ? chosen != trial.level_first : chosen;
}

void add_answer(ResponseLine& line, const Protocol& protocol, const Trial& trial, bool chosen) {
  const int answer = chosen ? 1 : 0;
  const bool for_level = felt(protocol, trial, chosen);
  const StudyTask task = protocol.trials.task;
  line["answer"] = task == StudyTask::ForcedChoice ? answer + 1 : answer;
  if (task == StudyTask::Identification)
    line["correct"] = chosen == (trial.scene == trial.question) ? 1 : 0;
  if (task != StudyTask::Identification) line["felt"] = for_level ? 1 : 0;
  if (has_right_answers(protocol)) line["correct"] = for_level ? 1 : 0;
}

bool chose(const Protocol& protocol, const ResponseLine& line, const std::string& file) {
  return number_in(line, "answer", file) ==
         (protocol.trials.task == StudyTask::ForcedChoice ? 2.0 : 1.0);
}

double number_in(const ResponseLine& line, const char* key, const std::string& file) {
  const auto found = line.find(key);
  if (found != line.end() && found->is_number()) return found->get<double>();
  throw InputError(fmt::format(
      "{}: the line of the kind \"{}\" of trial {} has no number \"{}\", so the session "
      "cannot be resumed",
      file, line.value("kind", ""), line.value("trial", 0), key));
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
  if (protocol.trials.task == StudyTask::Adjustment)
    return "An adjustment was accepted at " + where + ", so the result may lie beyond it.";
  return fmt::format(
      "{} answers in a row left a staircase at {}, so the threshold may lie beyond it. Check that "
      "the participant has understood the question and does not always answer alike.",
      bound.answers, where);
}

ResponseLine stamped(ResponseLine line, const StudySight& sight) {
  line["utc"] = utc_text(sight.utc);
  line["time_s"] = rounded(sight.time, 4);
  return line;
}

}  // namespace prostm::study

namespace prostm {

std::string utc_text(double seconds) {
  const auto whole = static_cast<std::time_t>(std::floor(seconds));
  const int milliseconds = static_cast<int>(1e3 * (seconds - std::floor(seconds)));
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", fmt::gmtime(whole), milliseconds);
}

}  // namespace prostm
