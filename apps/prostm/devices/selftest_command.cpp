#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "common.hpp"
#include "devices/terminal.hpp"
#include "prostm/acoustics/array/array_units.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/core/stage_timer.hpp"
#include "prostm/device/device_kinds.hpp"
#include "prostm/device/safety/sample_chain.hpp"
#include "prostm/device/test_pattern.hpp"
#include "prostm/figure/figures.hpp"
#include "prostm/io/quantity_json.hpp"

namespace prostm::app {
namespace {

constexpr int kFailed = 1;           // exit status
constexpr double kLook = 0.01;       // [s]
constexpr double kLongestEnd = 1.0;  // longest wait until the last sample is played [s]

/// The answers to a figure.
struct Outcome {
  std::string name;
  bool played = false;
  std::optional<bool> felt;  ///< nothing if it was not asked or not answered
};

void check(const SelftestOptionsGiven& given, std::FILE* out) {
  const auto require = [](const char* option, double value, double least, double most) {
    if (value >= least && value <= most) return;
    throw InputError(fmt::format("{} {} must be from {} to {}", option, value, least, most));
  };
  require("--seconds", given.seconds, 0.2, 60.0);
  require("--height-mm", given.height_mm, 50.0, 500.0);
  require("--level", given.level, 0.05, 1.0);
  if (given.yes || given.silent || Terminal::is_there(out)) return;
  throw InputError(
      "prostm selftest asks before it plays, and there is no terminal to ask on; give --yes to "
      "play without being asked, or --silent to play nothing");
}

/// Limits for a single focal point on the array of the settings.
SampleLimits limits(const PipelineSettings& settings) {
  return {.power = 1.0, .caps = settings.safety, .levels = levels_of(settings)};
}

/// A device that plays test figures, silent until it is told to.
class Tested {
 public:
  Tested(const SelftestOptionsGiven& given, const PipelineSettings& settings)
      : device_(make_device(settings.device, setup_of(settings))),
        figures_(test_figures(settings.transducers, device_->info().emission_rate(),
                              1e-3 * given.height_mm, given.seconds)),
        pattern_(figures_, device_->info().emission_rate(), given.level),
        chain_(make_sample_chain(pattern_, device_->info(), limits(settings))) {
    if (device_->start(*chain_) != DeviceStatus::Running)
      throw std::invalid_argument(device_->problem());
  }
  ~Tested() { device_->stop(); }
  Tested(const Tested&) = delete;
  Tested& operator=(const Tested&) = delete;

  Device& device() { return *device_; }
  const std::vector<TestFigure>& figures() const { return figures_; }
  TestPattern& pattern() { return pattern_; }
  SafetyStats safety() const { return chain_->safety(); }
  bool runs() const { return device_->status() == DeviceStatus::Running; }

  /// Silences the device, and waits until it has played its queue.
  void finish() {
    pattern_.silence();
    const double end = steady_now() + kLongestEnd;
    while (runs() && !pattern_.done() && steady_now() < end) pause(1e-3);
    const std::int64_t last = device_->stats().blocks * device_->info().block_samples;
    while (runs() && device_->samples() < last && steady_now() < end) pause(1e-3);
    device_->stop();
  }

 private:
  static DeviceSetup setup_of(const PipelineSettings& settings) {
    DeviceSetup setup = settings.device_setup();
    setup.foci = 1;
    return setup;
  }

