#include "prostm/emit/emitter.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "prostm/emit/detail/exchange.hpp"
#include "prostm/emit/detail/focus_emitter.hpp"
#include "prostm/emit/detail/path_emitter.hpp"

namespace prostm {
namespace {

bool usable(const Vec3& p_D) {
  constexpr double kMaxCoordinate = 10.0;  // anything felt is nearer to the array [m]
  return std::all_of(p_D.begin(), p_D.end(),
                     [](double x) { return std::isfinite(x) && std::abs(x) <= kMaxCoordinate; });
}

bool usable(double pressure) {
  return std::isfinite(pressure) && std::abs(pressure) <= 1e300;
}

bool usable(const LiftedPath& path) {
  return path.pressure.size() == path.p_D.size() && std::isfinite(path.speed) &&
         std::all_of(path.p_D.begin(), path.p_D.end(), [](const Vec3& p) { return usable(p); }) &&
         std::all_of(path.pressure.begin(), path.pressure.end(),
                     [](double p) { return usable(p); });
}

bool usable(const LiftedPlan& plan, Method method) {
  const bool is_of_method = method == Method::Am ? plan.paths.empty() : plan.foci.empty();
  return is_of_method && is_loop(plan.loop) &&
         std::all_of(plan.paths.begin(), plan.paths.end(),
                     [](const LiftedPath& path) { return usable(path); }) &&
         std::all_of(plan.foci.begin(), plan.foci.end(), [](const LiftedFocus& focus) {
           return usable(focus.p_D) && usable(focus.pressure) && is_phase(focus.phase);
         });
}

const EmitSettings& checked(const EmitSettings& settings, double sample_rate) {
  validate(settings, sample_rate);
  return settings;
}

}  // namespace

Emitter::Emitter(const EmitSettings& settings, double sample_rate, Method method)
    : exchange_(std::make_unique<Exchange>(checked(settings, sample_rate), method)) {}

Emitter::~Emitter() = default;

LiftedPlan& Emitter::draft() {
  return exchange_->inbox.draft().plan;
}

void Emitter::submit() noexcept {
  Message& message = exchange_->inbox.draft();
  message.refused = message.lost = !usable(message.plan, exchange_->method);
  if (!message.refused) {
    auto& paths = message.plan.paths;
    const auto empty = [](const LiftedPath& path) { return path.p_D.empty(); };
    paths.erase(std::remove_if(paths.begin(), paths.end(), empty), paths.end());
    for (LiftedPath& path : paths) measure(path);
  }
  exchange_->inbox.publish();
}

void Emitter::lose() noexcept {
  Message& message = exchange_->inbox.draft();
  message.lost = true;
  message.refused = false;
  exchange_->inbox.publish();
}

void Emitter::obey(std::shared_ptr<const Mute> mute) noexcept {
  exchange_->mute = std::move(mute);
}

int Emitter::foci() const {
  return exchange_->settings.foci;
}

bool Emitter::next_take_over(TakeOver& out) {
  return exchange_->log.next(out);
}

EmitStats Emitter::stats() const {
  exchange_->published.refresh();
  return exchange_->published.value();
}

std::unique_ptr<Emitter> make_emitter(Method method, const EmitSettings& settings,
                                      double sample_rate, double max_speed) {
  // foci move while they are silent
  if (method == Method::Am) return std::make_unique<FocusEmitter>(settings, sample_rate);
  return std::make_unique<PathEmitter>(settings, sample_rate, max_speed);
}

}  // namespace prostm
