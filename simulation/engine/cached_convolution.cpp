#include "simulation/engine/cached_convolution.hpp"

#include "simulation/engine/pinned_columns.hpp"

namespace irdm {

template <typename Columns>
CachedConvolution<Columns>::CachedConvolution(Columns& columns, int sources)
    : columns_(columns),
      history_(sources, static_cast<int>(columns.frame().steps)),
      stepped_(columns),
      horizon_cache_(columns) {}

// As the step to come is asked for once this one has ended, the one after next is the coming one.
template <typename Columns>
void CachedConvolution<Columns>::cache_node(int node) noexcept {
  stepped_.cache_node(history_, node, 2);
}

template <typename Columns>
void CachedConvolution<Columns>::add_coming(int node, Vector3& u) const noexcept {
  if (!stepped_.add_coming(node, 1, u)) columns_.convolve(history_, node, 1, u);
}

template <typename Columns>
void CachedConvolution<Columns>::predict_horizon(int node, int n) noexcept {
  horizon_cache_.cache_node(history_, node, n);
}

template <typename Columns>
void CachedConvolution<Columns>::add_ahead(int node, int n, Vector3& u) const noexcept {
  if (!horizon_cache_.add_coming(node, n, u)) columns_.convolve(history_, node, n, u);
}

template <typename Columns>
void CachedConvolution<Columns>::push(std::span<const NodalForce> forces) noexcept {
  history_.push(forces);
  if (columns_.update(history_)) keep_nothing();
  stepped_.push(forces);
  horizon_cache_.push(forces);
}

template <typename Columns>
void CachedConvolution<Columns>::add_delayed_force(std::span<const NodalForce> forces,
                                                   int age) noexcept {
  if (!history_.add_delayed_force(forces, age)) return;
  if (columns_.update(history_)) keep_nothing();
  stepped_.add_delayed_force(forces, age);
  horizon_cache_.add_delayed_force(forces, age);
}

template <typename Columns>
void CachedConvolution<Columns>::clear() noexcept {
  history_.clear();
  keep_nothing();
}

template <typename Columns>
void CachedConvolution<Columns>::keep_nothing() noexcept {
  stepped_.clear();
  horizon_cache_.clear();
}

template class CachedConvolution<ResidentColumns<float>>;
template class CachedConvolution<ResidentColumns<double>>;
template class CachedConvolution<PinnedColumns<float>>;
template class CachedConvolution<PinnedColumns<double>>;

}  // namespace irdm
