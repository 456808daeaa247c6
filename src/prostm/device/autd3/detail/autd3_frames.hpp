#pragma once
/// Frames of AUTD3's firmware, v38, byte by byte. All numbers are little-endian.

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "prostm/device/detail/slot_encoder.hpp"

namespace prostm::autd3 {

/// Bytes for a unit: message id, 0, offset of a second command (u16), 622 bytes of
/// commands.
using Frame = std::array<std::uint8_t, 626>;
/// Bytes from a unit: data, then error << 4 | message id.
struct Answer {
  std::uint8_t data = 0, acknowledgement = 0;
  int message() const { return acknowledgement & 0xF; }
  int error() const { return acknowledgement >> 4; }
};

/// Moment when a segment starts to play, as the firmware numbers it.
enum class Transition : std::uint8_t {
  Gpio = 2,          ///< when a GPIO input is high; for finite loops
  Alternate = 0xF0,  ///< at once; then segments alternate at the end of every loop ("Ext")
  Later = 0xFE,      ///< not now; while segments alternate, at the segment's next turn
  Immediate = 0xFF
};

/// Firmware information, numbered as the firmware does.
enum class Info : std::uint8_t { CpuMajor = 1, CpuMinor, FpgaMajor, FpgaMinor, Functions, Done };

/// Bits of the data byte of an answer, after read_state().
inline constexpr std::uint8_t kHot = 1, kModulationSegment = 2, kFociSegment = 4,
                              kStateIsRead = 128;

inline constexpr int kMostModulation = 254;  ///< samples of modulation in one frame

// Each function writes one frame, except its message id.
void nop(Frame& frame);
/// Clears all data of the units and synchronises their clocks.
void clear_and_synchronise(Frame& frame);
void read_state(Frame& frame);
void firmware(Frame& frame, Info info);
/// Sets the four emulated GPIO inputs, bit by bit.
void gpio(Frame& frame, std::uint8_t inputs);
/// Spreads changes of phases and intensities over `steps` periods of 40 kHz; units then refuse
/// faster patterns.
void silencer(Frame& frame, int steps);
/// Plays a modulation once, from its first sample on, and then holds its last sample. @pre GPIO 0
/// is high, and the other segment is playing. @param samples 2 to kMostModulation, each of
/// `divider` / 40 kHz.
void modulation(Frame& frame, std::span<const std::uint8_t> samples, int segment, int divider);

/// A segment of focal points that repeats without end.
struct FociSegment {
  int segment = 0;
  Transition transition = Transition::Later;
  int slots = 8;             ///< per sample
  int samples = 0;           ///< of the segment
  int divider = 6;           ///< periods of 40 kHz per sample
  double sound_speed = 0.0;  ///< [m/s]
};
/// Number of frames of a segment, which hold whole samples: up to 74 slots in the first frame, and
/// 77 in each of the others.
int foci_frames(int slots, int samples);
/// Number of samples in the first `frames` frames.
int samples_in_frames(int slots, int samples, int frames);
/// Writes frame `index` of a segment.
/// @param words of one unit for the whole segment, sample-major.
void foci(Frame& frame, const FociSegment& segment, std::span<const SlotWord> words, int index);

/// Plays a segment, and then both segments in turn. @pre both have the same length and rate, are
/// written, and have played: only then does the firmware count their loops in step.
void alternate(Frame& frame, int segment);

/// Explains an error of the firmware, 1..8, to the user of the array, in a clause.
std::string error_sentence(int error);

}  // namespace prostm::autd3
