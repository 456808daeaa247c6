#include "prostm/study/detail/settle_level.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "prostm/core/input_error.hpp"
#include "prostm/study/track.hpp"

namespace prostm::study {
namespace {

class LevelChecks {
 public:
  LevelChecks(const std::string& file, const std::vector<std::string>& given, Protocol& protocol)
      : file_(file), given_(given), protocol_(protocol), level_(protocol.level) {}

  void check() {
    const std::string_view task = name_of(protocol_.trials.task);
    if (protocol_.trials.task == StudyTask::Identification) {
      if (std::any_of(given_.begin(), given_.end(),
                      [](const std::string& name) { return name.starts_with("level."); }))
        fail("[level] is for another task than identification; give e.g. task = \"judgement\"");
      return;
    }
    for (const char* key : {"setting", "low", "high"})
      if (!gives(key)) fail(fmt::format("task {} needs {} in [level]", task, key));
    if (!(level_.low < level_.high)) {
      fail(
          fmt::format("level.low = {:g} must be below level.high = {:g}", level_.low, level_.high));
    }
    if (level_.scale == LevelScale::Log && !(level_.low > 0.0))
      fail(fmt::format("level.low = {:g} must be above 0, since scale is log", level_.low));
    settle_start();
    take_standard();
    if (protocol_.trials.feedback && !has_right_answers(protocol_))
      fail(
          fmt::format("trials.feedback tells whether an answer was right, and task {} has no right "
                      "answers here",
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
  bool compares() const { return protocol_.trials.task != StudyTask::Judgement; }

  void settle_start() {
    const bool adjusts = protocol_.trials.task == StudyTask::Adjustment;
    const bool steps = adjusts || level_.procedure == Staircase::UpDown;
    if (steps && !(level_.step > 0.0)) {
      fail(fmt::format("{} needs step in [level], above 0",
                       adjusts ? "adjustment" : "procedure up-down"));
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
    if (!compares()) {
      if (gives("against") || gives("reference"))
        fail("a judgement compares with nothing: leave level.against and level.reference out");
      return;
    }
    if (level_.against.empty() == !gives("reference")) {
      fail(fmt::format(
          "task {} compares with a standard: give level.reference, a level, or level.against, a "
          "method, and not both",
          name_of(protocol_.trials.task)));
    }
    if (level_.against.empty()) return;
    auto& methods = protocol_.methods;
    const auto found = std::find_if(methods.begin(), methods.end(),
                                    [&](const auto& m) { return m.name == level_.against; });
    if (found == methods.end())
      fail(fmt::format("level.against = \"{:.60}\", and there is no such [method.NAME]",
                       level_.against));
    protocol_.standard = *found;
    methods.erase(found);
    if (methods.empty())
      fail("level.against is the only method: give another one, whose level is varied");
  }

  void check_method(const StudyMethod& method) {
    std::vector<double> levels = {level_.low, level_.high};
    if (gives("reference")) levels.push_back(level_.reference);
    try {
      for (const double level : levels) {
        PipelineSettings settings = method.settings;
        set_level(settings, level_.setting, level);
      }
    } catch (const std::invalid_argument& error) {
      fail(fmt::format("[level], with method {}: {}", method.name, error.what()));
    }
    if (protocol_.trials.task == StudyTask::ForcedChoice && gives("reference") &&
        level_.reference > level_.low) {
      fail(
          fmt::format("level.reference = {:g} must not be above low, {:g}: the right answer is "
                      "the interval of the higher level",
                      level_.reference, level_.low));
    }
    if (level_.setting == "plan.gain" && method.settings.emit.full_scale_pressure == 0.0) {
      fail(fmt::format(
          "level.setting = \"plan.gain\" would change nothing with method {}, whose full scale "
          "goes with the gain; give all methods the same [method.NAME.emit] full_scale_pressure",
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

  const std::string& file_;
  const std::vector<std::string>& given_;
  Protocol& protocol_;
  LevelSettings& level_;
};

}  // namespace

void settle_level(const std::vector<std::string>& given, const std::string& file,
                  Protocol& protocol) {
  LevelChecks(file, given, protocol).check();
}

}  // namespace prostm::study
