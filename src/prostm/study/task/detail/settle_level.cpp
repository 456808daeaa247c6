#include "prostm/study/task/detail/settle_level.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "prostm/core/input_error.hpp"
#include "prostm/io/settings_file.hpp"
#include "prostm/pipeline/playable.hpp"
#include "prostm/pipeline/world_kinds.hpp"
#include "prostm/study/task/task.hpp"
#include "prostm/study/task/track.hpp"

namespace prostm::study {
namespace {

class LevelChecks {
 public:
  LevelChecks(const std::string& file, std::string_view text, const std::vector<std::string>& given,
              Protocol& protocol)
      : file_(file),
        text_(text),
        given_(given),
        protocol_(protocol),
        task_(*protocol.trials.task),
        level_(protocol.level) {}

  void check() {
    const std::string task = task_.name();
    if (!task_.traits().has_levels) {
      if (std::any_of(given_.begin(), given_.end(),
                      [](const std::string& name) { return name.starts_with("level."); }))
        fail(fmt::format(
            "task {} does not use [level]; set another task, e.g. task = \"judgement\"", task));
      return check_task();
    }
    for (const char* key : {"setting", "low", "high"})
      if (!gives(key)) fail(fmt::format("task {} needs {} in [level]", task, key));
    if (!(level_.low < level_.high)) {
      fail(
          fmt::format("level.low = {:g} must be below level.high = {:g}", level_.low, level_.high));
    }
    if (level_.scale == LevelScale::Log && !(level_.low > 0.0))
      fail(fmt::format("level.low = {:g} must be above 0 because scale is log", level_.low));
    settle_start();
    take_standard();
    if (protocol_.trials.feedback && !has_right_answers())
      fail(
          fmt::format("trials.feedback is not possible: task {} has no right or wrong answers with "
                      "these levels",
                      task));
    for (const StudyMethod& method : protocol_.methods) check_method(method);
    try {
      static_cast<void>(Track(protocol_, 0));
    } catch (const std::invalid_argument& error) {
      fail(fmt::format("[level]: {}", error.what()));
    }
  }

 private:
  [[noreturn]] void fail(const std::string& sentence) const {
    throw InputError(fmt::format("{}: {}", file_, sentence));
  }
  bool gives(const std::string& key) const {
    return std::find(given_.begin(), given_.end(), "level." + key) != given_.end();
  }
  bool has_right_answers() const {
    return task_.answer_kind(protocol_.standard.has_value()) == AnswerKind::Right;
  }

  void check_task() const {
    try {
      task_.check(protocol_);
    } catch (const std::invalid_argument& error) {
      fail(error.what());
    }
  }

  void settle_start() {
    const bool steps = task_.is_tuned() || level_.procedure == Staircase::UpDown;
    if (steps && !(level_.step > 0.0)) {
      fail(fmt::format("{} needs a step above 0 in [level]",
                       task_.is_tuned() ? task_.name() : "procedure up-down"));
    }
    if (!gives("start")) {
      const double middle = 0.5 * (level_.to_scale(level_.low) + level_.to_scale(level_.high));
      level_.start = level_.procedure == Staircase::Bayes ? level_.from_scale(middle) : level_.high;
    }
    if (level_.start < level_.low || level_.start > level_.high) {
      fail(fmt::format("level.start = {:g} must be between low and high, {:g} and {:g}",
                       level_.start, level_.low, level_.high));
    }
  }

  void take_standard() {
    if (!task_.traits().compares) {
      if (gives("against") || gives("reference")) {
        fail(fmt::format("task {} has no standard: leave out level.against and level.reference",
                         task_.name()));
      }
      return;
    }
    if (level_.against.empty() == !gives("reference")) {
      fail(fmt::format(
          "task {} needs a standard: give either level.reference, a level, or level.against, a "
          "method",
          task_.name()));
    }
    if (level_.against.empty()) return;
    auto& methods = protocol_.methods;
    const auto found = std::find_if(methods.begin(), methods.end(),
                                    [&](const auto& m) { return m.name == level_.against; });
    if (found == methods.end())
      fail(fmt::format("level.against = \"{:.60}\" names no [method.NAME] of the protocol",
                       level_.against));
    protocol_.standard = *found;
    methods.erase(found);
    if (methods.empty())
      fail("level.against is the only method: add another one, whose level is varied");
  }

