#pragma once
/// A real-time run with a server, for tests of pages that control it.

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "prostm/device/simulated/simulated_array.hpp"
#include "prostm/pipeline/runner.hpp"
#include "prostm/track/hand_source.hpp"
#include "prostm/viewer/pipeline_view.hpp"
#include "viewer/view_support.hpp"

namespace prostm::test {

RunOptions for_long();
PipelineSettings small_settings();

using MakeHand = std::function<std::unique_ptr<HandSource>(const PipelineSettings&)>;
std::unique_ptr<HandSource> no_tracker(const PipelineSettings&);

class UntilToldToStop final : public RunObserver {
 public:
  bool on_plan(const WorldFrame&, const PlanFrame&) override { return !stop; }
  bool on_progress(double) override { return !stop; }
  void on_abandoned_pause(double time) override { abandoned_at = time; }
  std::atomic<bool> stop{false};
  std::atomic<double> abandoned_at{-1.0};  // run time of the last one [s]
};

/// A run, its server and its reported numbers.
class LiveRun {
 public:
  /// @param tracker creates the hands of the source "leap".
  explicit LiveRun(const PipelineSettings& settings = small_settings(),
                   RunOptions options = for_long(), const MakeHand& tracker = no_tracker);
  ~LiveRun();
  LiveRun(const LiveRun&) = delete;
  LiveRun& operator=(const LiveRun&) = delete;

  RunSummary stop();
  /// Waits until the run ends by itself.
  RunSummary wait();
  /// Run time at which a pause was given up; −1 before [s].
  double abandoned_at() const { return observer_.abandoned_at; }
  int port() const { return server_->port(); }
  /// Returns the contents of /numbers.json.
  Json numbers() const;
  /// One of its numbers; empty for null, since comparing NaN would trap.
  std::optional<double> number(const char* name) const;
  int world_steps() const;
  int plan_updates() const;
  unsigned flags() const;
  const SimulatedArray& device() const;
  /// Returns the largest intensity of samples first … last − 1.
  float loudest(std::int64_t first, std::int64_t last) const;
  bool sounds() const;

  std::atomic<double> prediction{-1};  // setting of the most recent hands [s]
  const std::string pose_file;

 private:
  LiveLink link_;
  UntilToldToStop observer_;
  RunSummary summary_;
  std::unique_ptr<Pipeline> pipeline_;
  std::unique_ptr<PipelineView> view_;
  std::unique_ptr<ViewServer> server_;
  std::thread thread_;
};

void set(Page& page, const char* id, const Json& value);

Json control(const Json& state, const std::string& id);

/// Returns the next state in which a control has this value; other values may precede it.
Json state_with(Page& page, const std::string& id, const Json& value);

/// Waits for a state whose transport has this value.
bool transport_becomes(Page& page, const char* key, const Json& value);

}  // namespace prostm::test
