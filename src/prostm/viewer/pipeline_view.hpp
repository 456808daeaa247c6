#pragma once
/// A run, as the server shows and steers it.

#include <memory>
#include <string>

#include "prostm/pipeline/live.hpp"
#include "prostm/viewer/view_source.hpp"

namespace prostm {

/// The facts that a page is told once.
struct ViewHello {
  std::string version;             ///< of prostm
  std::string device;              ///< name of what plays
  std::string array;               ///< name
  std::vector<Vec3> transducers;   ///< in D [m]
  Vec3 box_corner = Vec3::Zero();  ///< of the smoke, in D [m]
  double box_edge = 0.0;           ///< [m]
};

/// Everything expensive about being looked at (the rendered field, its metrics, messages) happens
/// here, on the server's thread.
class PipelineView final : public ViewSource {
 public:
  /// @param link must outlive this.
  PipelineView(LiveLink& link, ViewHello hello);
  ~PipelineView() override;

  void watch(bool somebody) override;
  void refresh(ViewFrame& frame, ViewNews& news) override;
  bool shows_frames(Room) const override { return true; }
  std::string hello(std::uint32_t page, Room room) override;
  /// Guests have no state.
  bool refresh_state(Room room, std::string& state) override;
  std::string take(std::uint32_t page, const PageMessage& message) override;
  bool next_refusal(std::uint32_t& page, std::string& sentence) override;
  void forget(std::uint32_t page) override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace prostm
