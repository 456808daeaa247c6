#include <fmt/format.h>
#include <fmt/ranges.h>

#include <boost/crc.hpp>
#include <filesystem>
#include <mutex>

#include "common.hpp"
#include "prostm/commit.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/core/require.hpp"
#include "prostm/core/stage_timer.hpp"
#include "prostm/core/text/json.hpp"
#include "prostm/report/page.hpp"
#include "report/print_page.hpp"
#include "report/report.hpp"

namespace prostm::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// The folder of the paper's data; empty where it is missing.
std::string paper_folder(const ReportOptionsGiven& given) {
  if (given.paper_data) {
    if (fs::is_directory(*given.paper_data)) return *given.paper_data;
    throw InputError("--paper-data " + *given.paper_data +
                     " is not a folder; it must hold fig4.json, fig2.json and fig2.field.json");
  }
  return fs::is_directory(kPaperData) ? kPaperData : "";
}

/// @throws InputError for a folder with files other than a report's.
void check_folder(const std::string& out) {
  if (out.empty() || out.starts_with("--"))
    throw InputError("--out needs the name of a folder for the report");
  std::error_code failure;
  if (!fs::exists(out, failure)) return;
  if (!fs::is_directory(out)) throw InputError("--out " + out + " is a file; name a folder");
  if (fs::is_empty(out) || fs::is_directory(fs::path(out) / "parts")) return;
  throw InputError("--out " + out +
                   " has other files than a report's; name a new folder, or that of a report");
}

/// Returns the remaining time, in words.
std::string left_in_words(double seconds) {
  if (seconds < 60.0) return fmt::format("{:.0f} s left", seconds);
  return fmt::format("{:.0f} min {:.0f} s left", std::floor(seconds / 60.0),
                     std::fmod(seconds, 60.0));
}

/// Lets the part state what a quick report lowered.
void add_lowered(Json& document) {
  if (!document.contains("lowered")) return;
  const auto lowered = document["lowered"].get<std::vector<std::string>>();
  auto& blocks = document["blocks"];
  blocks.insert(blocks.begin(), report::text_block(fmt::format("A quick report has {}.",
                                                               fmt::join(lowered, ", "))));
}

/// Makes the missing parts, and shows the progress.
class ReportRun {
 public:
  explicit ReportRun(const ReportOptionsGiven& given)
      : given_(given),
        folder_((fs::path(given.out) / "parts").string()),
        work_{given.quick, given.seed, paper_folder(given), folder_,
              [this](double share) { tell(share); }} {}

  /// @return the findings and the parts, in the page's order.
  /// @throws ReportStopped
  std::vector<report::Part> all() {
    check_paper_data(work_);
    std::vector<std::optional<report::Part>> found;
    for (const ReportPart& part : report_parts()) {
      found.push_back(given_.fresh ? std::nullopt : folder_.read(part.name, asked(part)));
      if (!found.back()) ahead_ += cost(part);
    }
    std::vector<report::Part> parts;
    for (std::size_t i = 0; i < found.size(); ++i) {
      const ReportPart& part = report_parts()[i];
      parts.push_back(found[i] ? *std::move(found[i]) : make(part));
    }
    report::Part findings = report_findings(parts, work_);
    findings.document["asked"] = {{"version", version_text()}};
    folder_.write(findings);
    parts.insert(parts.begin(), std::move(findings));
    return parts;
  }

  /// Returns the function that reads a part's picture.
  report::ReadPicture reader() const {
    return [this](const std::string& file) { return read_file(folder_.path(file)); };
  }
  const Interrupt& interrupt() const { return interrupt_; }
  int kept() const { return static_cast<int>(report_parts().size()) - made_; }

 private:
  double cost(const ReportPart& part) const {
    return given_.quick ? part.quick_seconds : part.seconds;
  }

