/// Quality of percepts: ways to plan, judged by the array's own field and the skin's waves, on
/// separate sets of fields. Nobody has felt any of this.

#include <array>
#include <chrono>
#include <thread>

#include "felt/front.hpp"
#include "felt/kept.hpp"
#include "felt/live.hpp"
#include "felt/picture.hpp"
#include "felt/recorded.hpp"
#include "felt/tables.hpp"
#include "program.hpp"
#include "prostm/figure/figures.hpp"

namespace {

using namespace prostm;
using namespace prostm::bench;

constexpr std::size_t kChartsInRow = 2;

/// Keeps the named ones, in their original order; all if no name is given.
template <class Named>
void keep_only(std::vector<Named>& all, const std::vector<std::string>& names, const char* what) {
  if (names.empty()) return;
  for (const std::string& name : names) {
    if (std::none_of(all.begin(), all.end(), [&](const Named& one) { return one.name == name; })) {
      std::string known;
      for (const Named& one : all) known += (known.empty() ? "" : ", ") + one.name;
      throw InputError(fmt::format("{} \"{}\" is unknown; there are: {}", what, name, known));
    }
  }
  std::erase_if(all, [&](const Named& one) {
    return std::find(names.begin(), names.end(), one.name) == names.end();
  });
}

template <class Named>
std::vector<std::string> names_of(const std::vector<Named>& all) {
  std::vector<std::string> out;
  for (const Named& one : all) out.push_back(one.name);
  return out;
}

/// Scores live runs of moving and of still targets, or of those of a recording if it is not empty.
std::vector<Row> live_rows(const TransducerArray& array, const std::vector<Way>& ways,
                           SwitchAt switch_at, int most, int threads, bool each,
                           const std::string& recording) {
  std::vector<Row> rows;
  const auto score = [&](const std::string& name, const std::vector<LiveSequence>& sequences) {
    const LiveSet set = score_live(name, array, sequences, ways, switch_at, threads);
    print_live(set, each);
    std::fflush(stdout);
    add_live_rows(set, rows);
  };
  if (recording.empty()) {
    score("live, moving", live_sequences(false, most));
    score("live, still", live_sequences(true, most));
  } else {
    score("live, recorded", recorded_sequences(recording, most));
  }
  return rows;
}

}  // namespace

int main(int argc, char** argv) {
  Program program("how well plans are felt, by the array's own field");
  std::vector<std::string> sets = {"gallery", "scout", "plumes", "new"}, only_ways, only_skins,
                           only_disturbances;
  std::string figure, front, keep, recording, switch_name = "lap";
  int most = 0, threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  bool each = false, quick = false, live = false;
  program.option("--set", sets,
                 "sets of fields: tuning, gallery, scout, plumes, new, drawn, redrawn, shapes");
  program.option("--ways", only_ways, "only these ways; the others are compared with the first");
  program.option("--skins", only_skins, "only these skins; the first has all readouts");
  program.option("--disturbances", only_disturbances, "only these disturbances");
  program.flag("--live", live,
               "plans that replace one another every 40 ms, felt in time, instead of the sets");
  program.option("--recording", recording,
                 "with --live: seconds of this recording of prostm run, instead of generated ones");
  program.option("--switch", switch_name, "with --live: when a new plan takes over: lap, now");
  program.flag("--quick", quick, "only the first skin, and no disturbance");
  program.option("--fields", most, "number of fields of each set; 0: all", 0, 1000);
  program.option("--threads", threads, "number of fields that are judged at once", 1, 64);
  program.flag("--each", each, "print every field, too");
  program.option("--keep", keep,
                 "keep judgements of plans in this file, and use those in it; remove it when "
                 "emission, acoustics or skin have changed");
  program.option("--figure", figure, "draw fields of the last set, and their percepts");
  program.option("--front", front, "draw lack over strength of the ways, a chart for each set");
  return program.run(argc, argv, [&] {
    for (const std::string& picture : {figure, front}) {
      if (!picture.empty()) check_figure(picture);
    }
    const TransducerArray array = usx_array();
    std::vector<Way> all_ways = ways(array);
    std::vector<Skin> all_skins = skins();
    std::vector<Disturbed> disturbances = felt_disturbances();
    keep_only(all_ways, only_ways, "way");
    keep_only(all_skins, only_skins, "skin");
    keep_only(disturbances, only_disturbances, "disturbance");
    if (all_ways[0].is_control)
      throw InputError("the first way is the reference, so it must not be a control");
    const auto switch_at = from_name<SwitchAt>(switch_name, "switch");
    if (!recording.empty() && !live) throw InputError("--recording needs --live");
    if (switch_at != SwitchAt::Lap && !live) throw InputError("--switch needs --live");
    if (live && !(figure.empty() && front.empty()))
      throw InputError("--figure and --front draw sets of fields: leave out --live");
    if (live) return live_rows(array, all_ways, switch_at, most, threads, each, recording);
    if (quick) {
      all_skins.resize(1);
      disturbances.clear();
    }
    if (!figure.empty() && !keep.empty())
      throw InputError("--figure needs maps, which --keep does not keep: give one of them");
    Kept kept(keep);
    std::vector<Row> rows;
    std::vector<JudgedSet> judged;
    for (const std::string& name : sets) {
      const SetName set = from_name<SetName>(name, "set");
      const std::vector<NamedField> fields = field_set(set, most);
      judged.push_back(
          {name, names_of(fields), names_of(all_ways), names_of(all_skins), names_of(disturbances),
           judge_all(array, fields, all_ways, all_skins, disturbances, threads, kept)});
      print_tables(judged.back());
      if (each) print_each(judged.back());
      std::fflush(stdout);
      add_rows(judged.back(), rows);
      if (!figure.empty() && name == sets.back()) draw_felt(judged.back(), fields, figure);
    }
    if (!front.empty()) draw_charts(front_charts(judged), front, kChartsInRow);
    if (judged.size() > 1) print_tables(pooled("all of these sets", judged));
    return rows;
  });
}
