#pragma once

#include <array>
#include <cstddef>

/// Inner loops of the response engines, compiled for several instruction sets of which the best is
/// chosen at start-up. Sums run over eight lanes in a fixed order and products are never
/// contracted, so that equal inputs give equal bits on every processor and with any number of
/// threads. Real-time safe.
namespace irdm {

/// sum_i a[i] b[i], in double precision.
double dot(const float* a, const double* b, std::size_t n) noexcept;
double dot(const double* a, const double* b, std::size_t n) noexcept;

template <std::size_t K>
using Sums = std::array<double, K>;
/// The same with each of the rows of b, (3, n) or (6, n): a is read once for all of them.
Sums<3> dot_three(const double* a, const double* b, std::size_t n) noexcept;
Sums<6> dot_six(const double* a, const double* b, std::size_t n) noexcept;

/// y[i] = w[0] a[i] + w[1] b[i] + w[2] c[i].
void combine(const std::array<double, 3>& w, const float* a, const float* b, const float* c,
             double* y, std::size_t n) noexcept;
void combine(const std::array<double, 3>& w, const double* a, const double* b, const double* c,
             double* y, std::size_t n) noexcept;

/// y[i] += w[0] a[i] + w[1] b[i] + w[2] c[i].
void accumulate(const std::array<double, 3>& w, const float* a, const float* b, const float* c,
                double* y, std::size_t n) noexcept;
void accumulate(const std::array<double, 3>& w, const double* a, const double* b, const double* c,
                double* y, std::size_t n) noexcept;

/// y[i] = a[i] b[i].
void multiply(const double* a, const double* b, double* y, std::size_t n) noexcept;

/// Exact transition of n oscillators over one step: (q, v) becomes A (q, v), with A = (a11 a12; a21
/// a22) for each; what is smaller than 1e-100 becomes 0, because a decaying mode would end in
/// denormal numbers, which cost a hundred times as much to compute with. May be done in place.
struct Transitions {
  const double* a11;
  const double* a12;
  const double* a21;
  const double* a22;
};
void transit(const Transitions& A, const double* q, const double* v, double* next_q, double* next_v,
             std::size_t n) noexcept;

}  // namespace irdm
