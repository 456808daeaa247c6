#include "prostm/viewer/page_message.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "prostm/core/units.hpp"

namespace prostm {
namespace {

using Json = nlohmann::json;

/// An error in a message; caught in read_page_message().
struct Wrong : std::runtime_error {
  using std::runtime_error::runtime_error;
};

const Json& member(const Json& json, const char* name) {
  const auto found = json.find(name);
  if (found == json.end()) throw Wrong(fmt::format("the message lacks \"{}\"", name));
  return *found;
}

std::string text(const Json& json, const char* name) {
  const Json& value = member(json, name);
  if (!value.is_string()) throw Wrong(fmt::format("\"{}\" must be a string", name));
  return value.get<std::string>();
}

bool truth(const Json& json, const char* name) {
  const Json& value = member(json, name);
  if (!value.is_boolean()) throw Wrong(fmt::format("\"{}\" must be true or false", name));
  return value.get<bool>();
}

double checked(const Json& value, const char* name, double low, double high) {
  const double number = value.is_number() ? value.get<double>() : std::nan("");
  if (!(number >= low && number <= high))
    throw Wrong(fmt::format("\"{}\" must be a number between {} and {}", name, low, high));
  return number;
}

double number(const Json& json, const char* name, double low, double high) {
  return checked(member(json, name), name, low, high);
}

/// The enum value of a member, whose text is one of `names`.
template <class Enum>
Enum choice(const Json& json, const char* name, std::span<const std::string_view> names) {
  const std::string value = text(json, name);
  std::string all;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (value == names[i]) return static_cast<Enum>(i);
    all += (i == 0 ? "" : i + 1 == names.size() ? " or " : ", ") + std::string(names[i]);
  }
  throw Wrong(fmt::format("\"{}\" must be {}", name, all));
}
template <class Enum, std::size_t N>
Enum choice(const Json& json, const char* name, const std::string_view (&names)[N]) {
  return choice<Enum>(json, name, std::span(names));
}

SetMessage read_set(const Json& json) {
  SetMessage m{text(json, "id"), 0.0};
  const Json& value = member(json, "value");
  if (value.is_boolean()) {
    m.value = value.get<bool>();
  } else if (value.is_string()) {
    m.value = value.get<std::string>();
  } else {
    constexpr double kMost = 1e9;
    m.value = checked(value, "value", -kMost, kMost);
  }
  return m;
}

TransportMessage read_transport(const Json& json) {
  constexpr double kDay = 86400.0;  // [s]
  TransportMessage m;
  m.what = choice<TransportMessage::Do>(json, "do", {"play", "pause", "step", "seek"});
  if (m.what == TransportMessage::Do::Seek) m.time = number(json, "time_s", 0.0, kDay);
  return m;
}

HandMessage read_hand(const Json& json) {
  HandMessage m;
  if (json.contains("release")) m.release = truth(json, "release");
  if (m.release) {
    if (json.contains("hidden")) m.hidden = truth(json, "hidden");
    return m;
  }
  if (json.contains("take")) m.take = truth(json, "take");
  const Json& palm = member(json, "palm_mm");
  if (!palm.is_array() || palm.size() != 3)
    throw Wrong("\"palm_mm\" must be a list of three numbers");
  constexpr double kFarthest = 500.0, kTurn = 360.0;  // [mm], [degrees]
  for (std::size_t i = 0; i < 3; ++i)
    m.palm[i] = 1e-3 * checked(palm[i], "palm_mm", -kFarthest, kFarthest);
  m.yaw = number(json, "yaw_deg", -kTurn, kTurn) * kPi / 180.0;
  m.pitch = number(json, "pitch_deg", -kTurn, kTurn) * kPi / 180.0;
  m.roll = number(json, "roll_deg", -kTurn, kTurn) * kPi / 180.0;
  m.closure = number(json, "closure", 0.0, 1.0);
  enum class Which { Left, Right };
  m.left = choice<Which>(json, "side", {"left", "right"}) == Which::Left;
  return m;
}

CalibrationMessage read_calibration(const Json& json) {
  constexpr int kMostMarks = 100;
  CalibrationMessage m;
  m.what = choice<CalibrationMessage::Do>(json, "do", {"begin", "take", "solve", "save", "cancel"});
  if (const auto mark = json.find("mark"); mark != json.end()) {
    const double index = checked(*mark, "mark", 0.0, kMostMarks);
    if (index != std::floor(index)) throw Wrong("\"mark\" must be a whole number");
    m.mark = static_cast<int>(index);
  }
  if (m.what == CalibrationMessage::Do::Take && !m.mark) throw Wrong("the message lacks \"mark\"");
  return m;
}

/// Reads participants' answers about themselves: a few short texts.
nlohmann::ordered_json read_about(const Json& json) {
  constexpr std::size_t kMost = 20, kLongest = 200;
  const Json& about = member(json, "about");
  if (!about.is_object() || about.size() > kMost)
    throw Wrong(fmt::format("\"about\" must be an object of at most {} texts", kMost));
  nlohmann::ordered_json texts = nlohmann::ordered_json::object();
  for (const auto& [name, value] : about.items()) {
    if (!value.is_string() || value.get_ref<const std::string&>().size() > kLongest)
      throw Wrong(fmt::format("texts in \"about\" must have at most {} bytes", kLongest));
    texts[name] = value.get<std::string>();
  }
  return texts;
}

StudyAct read_study(const Json& json) {
  constexpr double kMostScenes = 1000, kMostIntervals = 9;
  enum class Way { Less, More };
  StudyAct act;
  act.what = choice<StudyAct::Do>(json, "do", std::span(kNames<StudyAct::Do>));
  if (act.what == StudyAct::Do::Answer && json.contains("interval")) {
    const double interval = number(json, "interval", 1.0, kMostIntervals);
    if (interval != std::floor(interval)) throw Wrong("\"interval\" must be a whole number");
    act.interval = static_cast<int>(interval);
  } else if (act.what == StudyAct::Do::Answer) {
    act.yes = truth(json, "yes");
  }
  if (act.what == StudyAct::Do::Tune) {
    act.steps = choice<Way>(json, "to", {"less", "more"}) == Way::More ? 1 : -1;
    act.coarse = truth(json, "coarse");
  }
  if (act.what == StudyAct::Do::Explore)
    act.scene = static_cast<int>(number(json, "scene", 0.0, kMostScenes));
  if (act.what == StudyAct::Do::About) act.about = read_about(json);
  return act;
}

PageReport read_report(const Json& json) {
  PageReport report;
  report.visible = truth(json, "visible");
  report.noise = choice<PageNoise>(json, "noise", {"off", "silent", "playing"});
  report.picture = truth(json, "picture");
  return report;
}

PageMessage read(const Json& json) {
  enum class Type { Set, Transport, Hand, Calibration, Mute, Rate, Study, Page };
  switch (choice<Type>(
      json, "type", {"set", "transport", "hand", "calibration", "mute", "rate", "study", "page"})) {
    case Type::Set:
      return read_set(json);
    case Type::Transport:
      return read_transport(json);
    case Type::Hand:
      return read_hand(json);
    case Type::Calibration:
      return read_calibration(json);
    case Type::Mute:
      return MuteMessage{truth(json, "on")};
    case Type::Study:
      return read_study(json);
    case Type::Page:
      return read_report(json);
    case Type::Rate:
      break;
  }
  return RateMessage{number(json, "hz", kMinPageRate, kMaxPageRate)};
}

}  // namespace

bool read_page_message(std::string_view message, PageMessage& out, std::string& problem) {
  if (message.size() > kMaxPageMessage) {
    problem = fmt::format("a message has at most {} bytes", kMaxPageMessage);
    return false;
  }
  const Json json = Json::parse(message, nullptr, false);
  if (!json.is_object()) {
    problem = "a message must be a JSON object (docs/reference/wire.md)";
    return false;
  }
  try {
    out = read(json);
    return true;
  } catch (const Wrong& wrong) {
    problem = wrong.what();
    return false;
  }
}

}  // namespace prostm
