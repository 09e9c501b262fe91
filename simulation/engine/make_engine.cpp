#include <algorithm>
#include <functional>

#include "common/error.hpp"
#include "simulation/engine/compressed_engine.hpp"
#include "simulation/engine/dense_engine.hpp"
#include "simulation/engine/modal_engine.hpp"
#include "simulation/engine/rigid_engine.hpp"
#include "simulation/engine/streamed_engine.hpp"

namespace irdm {

std::unique_ptr<ResponseEngine> make_engine(std::shared_ptr<const Model> model) {
  if (const auto* modal = std::get_if<ModalResponse>(&model->response)) {
    return std::visit(
        [&]<typename Scalar>(const RowMatrix<Scalar>&) -> std::unique_ptr<ResponseEngine> {
          return std::make_unique<ModalEngine<Scalar>>(std::move(model));
        },
        modal->shapes);
  }
  if (const auto* dense = std::get_if<DenseResponse>(&model->response)) {
    return std::visit(
        [&]<typename Scalar>(const std::vector<Scalar>&) -> std::unique_ptr<ResponseEngine> {
          return std::make_unique<DenseEngine<Scalar>>(std::move(model));
        },
        dense->values);
  }
  if (const auto* streamed = std::get_if<StreamedResponse>(&model->response)) {
    return std::visit(
        [&]<typename Scalar>(const std::vector<Scalar>&) -> std::unique_ptr<ResponseEngine> {
          return std::make_unique<StreamedEngine<Scalar>>(std::move(model));
        },
        streamed->first);
  }
  if (std::holds_alternative<CompressedResponse>(model->response)) {
    return std::make_unique<CompressedEngine>(std::move(model));
  }
  if (is_rigid(*model)) return std::make_unique<RigidEngine>(model->mesh.surface_node_count());
  throw Error("model", "holds no response", "make it again with irdm-precompute");
}

void displacements(std::span<SurfaceRequest> requests) {
  const auto shared = [](const SurfaceRequest& request) -> const void* {
    const auto* surface = dynamic_cast<const SharedSurface*>(request.engine);
    return surface == nullptr ? nullptr : surface->shared_surface();
  };
  std::stable_sort(requests.begin(), requests.end(), [&](const auto& a, const auto& b) {
    return std::less<>()(shared(a), shared(b));
  });
  while (!requests.empty()) {
    const void* const what = shared(requests.front());
    const auto other = std::find_if(requests.begin(), requests.end(),
                                    [&](const auto& request) { return shared(request) != what; });
    const auto count = static_cast<std::size_t>(other - requests.begin());
    if (what == nullptr) {
      for (const SurfaceRequest& one : requests.first(count)) {
        one.engine->displacement(*one.u, one.tolerance);
      }
    } else {
      dynamic_cast<const SharedSurface*>(requests.front().engine)
          ->displacements(requests.first(count));
    }
    requests = requests.subspan(count);
  }
}

}  // namespace irdm
