#pragma once
/// A run as a source for the server, which shows and controls it.

#include <memory>
#include <string>

#include "prostm/pipeline/live.hpp"
#include "prostm/viewer/view_source.hpp"

namespace prostm {

/// Constant facts, sent to a page once.
struct ViewHello {
  std::string version;             ///< of prostm
  std::string device;              ///< name of the device
  std::string array;               ///< name of the array
  std::vector<Vec3> transducers;   ///< in D [m]
  Vec3 box_corner = Vec3::Zero();  ///< corner of the smoke's box in D [m]
  double box_edge = 0.0;           ///< [m]
  double level_below = 0.0;        ///< interval of sensation levels with this array: below [dB]
  double level_above = 0.0;        ///< the same, above [dB]
  std::string sound_source;        ///< name of its SoundSource
};

/// Does the expensive work for viewers (rendering the field, metrics, messages) on the server's
/// thread.
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
