#include "study/study_protocol.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "common.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/device/simulated/simulated_array.hpp"
#include "prostm/pipeline/playable.hpp"

namespace prostm::app {
namespace {

void settle(StudyMethod& method, const std::string& path) {
  set_live_budget(method.settings);
  try {
    require_playable(method.settings, method.settings.device_info());
  } catch (const std::invalid_argument& error) {
    throw InputError(fmt::format("{}: method {}: {}", path, method.name, error.what()));
  }
}

}  // namespace

PipelineSettings study_settings(const CommonOptions& common) {
  PipelineSettings settings = make_settings(common, std::nullopt, true);
  settings.devices.of<SimulatedArraySettings>().realtime = true;
  settings.jets.place = JetPlace::Hand;  // a stimulus is centred under the palm
  return settings;
}

Protocol live_protocol(const std::string& path, const PipelineSettings& base) {
  Protocol protocol = read_protocol(path, base);
  for (const std::string& sentence : protocol.warnings) warn(sentence);
  for (StudyMethod& method : protocol.methods) settle(method, path);
  if (protocol.standard) settle(*protocol.standard, path);
  return protocol;
}

}  // namespace prostm::app