  std::unique_ptr<Device> device_;
  std::vector<TestFigure> figures_;
  TestPattern pattern_;
  std::unique_ptr<SampleChain> chain_;
};

void print_device(std::FILE* out, const Tested& tested, const DeviceInfo& info,
                  const std::string& description, const PipelineSettings& settings) {
  fmt::print(out, "device: {}, {:.0f} Hz, blocks of {:.3g} ms, {}; {}\n", info.name,
             info.sample_rate, 1e3 * info.block_time(),
             info.intensity_per_focus ? "an intensity for each focal point"
                                      : "one intensity for all focal points",
             device_named(settings.device).kind->tried);
  if (!description.empty()) fmt::print(out, "it reports: {}\n", description);
  const std::vector<ArrayUnit> units = units_of(settings.transducers);
  fmt::print(out, "array: {}, {} transducers in {} unit{}; {} figures to play\n",
             settings.transducers.name, settings.transducers.position.size(), units.size(),
             units.size() == 1 ? "" : "s", tested.figures().size());
  for (std::size_t i = 0; i < units.size(); ++i) {
    const Vec3 middle = 1e3 * units[i].centre,
               first = 1e3 * settings.transducers.position[units[i].first];
    fmt::print(out,
               "  unit {}: its middle at ({:.1f}, {:.1f}, {:.1f}) mm in D, its transducer 0 at "
               "({:.1f}, {:.1f}, {:.1f}) mm, facing ({:.2f}, {:.2f}, {:.2f})\n",
               i + 1, middle.x(), middle.y(), middle.z(), first.x(), first.y(), first.z(),
               units[i].normal.x(), units[i].normal.y(), units[i].normal.z());
  }
  std::fflush(out);
}

void draw(const SelftestOptionsGiven& given, const PipelineSettings& settings) {
  const std::string& path = given.common.figure;
  if (path.empty()) return;
  const TransducerArray& array = settings.transducers;
  ArrayFigure figure;
  figure.title = fmt::format("{}, played by {}", array.name, settings.device);
  figure.position = array.position;
  figure.radius = array.radius;
  const std::vector<ArrayUnit> units = units_of(array);
  for (std::size_t i = 0; i < units.size(); ++i)
    figure.unit.insert(figure.unit.end(), units[i].count, static_cast<int>(i));
  draw_array(figure, path);
}

/// Plays the figures, each after a question unless questions are switched off.
class Session {
 public:
  Session(const SelftestOptionsGiven& given, Tested& tested, std::FILE* out,
          const Interrupt& interrupt)
      : given_(given),
        tested_(tested),
        out_(out),
        interrupt_(interrupt),
        terminal_(out, interrupt) {}

  std::vector<Outcome> play() {
    if (given_.silent) return {};
    fmt::print(out_,
               "Hold a hand {:.0f} mm above the array, its palm towards it. Each figure begins "
               "gently. {}Ctrl-C ends the test.\n",
               given_.height_mm, given_.yes ? "" : "Enter silences it. ");
    std::vector<Outcome> outcomes;
    for (std::size_t i = 0; i < tested_.figures().size() && goes_on(); ++i) {
      Outcome outcome{tested_.figures()[i].name, false, {}};
      const std::string title =
          fmt::format("{} of {}: {}", i + 1, tested_.figures().size(), outcome.name);
      if (wants(title)) {
        outcome.played = play_figure(i);
        if (outcome.played && !given_.yes && goes_on()) outcome.felt = felt();
      }
      outcomes.push_back(std::move(outcome));
    }
    return outcomes;
  }

 private:
  bool goes_on() const { return tested_.runs() && !interrupt_.requested() && !quits_; }

  bool wants(const std::string& title) {
    if (given_.yes) {
      fmt::print(out_, "{}\n", title);
      std::fflush(out_);
      return true;
    }
    const auto answer = terminal_.ask(title + ". Play it? [Y/n/q]");
    quits_ = !answer || answer->starts_with("q");
    return answer && (answer->empty() || answer->starts_with("y"));
  }

  /// Returns whether it was played, to the end or until it was silenced.
  bool play_figure(std::size_t i) {
    tested_.pattern().play(i);
    while (goes_on() && !tested_.pattern().done()) {
      if (given_.yes) {
        pause(kLook);
      } else if (terminal_.enter_within(kLook)) {
        tested_.pattern().silence();
      }
    }
    if (interrupt_.requested()) tested_.pattern().silence();
    return tested_.runs();
  }

  std::optional<bool> felt() {
    for (int attempt = 0; attempt < 3; ++attempt) {
      const auto answer = terminal_.ask("Can you feel it? [y/n]");
      if (!answer) return {};
      if (answer->starts_with("y")) return true;
      if (answer->starts_with("n")) return false;
    }
    return {};
  }

