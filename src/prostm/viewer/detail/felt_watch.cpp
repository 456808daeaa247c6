#include "prostm/viewer/detail/felt_watch.hpp"

#include <unistd.h>

#include <stdexcept>

namespace prostm::viewer {
namespace {

// one plan takes about 0.25 s, so this uses 5 % of a core
constexpr std::chrono::seconds kPause{5};

PlanPercept percept_of(const PlanSnapshot& plan, int patch, WorkerPool& pool,
                       const std::stop_token& stop) {
  EmitSettings emit = plan.settings->emit;
  emit.full_scale_pressure = plan.full_scale_pressure;
  emit.power_limit = power_limit(*plan.settings);
  try {
    return plan_percept(plan.plan, plan.target, patch, emit, plan.emission_rate,
                        plan.settings->transducers, pool, [&] { return !stop.stop_requested(); });
  } catch (const std::invalid_argument&) {
    return {};  // the array reaches none of its focal points
  }
}

}  // namespace

FeltWatch::FeltWatch() : thread_([this](const std::stop_token& stop) { work(stop); }) {}

void FeltWatch::offer(const PlanSnapshot& plan, int patch) {
  const auto now = std::chrono::steady_clock::now();
  if (now < next_) return;
  next_ = now + kPause;
  {
    const std::scoped_lock lock(mutex_);
    plan_ = plan;
    patch_ = patch;
    waiting_ = true;
  }
  wake_.notify_one();
}

void FeltWatch::work(const std::stop_token& stop) {
  // affects only this thread on Linux; the run has priority
  static_cast<void>(::nice(19));
  WorkerPool pool(1);
  while (true) {
    PlanSnapshot plan;
    int patch = 0;
    {
      std::unique_lock lock(mutex_);
      if (!wake_.wait(lock, stop, [this] { return waiting_; })) return;
      waiting_ = false;
      plan = std::move(plan_);
      patch = patch_;
    }
    const PlanPercept percept = percept_of(plan, patch, pool, stop);
    const std::scoped_lock lock(mutex_);
    percept_ = percept;
  }
}

}  // namespace prostm::viewer
