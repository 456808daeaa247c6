#pragma once
/// The pages of `prostm run --view` and `prostm study run`.

#include <cstdio>
#include <memory>
#include <vector>

#include "options.hpp"
#include "prostm/pipeline/live.hpp"
#include "prostm/pipeline/pipeline.hpp"
#include "prostm/viewer/pipeline_view.hpp"
#include "prostm/viewer/server.hpp"
#include "prostm/viewer/study_view.hpp"

namespace prostm::app {

/// @throws InputError for options of the page that contradict each other.
void check_view(const RunOptionsGiven& given, bool realtime);

/// Everything that a page needs. Created before the pipeline, and destroyed after it.
class View {
 public:
  View(const RunOptionsGiven& given, const PipelineSettings& settings);

  /// The settings for the pipeline, with everything that the page can change.
  const PipelineSettings& settings() const { return link_.settings.pipeline; }
  LiveLink& link() { return link_; }
  /// Returns hands that switch between `base` and the page's own hand.
  std::unique_ptr<HandSource> behind_the_page(std::unique_ptr<HandSource> base);
  /// Starts the server, and prints its address.
  void serve(Pipeline& pipeline, std::FILE* out);
  /// Starts the server of a study's two pages, and prints their addresses. @return its view.
  StudyView& serve(Pipeline& pipeline, StudySession& session, std::optional<Rehearsal> rehearsal,
                   MarkerSender& markers, std::FILE* out);
  /// Stops the server; the pipeline may be destroyed afterwards.
  void stop() { server_.reset(); }
  /// @throws if the server has failed.
  void check() const { server_->check(); }
  /// Prints that the run continues, and the page's address.
  void announce(std::FILE* out) const;

 private:
  ViewHello hello(Pipeline& pipeline) const;
  void start(bool guests);
  void warn(std::FILE* out) const;

  const RunOptionsGiven& given_;
  LiveLink link_;
  std::unique_ptr<ViewSource> source_;
  std::vector<PageFile> files_;  // of the server
  std::unique_ptr<ViewServer> server_;
};

}  // namespace prostm::app