  const SelftestOptionsGiven& given_;
  Tested& tested_;
  std::FILE* out_;
  const Interrupt& interrupt_;
  Terminal terminal_;
  bool quits_ = false;
};

/// The outcome in a sentence, and whether all is well.
struct Judgement {
  bool passed = true;
  std::string sentence;
};

Judgement judge(const Tested& tested, Device& device, const std::vector<Outcome>& outcomes,
                bool ran) {
  if (!ran) return {false, device.problem()};
  const DeviceStats stats = device.stats();
  const auto played = std::ranges::count_if(outcomes, [](const Outcome& o) { return o.played; });
  const auto with = [&](bool answer) {
    return std::ranges::count_if(outcomes, [&](const Outcome& o) { return o.felt == answer; });
  };
  std::string sentence =
      played == 0
          ? std::string("Nothing was played.")
          : fmt::format("{} of {} figures were played: {} felt, {} not felt, {} not answered.",
                        played, tested.figures().size(), with(true), with(false),
                        played - with(true) - with(false));
  if (stats.missed_blocks > 0) {
    sentence += fmt::format(" {} of {} blocks were missed: the output had gaps.",
                            stats.missed_blocks, stats.blocks);
  }
  if (device.is_hot()) sentence += " The hardware reports that it is too hot: let it cool down.";
  return {with(false) == 0 && !device.is_hot(), sentence};
}

nlohmann::ordered_json vector_json(const Vec3& v, double unit) {
  return {unit * v.x(), unit * v.y(), unit * v.z()};
}

nlohmann::ordered_json units_json(const TransducerArray& array) {
  nlohmann::ordered_json units = nlohmann::ordered_json::array();
  for (const ArrayUnit& unit : units_of(array)) {
    units.push_back({{"first_transducer", unit.first},
                     {"transducers", unit.count},
                     {"centre_mm", vector_json(unit.centre, 1e3)},
                     {"transducer_0_mm", vector_json(array.position[unit.first], 1e3)},
                     {"normal", vector_json(unit.normal, 1.0)}});
  }
  return units;
}

nlohmann::ordered_json outcomes_json(const std::vector<Outcome>& outcomes) {
  nlohmann::ordered_json figures = nlohmann::ordered_json::array();
  for (const Outcome& outcome : outcomes) {
    nlohmann::ordered_json felt = nullptr;
    if (outcome.felt) felt = *outcome.felt;
    figures.push_back({{"name", outcome.name}, {"played", outcome.played}, {"felt", felt}});
  }
  return figures;
}

}  // namespace

int selftest_command(const SelftestOptionsGiven& given) {
  std::FILE* out = prose(given.common.json);
  check(given, out);
  const PipelineSettings settings = make_settings(given.common, std::nullopt, true);
  const std::string doubt = doubt_of_array(settings);
  if (!doubt.empty()) fmt::print(out, "{}\n", doubt);
  const Interrupt interrupt;
  Tested tested(given, settings);
  Device& device = tested.device();
  const DeviceInfo info = device.info();
  const std::string description = device.description();
  print_device(out, tested, info, description, settings);
  draw(given, settings);
  const std::vector<Outcome> outcomes = Session(given, tested, out, interrupt).play();
  const bool ran = tested.runs();
  if (ran) tested.finish();
  const Judgement judgement = judge(tested, device, outcomes, ran);
  fmt::print(out, "{}\n", judgement.sentence);
  nlohmann::ordered_json json = {{"format", "prostm-selftest/1"},
                                 {"passed", judgement.passed},
                                 {"stopped", interrupt.requested()},
                                 {"sentence", judgement.sentence},
                                 {"device", device_json(info)},
                                 {"description", description},
                                 {"array", settings.array},
                                 {"units", units_json(settings.transducers)},
                                 {"figures", outcomes_json(outcomes)},
                                 {"limited_samples", erred_samples(tested.safety())}};
  json.update(quantities_to_json(device.stats()));
  json.update(quantities_to_json(tested.safety()));
  write_json(given.common.json, json);
  say_written(out, given.common.json);
  say_written(out, given.common.figure);
  if (interrupt.requested()) return interrupt.status();
  return judgement.passed ? 0 : kFailed;
}

}  // namespace prostm::app