  /// Checks that a level is played exactly as written, in every scene.
  void check_level(const StudyMethod& method, const char* key, double level) const {
    try {
      PipelineSettings settings = method.settings;
      const double set = set_level(settings, level_.setting, level);
      if (set != level) {
        throw std::invalid_argument(fmt::format(
            "{} must be a whole number, and would be rounded to {:g}", level_.setting, set));
      }
      require_playable(settings, settings.device_info());
      if (level_.setting == "plan.gain" || level_.setting == "emit.full_scale_pressure")
        check_scale(settings);
    } catch (const std::invalid_argument& error) {
      const int line = line_in_toml(text_, file_, {"level", key});
      throw InputError(fmt::format("{}{}: level.{} = {:g} cannot be played with method {}: {}",
                                   file_, line > 0 ? fmt::format(", line {}", line) : "", key,
                                   level, method.name, error.what()));
    }
  }

  /// Checks that the largest pressure of each scene is neither clipped at full scale nor silent.
  void check_scale(const PipelineSettings& settings) const {
    const double full = settings.emit.full_scale_pressure, gain = settings.plan.gain;
    if (full == 0.0 || settings.method == Method::Am) return;
    const WorldKind& world = world_named(settings.world);
    for (const StudyScene& scene : protocol_.scenes) {
      const double pressure = gain * scene_named(scene.name, world).full_scale_pressure;
      const double share = pressure / full;
      if (share > 1.0 + kRounding) {
        throw std::invalid_argument(
            fmt::format("scene {} renders up to {:.3g} Pa with gain {:g}, which is clipped at "
                        "full_scale_pressure = {:g} Pa",
                        scene.name, pressure, gain, full));
      }
      if (share < settings.emit.silent_below) {
        throw std::invalid_argument(
            fmt::format("scene {} renders up to {:.3g} Pa with gain {:g}, {:.2g} of "
                        "full_scale_pressure; shares "
                        "below silent_below = {:g} are silent",
                        scene.name, pressure, gain, share, settings.emit.silent_below));
      }
    }
  }

  void check_method(const StudyMethod& method) {
    check_level(method, "low", level_.low);
    check_level(method, "high", level_.high);
    if (gives("start")) check_level(method, "start", level_.start);
    if (gives("reference")) check_level(method, "reference", level_.reference);
    check_task();
    if (level_.setting == "plan.gain" && method.settings.emit.full_scale_pressure == 0.0) {
      fail(fmt::format(
          "level.setting = \"plan.gain\" would change nothing with method {}, whose full scale "
          "follows the gain; give all methods the same [method.NAME.emit] full_scale_pressure",
          method.name));
    }
    const bool is_am = method.settings.method == Method::Am;
    if (level_.setting.starts_with(is_am ? "plan." : "am.")) {
      fail(fmt::format("level.setting = \"{}\" changes nothing with method {}, which is {}",
                       level_.setting, method.name, name_of(method.settings.method)));
    }
    const int foci = method.settings.emit.foci;
    if ((level_.setting == "plan.paths" || level_.setting == "am.foci") && level_.high > foci) {
      fail(fmt::format("level.high = {:g} must not be above [method.{}.emit] foci = {}",
                       level_.high, method.name, foci));
    }
  }

  static constexpr double kRounding = 1e-6;

  const std::string& file_;
  const std::string_view text_;
  const std::vector<std::string>& given_;
  Protocol& protocol_;
  const Task& task_;
  LevelSettings& level_;
};

}  // namespace

void settle_level(const std::vector<std::string>& given, const std::string& file,
                  std::string_view text, Protocol& protocol) {
  LevelChecks(file, text, given, protocol).check();
}

void require_playable_method(const StudyMethod& method, const std::string& file,
                             std::string_view text) {
  try {
    require_playable(method.settings, method.settings.device_info());
  } catch (const std::invalid_argument& error) {
    const int line = line_in_toml(text, file, {"method", method.name});
    throw InputError(fmt::format("{}{}: method {}: {}", file,
                                 line > 0 ? fmt::format(", line {}", line) : "", method.name,
                                 error.what()));
  }
}

}  // namespace prostm::study
