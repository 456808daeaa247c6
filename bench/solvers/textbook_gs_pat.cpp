#include "solvers/textbook_gs_pat.hpp"

#include <algorithm>
#include <cmath>

namespace prostm::bench {

TextbookGsPat::TextbookGsPat(const TransducerArray& array, const Medium& medium, int most_foci)
    : n_(array.position.size()),
      wave_number_(static_cast<float>(wave(array, medium).number)),
      absorption_(static_cast<float>(wave(array, medium).absorption)),
      radius_(static_cast<float>(array.radius)),
      amplitude_(static_cast<float>(array.amplitude)) {
  const auto m = static_cast<std::size_t>(most_foci);
  for (const Vec3& p : array.position) {
    x_.push_back(static_cast<float>(p.x()));
    y_.push_back(static_cast<float>(p.y()));
  }
  g_re_.resize(m * n_);
  g_im_ = g_re_;
  r_re_.resize(m * m);
  r_im_ = r_re_;
  p_re_.resize(m);
  p_im_ = t_re_ = t_im_ = a_ = squares_ = p_re_;
  q_re_.resize(n_);
  q_im_ = q_re_;
}

void TextbookGsPat::propagate(const Eigen::Vector3f& p, float* re, float* im) const {
  for (std::size_t n = 0; n < n_; ++n) {
    const float dx = p.x() - x_[n], dy = p.y() - y_[n];
    const float across = dx * dx + dy * dy, r = std::sqrt(across + p.z() * p.z());
    // series of 2 J₁(u)/u in u², with enough terms for u up to 4
    const float u = wave_number_ * radius_ / r;
    const float v = u * u * across * 0.25F;
    const float directivity =
        1.0F - v * (1.0F / 2 -
                    v * (1.0F / 12 -
                         v * (1.0F / 144 -
                              v * (1.0F / 2880 -
                                   v * (1.0F / 86400 - v * (1.0F / 3628800 - v / 203212800.0F))))));
    const float size = amplitude_ * directivity / r * std::exp(-absorption_ * r);
    re[n] = size * std::cos(wave_number_ * r);
    im[n] = size * std::sin(wave_number_ * r);
  }
}

/// Computes R = G B and the squares of G's rows.
void TextbookGsPat::correlate(std::size_t foci) {
  for (std::size_t i = 0; i < foci; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      const float *ar = &g_re_[i * n_], *ai = &g_im_[i * n_], *br = &g_re_[j * n_],
                  *bi = &g_im_[j * n_];
      float re = 0.0F, im = 0.0F;
      for (std::size_t n = 0; n < n_; ++n) {
        re += ar[n] * br[n] + ai[n] * bi[n];
        im += ai[n] * br[n] - ar[n] * bi[n];
      }
      r_re_[i * foci + j] = r_re_[j * foci + i] = re;
      r_im_[i * foci + j] = im;
      r_im_[j * foci + i] = -im;
    }
    squares_[i] = r_re_[i * foci + i];
  }
  for (std::size_t i = 0; i < foci; ++i) {
    for (std::size_t j = 0; j < foci; ++j) {
      r_re_[i * foci + j] /= squares_[j];
      r_im_[i * foci + j] /= squares_[j];
    }
  }
}

void TextbookGsPat::iterate(std::size_t foci, int iterations) {
  const auto apply = [&](const std::vector<float>& x_re, const std::vector<float>& x_im,
                         std::vector<float>& y_re, std::vector<float>& y_im) {
    for (std::size_t i = 0; i < foci; ++i) {
      float re = 0.0F, im = 0.0F;
      for (std::size_t j = 0; j < foci; ++j) {
        re += r_re_[i * foci + j] * x_re[j] - r_im_[i * foci + j] * x_im[j];
        im += r_re_[i * foci + j] * x_im[j] + r_im_[i * foci + j] * x_re[j];
      }
      y_re[i] = re;
      y_im[i] = im;
    }
  };
  const auto set_magnitudes = [&](std::vector<float>& re, std::vector<float>& im) {
    for (std::size_t i = 0; i < foci; ++i) {
      const float scale = a_[i] / std::sqrt(re[i] * re[i] + im[i] * im[i]);
      re[i] *= scale;
      im[i] *= scale;
    }
  };
  for (int k = 0; k < iterations; ++k) {
    apply(p_re_, p_im_, t_re_, t_im_);
    set_magnitudes(t_re_, t_im_);
    apply(t_re_, t_im_, p_re_, p_im_);
  }
  set_magnitudes(p_re_, p_im_);
}

void TextbookGsPat::solve(std::span<const Eigen::Vector3f> foci, std::span<const float> a,
                          int iterations) {
  const std::size_t count = foci.size();
  for (std::size_t m = 0; m < count; ++m) {
    propagate(foci[m], &g_re_[m * n_], &g_im_[m * n_]);
    float alone = 0.0F;
    for (std::size_t n = 0; n < n_; ++n) {
      alone +=
          std::sqrt(g_re_[m * n_ + n] * g_re_[m * n_ + n] + g_im_[m * n_ + n] * g_im_[m * n_ + n]);
    }
    p_re_[m] = a_[m] = a[m] * alone;
    p_im_[m] = 0.0F;
  }
  correlate(count);
  iterate(count, iterations);

  std::fill(q_re_.begin(), q_re_.end(), 0.0F);
  std::fill(q_im_.begin(), q_im_.end(), 0.0F);
  for (std::size_t m = 0; m < count; ++m) {
    const float re = p_re_[m] / squares_[m], im = p_im_[m] / squares_[m];
    for (std::size_t n = 0; n < n_; ++n) {
      q_re_[n] += g_re_[m * n_ + n] * re + g_im_[m * n_ + n] * im;
      q_im_[n] += g_re_[m * n_ + n] * im - g_im_[m * n_ + n] * re;
    }
  }
  float largest = 0.0F;
  for (std::size_t n = 0; n < n_; ++n) {
    largest = std::max(largest, q_re_[n] * q_re_[n] + q_im_[n] * q_im_[n]);
  }
  const float scale = 1.0F / std::sqrt(largest);
  for (std::size_t n = 0; n < n_; ++n) {
    q_re_[n] *= scale;
    q_im_[n] *= scale;
  }
}

}  // namespace prostm::bench
