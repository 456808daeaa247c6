#include "felt_time/time_skin.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "prostm/acoustics/skin/skin_percept.hpp"
#include "prostm/acoustics/skin/skin_stepper.hpp"
#include "prostm/core/require.hpp"
#include "prostm/core/units.hpp"

namespace prostm::bench {
namespace {

using Complex = std::complex<double>;

constexpr double kWaveNumberStep = 4.0;  // [rad/m]: a copy of each load every 1.6 m
constexpr double kRinging = 0.2;         // time for which a response is stepped [s]
constexpr double kWindow = 0.4;          // period of the filtered response [s]
constexpr int kTicks = 2000;             // ticks in that period
constexpr int kAhead = 500;              // ticks by which the filter looks ahead
constexpr int kBins = 400;               // frequencies 1/kWindow apart, up to 1 kHz
constexpr int kBlock = 4096;             // ticks of a transform in time
constexpr int kNew = kBlock - kTicks;    // new ticks of a block

/// Returns the filtered response to an impulse of the pattern of wave number k: transforms at the
/// frequencies 1, 2, … kBins over kWindow.
std::vector<Complex> felt_blow(const SkinModel& model, double k, Eigen::FFT<double>& fft) {
  const double longest = std::min(2e-5, 0.06 / (k * model.settings().fast_speed));
  const int per_tick = static_cast<int>(std::ceil(kFeltTick / longest));
  const double step = kFeltTick / per_tick;
  SkinStepper stepper(model, k, step);
  std::vector<double> course(static_cast<std::size_t>(kTicks * per_tick), 0.0);
  const auto ringing = static_cast<std::size_t>(kRinging / step);
  for (std::size_t n = 0; n < ringing; ++n) {
    // the last quarter is faded, so that cutting it off excites nothing
    const double left = std::min(1.0, 4.0 * (1.0 - static_cast<double>(n) * step / kRinging));
    course[n] = stepper.displacement() * left * left * (3.0 - 2.0 * left);
    stepper.step(n == 0 ? 1.0 / step : 0.0);
  }
  std::vector<Complex> spectrum(course.size());
  fft.fwd(spectrum.data(), course.data(), static_cast<int>(course.size()));
  std::vector<Complex> out;
  for (int j = 1; j <= kBins; ++j) {
    out.push_back(spectrum[static_cast<std::size_t>(j)] * step * pacinian_sensitivity(j / kWindow));
  }
  return out;
}

/// Returns the filtered Green's functions over one cell, distances × kBins, (S11). @param index row
/// of each squared distance in cells
Eigen::MatrixXcd greens_functions(const SkinModel& model, double cell,
                                  const std::map<int, int>& index) {
  const auto count = static_cast<int>(std::round(kPi / cell / kWaveNumberStep));
  Eigen::FFT<double> fft;
  Eigen::MatrixXcd blows(count, kBins);
  Eigen::MatrixXd bessel(static_cast<Eigen::Index>(index.size()), count);
  for (int m = 0; m < count; ++m) {
    const double k = kWaveNumberStep * (m + 1);
    const double weight = k * kWaveNumberStep * cell * cell / (2.0 * kPi);
    const std::vector<Complex> blow = felt_blow(model, k, fft);
    for (int j = 0; j < kBins; ++j) blows(m, j) = weight * blow[static_cast<std::size_t>(j)];
    for (const auto& [square, row] : index) bessel(row, m) = j0(k * cell * std::sqrt(square));
  }
  return bessel * blows;
}

}  // namespace

TimeSkin::TimeSkin(const SkinModel& model, const SkinPatch& patch)
    : patch_(patch), plane_(fast_length(2 * patch.rows - 1), fast_length(2 * patch.cols - 1)) {
  require_between("rows", patch.rows, 1, 64);
  require_between("cols", patch.cols, 1, 64);
  require_between("cell", patch.cell, 2e-3, 20e-3, "m");
  if (model.relaxation_time() == 0.0) {
    throw std::invalid_argument("the skin must have a loss, or its response never ends");
  }
  // modes that differ in the signs of their wave numbers have the same kernel
  const int half = plane_.cols() / 2 + 1;
  for (int v = 0; v < plane_.rows(); ++v) {
    for (int u = 0; u < plane_.cols(); ++u) {
      mode_of_.push_back(std::min(v, plane_.rows() - v) * half + std::min(u, plane_.cols() - u));
    }
  }
  make_kernels(model);
}

void TimeSkin::make_kernels(const SkinModel& model) {
  const int rows = plane_.rows(), cols = plane_.cols();
  std::map<int, int> index;  // of distances, whose squares are integers in cells
  std::vector<int> radius_of;
  for (int v = 0; v < rows; ++v) {
    for (int u = 0; u < cols; ++u) {
      const int y = std::min(v, rows - v), x = std::min(u, cols - u);
      radius_of.push_back(
          index.try_emplace(y * y + x * x, static_cast<int>(index.size())).first->second);
    }
  }
  const Eigen::MatrixXcd green = greens_functions(model, patch_.cell, index);
  const auto modes = static_cast<std::size_t>((rows / 2 + 1) * (cols / 2 + 1));
  std::vector<Complex> spectra(modes * kTicks, 0.0), plane(radius_of.size());
  for (int j = 0; j < kBins; ++j) {
    for (std::size_t c = 0; c < plane.size(); ++c) plane[c] = green(radius_of[c], j);
    plane_.forward(plane, rows);
    for (std::size_t c = 0; c < plane.size(); ++c) {
      const auto mode = static_cast<std::size_t>(mode_of_[c]);
      spectra[mode * kTicks + static_cast<std::size_t>(j + 1)] = plane[c];
    }
  }
  // to times, from kAhead before the impulse to the window's end; back to the spectrum of a block
  Eigen::FFT<double> fft;
  std::vector<Complex> course(kTicks), padded(kBlock), transform(kBlock);
  for (std::size_t mode = 0; mode < modes; ++mode) {
    fft.inv(course.data(), &spectra[mode * kTicks], kTicks);
    std::fill(padded.begin(), padded.end(), 0.0);
    for (int i = 0; i < kTicks; ++i) {
      const auto from = static_cast<std::size_t>((i - kAhead + kTicks) % kTicks);
      padded[static_cast<std::size_t>(i)] = 2.0 * course[from].real();  // negative frequencies too
    }
    fft.fwd(transform.data(), padded.data(), kBlock);
    kernels_.insert(kernels_.end(), transform.begin(), transform.end());
  }
}

// Two blocks of ticks are convolved at a time, one as the real part and one as the imaginary.
class TimeSkin::Blocks {
 public:
  Blocks(const TimeSkin& skin, std::span<const float> pressure)
      : skin_(skin),
        pressure_(pressure),
        cells_(skin.patch_.size()),
        ticks_(static_cast<std::ptrdiff_t>(pressure.size() / cells_)),
        plane_fft_(skin.plane_),
        modes_(skin.mode_of_.size() * kBlock),
        plane_(skin.mode_of_.size()) {}

