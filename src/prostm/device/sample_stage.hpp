#pragma once
/// Stages between an emission and a device.

#include "prostm/emit/focus_sample.hpp"

namespace prostm {

/// Passes on the samples of another source, modified or inspected.
class SampleStage : public SampleSource {
 public:
  int foci() const final { return from_->foci(); }

 protected:
  SampleSource& from() { return *from_; }
  /// Sets the source of its samples. @pre no thread is pulling.
  virtual void follow(SampleSource& from) { from_ = &from; }

 private:
  friend class SampleChain;
  SampleSource* from_ = nullptr;
};

}  // namespace prostm
