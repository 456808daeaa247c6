// Receives prostm-stream/1 (docs/devices/stream.md), prints statistics and writes samples to files:
// C++17 without dependencies, on Linux and on Windows. Needs prostm_receiver.hpp.
//
//   c++ -std=c++17 -O2 -pthread prostm_receiver.cpp -o prostm_receiver
//   x86_64-w64-mingw32-g++ -std=c++17 -O2 -static prostm_receiver.cpp -o prostm_receiver.exe
//   -lws2_32
//
// To drive an array, call its library in play().

#include "prostm_receiver.hpp"

#include <csignal>
#include <cstdio>
#include <cstdlib>

namespace {

using namespace prostm_receiver;

/// Writes one row per sample: as CSV if the name ends in .csv, else in binary as i64, i64, i32, f32
/// and four f32 per focal point.
class SampleFile {
 public:
  explicit SampleFile(const std::string& name, const char* first_column)
      : csv_(name.size() > 4 && name.substr(name.size() - 4) == ".csv"),
        file_(name.empty() ? nullptr : std::fopen(name.c_str(), "wb")) {
    if (!name.empty() && file_ == nullptr) {
      std::fprintf(stderr, "cannot write %s\n", name.c_str());
      std::exit(2);
    }
    if (file_ != nullptr && csv_)
      std::fprintf(file_, "%s,time_ns,foci,gain,x_m,y_m,z_m,intensity,...\n", first_column);
  }
  ~SampleFile() {
    if (file_ != nullptr) std::fclose(file_);
  }
  void row(std::int64_t first, const Sample& s, float gain) {
    if (file_ == nullptr) return;
    const auto foci = static_cast<std::size_t>(s.foci);
    if (csv_) {
      std::fprintf(file_, "%lld,%lld,%d,%g", static_cast<long long>(first),
                   static_cast<long long>(s.time), s.foci, static_cast<double>(gain));
      for (std::size_t f = 0; f < foci; ++f)
        std::fprintf(file_, ",%.9g,%.9g,%.9g,%.9g", static_cast<double>(s.focus[f].x),
                     static_cast<double>(s.focus[f].y), static_cast<double>(s.focus[f].z),
                     static_cast<double>(s.focus[f].intensity));
      std::fputc('\n', file_);
      return;
    }
    const std::int32_t n = s.foci;
    std::fwrite(&first, 8, 1, file_);
    std::fwrite(&s.time, 8, 1, file_);
    std::fwrite(&n, 4, 1, file_);
    std::fwrite(&gain, 4, 1, file_);
    std::fwrite(s.focus.data(), sizeof(Focus), foci, file_);
  }

 private:
  const bool csv_;
  std::FILE* file_;
};

/// Receives the output sample by sample, at about its play time. Call the library of an array here.
void play(const Sample& sample, Ns handed, float gain, SampleFile& file) {
  file.row(handed, sample, gain);
}

volatile std::sig_atomic_t interrupted = 0;

struct Options {
  Settings settings;
  double seconds = 1e9;
  std::string received, played;
};

[[noreturn]] void usage(const char* problem) {
  std::fprintf(stderr,
               "%s\nusage: prostm_receiver [ADDRESS:PORT] [--udp] [--foci N] [--every N] "
               "[--shared] [--silence-ms MS] [--seconds S] [--received FILE] [--played FILE]\n",
               problem);
  std::exit(2);
}

Options options_of(int argc, char** argv) {
  Options o;
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    const auto value = [&]() -> const char* {
      if (++i == argc) usage((name + " needs a value.").c_str());
      return argv[i];
    };
    const std::size_t colon = name.rfind(':');
    if (name == "--udp")
      o.settings.udp = true;
    else if (name == "--shared")
      o.settings.shared = true;
    else if (name == "--foci")
      o.settings.foci = std::atoi(value());
    else if (name == "--every")
      o.settings.every = std::atoi(value());
    else if (name == "--silence-ms")
      o.settings.silence_after = static_cast<Ns>(std::atof(value()) * 1e6);
    else if (name == "--seconds")
      o.seconds = std::atof(value());
    else if (name == "--received")
      o.received = value();
    else if (name == "--played")
      o.played = value();
    else if (name[0] == '-' || colon == name.npos)
      usage((name + " is unknown.").c_str());
    else {
      o.settings.host = name.substr(0, colon);
      o.settings.port = name.substr(colon + 1);
      if (o.settings.host.size() > 2 && o.settings.host[0] == '[')  // IPv6
        o.settings.host = o.settings.host.substr(1, o.settings.host.size() - 2);
    }
  }
  if (o.settings.foci < 0 || o.settings.foci > kMostFoci) usage("--foci must be 0 to 8.");
  if (o.settings.every < 1 || o.settings.every > 1000) usage("--every must be 1 to 1000.");
  if (o.settings.silence_after < kMs || o.settings.silence_after > 100 * kMs)
    usage("--silence-ms must be 1 to 100.");
  return o;
}

void print(const Statistics& s) {
  std::printf(
      "{\"samples\": %lld, \"lost\": %lld, \"concealed\": %lld, \"late\": %lld, \"skipped\": %lld, "
      "\"silences\": %lld, \"malformed\": %lld, \"subscriptions\": %lld, \"round_trip_ms\": %.3f, "
      "\"offset_ms\": %.3f, "
      "\"buffered_ms\": %.3f}\n",
      static_cast<long long>(s.samples), static_cast<long long>(s.lost),
      static_cast<long long>(s.concealed), static_cast<long long>(s.late),
      static_cast<long long>(s.skipped), static_cast<long long>(s.silences),
      static_cast<long long>(s.malformed), static_cast<long long>(s.subscriptions), s.round_trip_ms,
      s.offset_ms, s.buffered_ms);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
#ifdef _WIN32
  WSADATA data;
  WSAStartup(MAKEWORD(2, 2), &data);
#endif
  const Options options = options_of(argc, argv);
  std::signal(SIGINT, [](int) { interrupted = 1; });
  std::signal(SIGTERM, [](int) { interrupted = 1; });

  SampleFile received(options.received, "index"), played(options.played, "handed_ns");
  Receiver receiver(options.settings);
  receiver.on_sample = [&](const Sample& sample) { received.row(sample.index, sample, 1.0F); };
  receiver.on_event = [](const std::string& sentence) {
    std::printf("%s\n", sentence.c_str());
    std::fflush(stdout);
  };
  receiver.start();

  // a library's callback would pass times of its own; this loop uses the times that are due
  const Ns step = 25'000 * options.settings.every, begin = now_ns();
  Ns time = begin, next_line = begin + 1000 * kMs;
  bool playing = false;
  while (interrupted == 0 && time - begin < static_cast<Ns>(options.seconds * 1e9)) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    const Ns now = now_ns();
    // after too long a sleep, the missed samples are skipped
    if (now - time > 20 * kMs) time = now - step;
    while (time + step <= now) {
      time += step;
      Sample sample;
      const float gain = receiver.at(time, sample);
      sample.time = time;
      if (sample.foci > 0) play(sample, now, gain, played);  // 0 before the first sample
      if (playing && gain == 0.0F)
        std::printf("silent %.1f ms after the last message\n",
                    static_cast<double>(time - receiver.statistics().last_heard) / 1e6);
      playing = gain > 0.0F;
    }
    if (now >= next_line) {
      print(receiver.statistics());
      next_line = now + 1000 * kMs;
    }
  }
  receiver.stop();
  print(receiver.statistics());
  return 0;
}