  std::vector<float> convolved() {
    std::vector<float> out(pressure_.size());
    for (std::ptrdiff_t start = 0; start < ticks_; start += 2 * kNew) {
      load(start);
      convolve();
      unload(start, out);
    }
    return out;
  }

 private:
  double pressure(std::ptrdiff_t tick, std::size_t cell) const {
    if (tick < 0 || tick >= ticks_) return 0.0;
    return static_cast<double>(pressure_[static_cast<std::size_t>(tick) * cells_ + cell]);
  }
  /// Place of a cell on the padded raster.
  std::size_t place(std::size_t cell) const {
    const auto cols = static_cast<std::size_t>(skin_.patch_.cols);
    return cell / cols * static_cast<std::size_t>(skin_.plane_.cols()) + cell % cols;
  }

  void load(std::ptrdiff_t start) {
    for (std::ptrdiff_t n = 0; n < kBlock; ++n) {
      const std::ptrdiff_t tick = start + n - (kTicks - 1 - kAhead);
      std::fill(plane_.begin(), plane_.end(), 0.0);
      for (std::size_t c = 0; c < cells_; ++c) {
        plane_[place(c)] = Complex(pressure(tick, c), pressure(tick + kNew, c));
      }
      plane_fft_.forward(plane_, skin_.patch_.rows);
      for (std::size_t p = 0; p < plane_.size(); ++p) {
        modes_[p * kBlock + static_cast<std::size_t>(n)] = std::complex<float>(plane_[p]);
      }
    }
  }
  void convolve() {
    for (std::size_t p = 0; p < plane_.size(); ++p) {
      std::complex<float>* course = &modes_[p * kBlock];
      const auto mode = static_cast<std::size_t>(skin_.mode_of_[p]);
      time_fft_.fwd(spectrum_.data(), course, kBlock);
      for (std::size_t n = 0; n < kBlock; ++n) {
        spectrum_[n] *= skin_.kernels_[mode * kBlock + n];
      }
      time_fft_.inv(course, spectrum_.data(), kBlock);
    }
  }
  void unload(std::ptrdiff_t start, std::vector<float>& out) {
    for (std::ptrdiff_t n = 0; n < kNew && start + n < ticks_; ++n) {
      for (std::size_t p = 0; p < plane_.size(); ++p) {
        plane_[p] = Complex(modes_[p * kBlock + static_cast<std::size_t>(n + kTicks - 1)]);
      }
      plane_fft_.inverse(plane_, skin_.patch_.rows);
      const auto first = static_cast<std::size_t>(start + n) * cells_;
      for (std::size_t c = 0; c < cells_; ++c) {
        const Complex value = plane_[place(c)];
        out[first + c] = static_cast<float>(value.real());
        if (start + n + kNew < ticks_) {
          out[first + kNew * cells_ + c] = static_cast<float>(value.imag());
        }
      }
    }
  }

  const TimeSkin& skin_;
  std::span<const float> pressure_;
  std::size_t cells_;
  std::ptrdiff_t ticks_;
  Fft2 plane_fft_;
  Eigen::FFT<float> time_fft_;
  std::vector<std::complex<float>> modes_;  // place by place: kBlock ticks
  std::vector<std::complex<float>> spectrum_ = std::vector<std::complex<float>>(kBlock);
  std::vector<Complex> plane_;
};

std::vector<float> TimeSkin::respond(std::span<const float> pressure) const {
  if (pressure.size() % patch_.size() != 0) {
    throw std::invalid_argument("there must be a pressure for each tick and cell");
  }
  return Blocks(*this, pressure).convolved();
}

std::vector<double> percept_over(std::span<const float> response, std::size_t cells,
                                 std::size_t first, std::size_t count) {
  std::vector<double> out(cells, 0.0);
  for (std::size_t tick = first; tick < first + count; ++tick) {
    for (std::size_t c = 0; c < cells; ++c) {
      const double felt = static_cast<double>(response[tick * cells + c]);
      out[c] += felt * felt / static_cast<double>(count);
    }
  }
  for (double& value : out) value = std::sqrt(value);
  return out;
}

}  // namespace prostm::bench
