#pragma once

#include <array>
#include <boost/align/aligned_allocator.hpp>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace irdm {

/// Numbers of which the first begins a line of the cache, so that no wide register has to be filled
/// from two of them: that is up to half of the time of a kernel. (Of several rows the others begin
/// one, too, if a row has a multiple of eight numbers.)
using AlignedNumbers = std::vector<double, boost::alignment::aligned_allocator<double, 64>>;

// Inner loops of the response engines, compiled for several instruction sets of which the best is
// chosen at start-up. Sums run over eight lanes in a fixed order and products are never
// contracted, so that equal inputs give equal bits on every processor and with any number of
// threads. Real-time safe. Not for initialisers of static objects: the choice is one itself.

/// sum_i a[i] b[i], in double precision.
double dot(const float* a, const double* b, std::size_t n) noexcept;
double dot(const double* a, const double* b, std::size_t n) noexcept;
double dot(const std::int16_t* a, const double* b, std::size_t n) noexcept;

/// sum_i |a[i]| |b[i]|.
double dot_magnitudes(const double* a, const double* b, std::size_t n) noexcept;

/// y[r] += weight (row r, x) for rows r = 0..count-1 of n numbers each, `stride` numbers apart:
/// each product as dot() computes it, but several rows at a time and with what comes next fetched
/// ahead, so that rows which follow one another are read at the speed of memory.
template <typename Scalar>
struct Rows {
  const Scalar* first;
  std::size_t stride;
  std::size_t count;
};
void add_products(const Rows<float>& rows, const double* x, std::size_t n, double weight,
                  double* y) noexcept;
void add_products(const Rows<double>& rows, const double* x, std::size_t n, double weight,
                  double* y) noexcept;

/// What forces of before do to a node over some steps: for its rows r = 0..2 and m = 0 to
/// kStepsAhead - 1, y[r][m] += weight sum_i row_r[m + i] x[i], rows being 0 beyond the numbers that
/// are known. Each is read from memory once for all m.
inline constexpr std::size_t kStepsAhead = 16;
template <typename Scalar>
struct NodeRows {
  const Scalar* first;
  std::size_t stride;
  std::size_t known;
};
void add_ahead(const NodeRows<float>& rows, std::span<const double> x, double weight,
               const std::array<double*, 3>& y) noexcept;
void add_ahead(const NodeRows<double>& rows, std::span<const double> x, double weight,
               const std::array<double*, 3>& y) noexcept;

/// What a force on a node does to another, or to itself, over some steps: y[r][i] += sum over axes
/// c of force[c] a[r][c][i], i < n, a being 0 beyond the numbers that are known. Up to the next
/// multiple of eight y is written, too, and what stands there means nothing.
template <typename Scalar>
struct NodeColumns {
  const Scalar* first;
  std::size_t row;     ///< numbers from a row to the next
  std::size_t column;  ///< and from a column to the next
  std::size_t known;
};
void add_effect(const NodeColumns<float>& columns, const std::array<double, 3>& force,
                const std::array<double*, 3>& y, std::size_t n) noexcept;
void add_effect(const NodeColumns<double>& columns, const std::array<double, 3>& force,
                const std::array<double*, 3>& y, std::size_t n) noexcept;

template <std::size_t K>
using Sums = std::array<double, K>;
/// The products of a with each of the rows of b, (3, n) or (6, n): a is read once for all of them.
Sums<3> dot_three(const double* a, const double* b, std::size_t n) noexcept;
Sums<6> dot_six(const double* a, const double* b, std::size_t n) noexcept;

/// Of three rows a (3, n): first their products with x, then sum_i a[j][i] w[i] a[k][i] for (j, k)
/// = (0, 0), (1, 0), (1, 1), (2, 0), (2, 1), (2, 2). All of it is read once.
Sums<9> moments(const double* a, const double* w, const double* x, std::size_t n) noexcept;
/// sum_i a[j][i] w[i] b[k][i] of two times three rows, row after row.
Sums<9> cross_moments(const double* a, const double* b, const double* w, std::size_t n) noexcept;

/// y[i] += sum over nine rows of w[k] a[k][i].
void accumulate_nine(const std::array<double, 9>& w, const std::array<const float*, 9>& a,
                     double* y, std::size_t n) noexcept;
void accumulate_nine(const std::array<double, 9>& w, const std::array<const double*, 9>& a,
                     double* y, std::size_t n) noexcept;

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

/// Whether a[i] = factor b[i] for all i, but for a few roundings (2^-50) of the largest |a[i]|.
bool is_multiple(const double* a, double factor, const double* b, std::size_t n) noexcept;

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

/// The same after a force that was held during the step before: q[i] += b1[i] f[i],
/// v[i] += b2[i] f[i], and then the transition.
struct HeldForce {
  const double* b1;
  const double* b2;
  const double* f;
};
void push_and_transit(const Transitions& A, const HeldForce& push, double* q, double* v,
                      double* next_q, double* next_v, std::size_t n) noexcept;

}  // namespace irdm
