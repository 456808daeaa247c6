#pragma once
/// A server of AUTD3's remote protocol, v38, with units behind it that play in real time.

#include <poll.h>

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "ear.hpp"

namespace standin {

struct Options {
  int port = 0;                // 0: any free port
  double frames_per_ms = 1.0;  // 0: as fast as they arrive
  int version = 0xA5;
  bool keeps_log = false;
};

/// Runs on one thread; run() returns when the control input ends or says quit.
class Server {
 public:
  explicit Server(const Options& options);
  void run();

 private:
  struct Out {
    std::int64_t due;  // [ns]
    std::string bytes;
    std::string frames = {};  // handled when they are due, if any
  };

  void listen();
  void wait();
  void play();
  void accept();
  void disconnect();
  void read_client();
  void read_control();
  void control(const std::string& line);
  std::size_t take_message();
  bool hello_is_right(const std::string& bytes);
  bool geometry_is_right(const std::string& bytes);
  void answer(const std::string& bytes, std::int64_t due);
  void refuse(const std::string& words);
  void flush();
  std::string report();
  void write_log(const std::string& path);
  void problem(const std::string& what);

  Options options_;
  int listener_ = -1, client_ = -1;
  bool quits_ = false;
  std::string in_, control_;
  std::deque<Out> out_;
  bool greeted_ = false, has_units_ = false, leaves_ = false;
  std::vector<Unit> units_;
  std::vector<double> places_;  // of the units, as received
  Ear ear_;
  double other_sound_ = 0.0;  // when a unit other than the first was last driven [s]

  std::int64_t tick_ = 0;
  std::int64_t next_slot_ = 0;  // when the bus accepts the next frame [ns]
  std::int64_t stalled_until_ = 0, closed_until_ = 0, delay_ = 0;
  int drops_ = 0;
  std::int64_t frames_ = 0, connections_ = 0, problems_ = 0, goodbyes_ = 0;
  std::string first_problem_;
};

}  // namespace standin
