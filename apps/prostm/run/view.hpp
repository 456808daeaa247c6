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

/// @throws InputError for options of the page that do not go together.
void check_view(const RunOptionsGiven& given, bool realtime);

/// Everything that a page needs, from before the pipeline is made until after it has run.
class View {
 public:
  View(const RunOptionsGiven& given, const PipelineSettings& settings);

  /// Those to make the pipeline with: all that the page can change is in them.
  const PipelineSettings& settings() const { return link_.settings.pipeline; }
  LiveLink& link() { return link_; }
  /// The hands that the page's own takes over from.
  std::unique_ptr<HandSource> behind_the_page(std::unique_ptr<HandSource> base);
  /// Starts the server, and prints where it is.
  void serve(Pipeline& pipeline, std::FILE* out);
  /// Starts the server of a study's two pages, and prints where they are. @return its view.
  StudyView& serve(Pipeline& pipeline, StudySession& session, std::optional<Rehearsal> rehearsal,
                   MarkerSender& markers, std::FILE* out);
  /// Ends the server; what it showed is free to be used.
  void stop() { server_.reset(); }
  /// @throws when the server has failed.
  void check() const { server_->check(); }
  /// Says that the run goes on, and where.
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
