/// Cost of viewing: a run in real time without a page, with one page, and with five, one of which
/// stops reading; and the time that the pipeline's own threads spend on passing data on.
///
/// usage: view_bench [--json FILE] [--seconds S] [--scene S]

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "program.hpp"
#include "prostm/core/stage_timer.hpp"
#include "prostm/device/simulated/simulated_array.hpp"
#include "prostm/pipeline/runner.hpp"
#include "prostm/viewer/pipeline_view.hpp"
#include "prostm/viewer/server.hpp"

namespace prostm {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;

struct Options {
  double seconds = 15.0;  // duration of each run [s]
  std::string scene = "one-plume";
};

class UntilToldToStop final : public RunObserver {
 public:
  bool on_plan(const WorldFrame&, const PlanFrame&) override { return !stop; }
  bool on_progress(double) override { return !stop; }
  std::atomic<bool> stop{false};
};

/// A page that counts the received frames on its own thread; one that stops reads nothing after its
/// first frame.
class Reader {
 public:
  Reader(int port, bool stops) : socket_(io_) {
    socket_.next_layer().connect(
        {asio::ip::address_v4::loopback(), static_cast<std::uint16_t>(port)});
    socket_.handshake("127.0.0.1:" + std::to_string(port), "/live");
    thread_ = std::thread([this, stops] { read(stops); });
  }
  ~Reader() {
    boost::system::error_code ignored;
    socket_.next_layer().shutdown(asio::ip::tcp::socket::shutdown_both, ignored);
    thread_.join();
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  std::atomic<std::int64_t> frames{0}, bytes{0};

 private:
  void read(bool stops) {
    boost::system::error_code wrong;
    while (!wrong && !(stops && frames > 0)) {
      beast::flat_buffer buffer;
      socket_.read(buffer, wrong);
      if (wrong || socket_.got_text()) continue;
      ++frames;
      bytes += static_cast<std::int64_t>(buffer.size());
    }
  }
  asio::io_context io_;
  beast::websocket::stream<asio::ip::tcp::socket, false> socket_;
  std::thread thread_;
};

/// The measurements of one run, one value per second.
struct Measured {
  Distribution server, frames, bytes;  // [%], [1/s] and [MB/s] of each page that reads
  RunSummary run;
  std::int64_t skipped = 0;
};

PipelineSettings settings_of(const Options& given) {
  PipelineSettings s;
  s.scene = given.scene;
  set_live_budget(s);
  return s;
}

std::unique_ptr<HandSource> hands_of(const PipelineSettings& s) {
  return make_scripted_hand(s.scripted_hand, s.track);
}

/// Measures once a second for `seconds`. @param stopped whether the first page stopped reading.
void watch(const ViewServer& server, const std::vector<std::unique_ptr<Reader>>& pages,
           bool stopped, double seconds, Measured& out) {
  for (double t = 0.0; t < seconds; t += 1.0) {
    const double cpu = server.cpu_time();
    std::vector<std::int64_t> frames, bytes;
    for (const auto& page : pages) {
      frames.push_back(page->frames);
      bytes.push_back(page->bytes);
    }
    const StageTimer timer;
    std::this_thread::sleep_for(std::chrono::seconds(1));
    const double wall = timer.seconds();
    out.server.add(100.0 * (server.cpu_time() - cpu) / wall);
    for (std::size_t i = stopped ? 1 : 0; i < pages.size(); ++i) {
      out.frames.add(static_cast<double>(pages[i]->frames - frames[i]) / wall);
      out.bytes.add(1e-6 * static_cast<double>(pages[i]->bytes - bytes[i]) / wall);
    }
  }
}

void measure_run(const Options& given, int readers, bool one_stops, Measured& out) {
  const PipelineSettings settings = settings_of(given);
  LiveLink link;
  link.settings.pipeline = settings;
  link.page_hand = std::make_shared<PageHand>(settings.track);
  auto hands =
      std::make_unique<HandSwitch>(hands_of(settings), link.page_hand, default_tracker_pose());
  link.hands = hands.get();
  Pipeline pipeline(settings, std::move(hands));
  PipelineView view(link, ViewHello{"bench",
                                    "simulated usx",
                                    "usx",
                                    settings.transducers.position,
                                    Vec3::Zero(),
                                    settings.fluid.width,
                                    {}});
  ViewSettings view_settings;
  view_settings.port = 0;
  view_settings.stall_time = 3600.0;  // keeps the page that stopped
  const ViewServer server(view_settings, view, {});

  UntilToldToStop observer;
  RunOptions options;
  options.seconds = 86400.0;
  options.live = &link;
  std::thread running([&] { out.run = run(pipeline, settings, options, observer); });
  std::vector<std::unique_ptr<Reader>> pages;
  for (int i = 0; i < readers; ++i)
    pages.push_back(std::make_unique<Reader>(server.port(), one_stops && i == 0));
  std::this_thread::sleep_for(std::chrono::seconds(2));
  watch(server, pages, one_stops, given.seconds, out);
  out.skipped = server.stats().skipped_frames;
  observer.stop = true;
  running.join();
  if (out.run.failure) std::rethrow_exception(out.run.failure);
}

/// Measures the same run without a server.
RunSummary measure_alone(const Options& given) {
  const PipelineSettings settings = settings_of(given);
  Pipeline pipeline(settings, hands_of(settings));
  UntilToldToStop observer;
  RunOptions options;
  options.seconds = given.seconds + 2.0;
  const RunSummary summary = run(pipeline, settings, options, observer);
  if (summary.failure) std::rethrow_exception(summary.failure);
  return summary;
}

/// Measures the time that the pipeline's threads spend on passing data on, per call [µs].
void measure_hand_off(const Options& given, Distribution& step, Distribution& smoke,
                      Distribution& plan) {
  constexpr int kSteps = 400;
  PipelineSettings settings = settings_of(given);
  settings.devices.of<SimulatedArraySettings>().realtime = false;
  Pipeline pipeline(settings, hands_of(settings));
  Snapshots snapshots;
  snapshots.watch(true);
  snapshots.use(std::make_shared<const PipelineSettings>(settings));
  for (int i = 0; i < kSteps; ++i) {
    const bool planned = pipeline.step(0.02);
    StageTimer timer;
    snapshots.step(pipeline.contact(), pipeline.world_stage());
    step.add(1e6 * timer.lap());
    snapshots.volume(pipeline.world_stage().world());
    smoke.add(1e6 * timer.lap());
    if (!planned) continue;
    snapshots.plan(pipeline.contact(), pipeline.plan(), 0.02);
    plan.add(1e6 * timer.lap());
  }
}

/// Wraps a single number as a summary.
Summary single(double value) {
  return {1, value, 0.0, value, value, value};
}

std::vector<bench::Row> view_rows(const Options& given) {
  std::vector<bench::Row> rows;
  const RunSummary alone = measure_alone(given);
  Measured one, five;
  measure_run(given, 1, false, one);
  measure_run(given, 5, true, five);
  const auto add = [&](const std::string& name, const char* unit, const Summary& ours) {
    rows.push_back({name, unit, ours, "", 0.0});
  };
  add("server's thread, one page", "%", one.server.summary());
  add("server's thread, five pages", "%", five.server.summary());
  add("frames of one page", "1/s", one.frames.summary());
  add("frames of four, a fifth stopped", "1/s", five.frames.summary());
  add("bytes of one page", "MB/s", one.bytes.summary());
  add("frames that the stopped page missed", "", single(static_cast<double>(five.skipped)));

  Distribution step, smoke, plan;
  measure_hand_off(given, step, smoke, plan);
  add("pipeline: hands of a step", "us", step.summary());
  add("pipeline: smoke of a step", "us", smoke.summary());
  add("pipeline: target and plan of an update", "us", plan.summary());

  const auto add_run = [&](const std::string& name, const RunSummary& run) {
    rows.push_back({name + ": missed blocks", "",
                    single(static_cast<double>(run.device.missed_blocks)), "without a page",
                    static_cast<double>(alone.device.missed_blocks)});
    rows.push_back({name + ": late blocks", "", single(static_cast<double>(run.device.late_blocks)),
                    "without a page", static_cast<double>(alone.device.late_blocks)});
    Summary latency = run.latency;
    latency.p50 *= 1e3;
    latency.p99 *= 1e3;
    latency.max *= 1e3;
    rows.push_back({name + ": latency", "ms", latency, "without a page", 1e3 * alone.latency.p50});
  };
  add_run("one page", one.run);
  add_run("five pages", five.run);
  return rows;
}

}  // namespace
}  // namespace prostm

int main(int argc, char** argv) {
  prostm::Options given;
  prostm::bench::Program program("cost of viewing a run in the web page");
  program.option("--seconds", given.seconds, "duration of each run [s]", 1.0, 3600.0);
  program.option("--scene", given.scene, "scene of the runs");
  return program.run(argc, argv, [&] { return prostm::view_rows(given); });
}
