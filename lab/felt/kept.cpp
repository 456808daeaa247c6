#include "felt/kept.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <filesystem>
#include <mutex>
#include <nlohmann/json.hpp>

#include "prostm/core/file/file.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/core/text/json.hpp"

namespace prostm::bench {
namespace {

using Json = nlohmann::ordered_json;

/// FNV-1a of 64 bits.
class Hash {
 public:
  void add(std::uint64_t word) {
    for (int byte = 0; byte < 8; ++byte) {
      value_ ^= (word >> (8 * byte)) & 0xFF;
      value_ *= 0x100000001b3;
    }
  }
  void add(double number) { add(std::bit_cast<std::uint64_t>(number)); }
  void add(const Vec2& x) {
    add(x.x());
    add(x.y());
  }
  template <class Values>
  void add_all(const Values& values) {
    add(static_cast<std::uint64_t>(values.size()));
    for (const auto& value : values) add(value);
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325;
};

void add_plan(const Plan& plan, Hash& hash) {
  hash.add(plan.loop);
  for (const FocalPath& path : plan.paths) {
    hash.add_all(path.points);
    hash.add_all(path.pressure);
    hash.add(path.speed);
  }
  for (const FocalPoint& focus : plan.foci) {
    hash.add(focus.position);
    hash.add(focus.pressure);
    hash.add(focus.phase);
  }
}

void add_target(const TargetField& target, Hash& hash) {
  hash.add(static_cast<std::uint64_t>(target.rows));
  hash.add(target.cell);
  hash.add(target.origin);
  hash.add_all(target.pressure);
  hash.add_all(target.height);
  for (const std::uint8_t skin : target.skin) hash.add(static_cast<std::uint64_t>(skin));
  for (const double number : target.X_DP.matrix().reshaped()) hash.add(number);
}

constexpr std::array kMetrics = {&Metrics::rmse,    &Metrics::correlation, &Metrics::skill_0,
                                 &Metrics::skill_8, &Metrics::overlap,     &Metrics::spill};

Json metrics_to_json(const Metrics& metrics) {
  Json out;
  for (const auto member : kMetrics) out.push_back(metrics.*member);
  return out;
}

Metrics metrics_from_json(const nlohmann::json& list) {
  Metrics out;
  for (std::size_t m = 0; m < kMetrics.size(); ++m) out.*kMetrics[m] = list.at(m).get<double>();
  return out;
}

Json to_json(const Judged& judged) {
  return {{"felt", metrics_to_json(judged.felt)}, {"envelope", metrics_to_json(judged.envelope)},
          {"intensity", judged.intensity},        {"strongest", judged.strongest},
          {"readouts", judged.readout},           {"skins", judged.skin},
          {"disturbed", judged.disturbed},        {"ghosts", judged.ghosts},
          {"crossings", judged.crossings},        {"long_paths", judged.long_paths},
          {"model_skill", judged.model_skill},    {"model_strength", judged.model_strength}};
}

Judged judged_from_json(const nlohmann::json& one) {
  Judged out;
  out.felt = metrics_from_json(one.at("felt"));
  out.envelope = metrics_from_json(one.at("envelope"));
  one.at("intensity").get_to(out.intensity);
  one.at("strongest").get_to(out.strongest);
  one.at("readouts").get_to(out.readout);
  one.at("skins").get_to(out.skin);
  one.at("disturbed").get_to(out.disturbed);
  one.at("ghosts").get_to(out.ghosts);
  one.at("crossings").get_to(out.crossings);
  one.at("long_paths").get_to(out.long_paths);
  one.at("model_skill").get_to(out.model_skill);
  one.at("model_strength").get_to(out.model_strength);
  return out;
}

}  // namespace

Kept::Kept(std::string path) : path_(std::move(path)) {
  if (path_.empty()) return;
  check_writable(path_);
  if (!std::filesystem::exists(path_)) return;
  const nlohmann::json document = parse_json(read_file(path_), path_);
  try {
    for (const auto& [key, one] : document.at("judged").items())
      all_.emplace(key, judged_from_json(one));
  } catch (const nlohmann::json::exception&) {
    throw InputError(path_ + ": is not a file of kept judgements; remove it or name another");
  }
}

std::optional<Judged> Kept::find(const std::string& key) const {
  const std::shared_lock lock(mutex_);
  const auto found = all_.find(key);
  return found == all_.end() ? std::nullopt : std::optional(found->second);
}

void Kept::add(const std::string& key, const Judged& judged) {
  Judged one = judged;
  if (!path_.empty()) one.percept.clear();
  const std::unique_lock lock(mutex_);
  all_.insert_or_assign(key, std::move(one));
}

void Kept::write() const {
  if (path_.empty()) return;
  const std::unique_lock lock(mutex_);
  Json judged = Json::object();
  for (const auto& [key, one] : all_) judged[key] = to_json(one);
  write_file(path_, to_text({{"judged", judged}}));
}

std::string key_of(const Plan& plan, const TargetField& target,
                   const std::vector<std::string>& names, std::uint64_t seed) {
  Hash hash;
  add_plan(plan, hash);
  add_target(target, hash);
  hash.add(seed);
  for (const std::string& name : names) {
    for (const char letter : name) hash.add(static_cast<std::uint64_t>(letter));
    hash.add(std::uint64_t{0});
  }
  return fmt::format("{:016x}", hash.value());
}

}  // namespace prostm::bench
