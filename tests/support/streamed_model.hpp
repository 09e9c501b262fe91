#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "common/model/model.hpp"

namespace irdm::test {

/// Writes a model with a DenseResponse as irdm-precompute would.
void write_dense_model(const Model& dense, const std::filesystem::path& path);

/// The columns of a dense model, there when a test says so. One thread.
class ScriptedSupply final : public ColumnSupply {
 public:
  explicit ScriptedSupply(const DenseResponse& response);

  std::function<bool(int node)> there = [](int) { return true; };
  int most = 1 << 20;  ///< share()

  const void* acquire(int node) noexcept override;
  void release(int node) noexcept override { --taken_[static_cast<std::size_t>(node)]; }
  int share() const noexcept override { return most; }
  void prefetch(std::span<const Vector3> tips) noexcept override { tips_ = tips.size(); }

  /// How often the columns of a node are taken now; of all nodes.
  int taken(int node) const { return taken_[static_cast<std::size_t>(node)]; }
  int taken() const;
  std::size_t tips() const { return tips_; }

 private:
  std::variant<std::vector<float>, std::vector<double>> values_;
  std::size_t node_numbers_;
  std::vector<int> taken_;
  std::size_t tips_ = 0;
};

/// A dense model and the same one streamed, read from a file.
struct StreamedModel {
  explicit StreamedModel(Model model);

  std::shared_ptr<const Model> dense;
  std::shared_ptr<ScriptedSupply> supply;
  std::shared_ptr<const Model> streamed;
};

}  // namespace irdm::test
