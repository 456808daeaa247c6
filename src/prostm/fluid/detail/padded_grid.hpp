#pragma once
/// Storage of the fluid's fields: rows along x, padded so that stencils need no branches.

#include <algorithm>
#include <cstddef>
#include <memory>

namespace prostm::fluid {

using Index = std::ptrdiff_t;

/// n³ cells with one halo row and plane on each side. A row holds `width()` = n rounded up to 16
/// values and 16 more, which are the halo of its end and of the next row's start. Faces use the
/// same index: face i of the x-component lies between cells i−1 and i, so n+1 faces fit. Row starts
/// are aligned to 64 bytes.
struct PaddedGrid {
  static constexpr Index kLane = 16;  // floats of the widest vector
  // readable rows before the first and after the last: tiles reach beyond
  static constexpr Index kGuardRows = 6;

  int n = 0;

  Index width() const { return (n + kLane - 1) / kLane * kLane; }
  Index row() const { return width() + kLane; }    ///< distance of y-neighbours
  Index plane() const { return row() * (n + 2); }  ///< distance of z-neighbours
  Index stride(int axis) const { return axis == 0 ? 1 : axis == 1 ? row() : plane(); }
  Index index(Index i, Index j, Index k) const {
    return kGuardRows * row() + (k + 1) * plane() + (j + 1) * row() + i;
  }
  Index size() const { return 2 * kGuardRows * row() + plane() * (n + 2); }
};

/// Allocates memory for a field, aligned to 64 bytes at least. A large field gets pages of 2 MiB if
/// the system has them: stencils access so many planes of so many fields that with pages of 4 KiB
/// address translation costs 8 % of a step. @throws std::bad_alloc.
void* allocate_field(std::size_t bytes);
void free_field(void* memory, std::size_t bytes);

/// One value per cell or face of a padded grid.
template <class T>
class PaddedField {
 public:
  explicit PaddedField(const PaddedGrid& grid, T value = T{})
      : size_(grid.size()), data_(static_cast<T*>(allocate_field(bytes())), Free{bytes()}) {
    fill(value);
  }
  PaddedField(const PaddedField& other) = delete;
  PaddedField& operator=(const PaddedField&) = delete;
  PaddedField(PaddedField&&) noexcept = default;
  PaddedField& operator=(PaddedField&&) noexcept = default;

  T* data() { return data_.get(); }
  const T* data() const { return data_.get(); }
  T& operator[](Index i) { return data_[static_cast<std::size_t>(i)]; }
  const T& operator[](Index i) const { return data_[static_cast<std::size_t>(i)]; }
  void fill(T value) { std::fill_n(data_.get(), size_, value); }
  /// @pre same grid.
  void copy_from(const PaddedField& other) { std::copy_n(other.data(), size_, data()); }

 private:
  struct Free {
    std::size_t bytes = 0;
    void operator()(T* p) const { free_field(p, bytes); }
  };
  std::size_t bytes() const { return static_cast<std::size_t>(size_) * sizeof(T); }
  Index size_ = 0;
  std::unique_ptr<T[], Free> data_;
};

using Field = PaddedField<float>;

}  // namespace prostm::fluid