  /// Returns everything that determines a part's numbers.
  Json asked(const ReportPart& part) const {
    Json asked = {{"version", version_text()}, {"quick", given_.quick}, {"seed", given_.seed}};
    if (!part.of_paper) return asked;
    for (const char* file : {"fig2.field.json", "fig2.json", "fig4.json"}) {
      const std::string text = work_.paper_file(file).value_or("");
      boost::crc_32_type sum;
      sum.process_bytes(text.data(), text.size());
      asked["paper_data"][file] = text.empty() ? Json(nullptr) : Json(sum.checksum());
    }
    return asked;
  }

  report::Part make(const ReportPart& kind) {
    now_ = &kind;
    tell(0.0);
    report::Part part{kind.name,
                      {{"format", "prostm-report-part/1"},
                       {"part", kind.name},
                       {"title", kind.title},
                       {"asked", asked(kind)},
                       {"values", Json::object()},
                       {"blocks", Json::array()},
                       {"timing", Json::array()}}};
    const StageTimer timer;
    kind.make(work_, part.document);
    add_lowered(part.document);
    folder_.write(part);
    done_ += cost(kind);
    ++made_;
    progress_.say(stdout, fmt::format("{:<12} {:>6.1f} s", kind.name, timer.seconds()));
    return part;
  }

  /// Parts may call it on several threads.
  void tell(double share) {
    const std::lock_guard lock(telling_);
    if (interrupt_.requested()) throw ReportStopped{};
    constexpr double kFirst = 2.0;  // work after which its pace is used for the estimate [s]
    const double done = done_ + share * cost(*now_);
    const double pace = done > kFirst ? since_start_.seconds() / done : 1.0;
    progress_.show(
        100.0 * done, 100.0 * ahead_,
        fmt::format("({}), {}", now_->name, left_in_words(pace * (ahead_ - done))).c_str());
  }

  const ReportOptionsGiven& given_;
  const Interrupt interrupt_;
  report::PartFolder folder_;
  ReportWork work_;
  Progress progress_{"report"};
  const StageTimer since_start_;
  std::mutex telling_;
  const ReportPart* now_ = nullptr;
  double ahead_ = 0.0, done_ = 0.0;  // of the parts that are made [s]
  int made_ = 0;
};

Json all_json(const std::vector<report::Part>& parts) {
  Json json = {
      {"format", "prostm-report/1"}, {"version", version_text()}, {"parts", Json::object()}};
  for (const report::Part& part : parts) json["parts"][part.name] = part.document;
  return json;
}

/// Prints the page as a PDF, if there is a browser. @return a sentence about the result.
std::string print(const std::string& page, const std::string& pdf) {
  const auto browser = find_browser();
  std::error_code ignored;
  fs::remove(pdf, ignored);  // of another page
  if (!browser)
    return "no report.pdf: neither chromium, chromium-browser nor google-chrome is on PATH";
  if (!print_page(*browser, page, pdf)) return "no report.pdf: " + *browser + " could not print it";
  return "wrote " + pdf;
}

}  // namespace

int report_command(const ReportOptionsGiven& given) {
  require_between("--seed", given.seed, 0, 1'000'000'000);
  check_folder(given.out);
  ReportRun run(given);
  std::vector<report::Part> parts;
  try {
    parts = run.all();
  } catch (const ReportStopped&) {
    fmt::print("Stopped. Finished parts are kept in {}; run the same command again to resume.\n",
               given.out);
    return run.interrupt().status();
  }
  if (run.kept() > 0)
    fmt::print("{} parts were kept from an earlier run (--fresh makes them again)\n", run.kept());
  const fs::path out = given.out;
  const std::string page = (out / "index.html").string(), json = (out / "report.json").string();
  write_file(page, report::page_html(given.quick ? "prostm report, quick" : "prostm report", parts,
                                     run.reader()));
  say_written(stdout, page);
  write_file(json, to_text(all_json(parts)));
  say_written(stdout, json);
  std::fflush(stdout);
  fmt::print("{}\n", print(page, (out / "report.pdf").string()));
  return run.interrupt().status();
}

}  // namespace prostm::app
