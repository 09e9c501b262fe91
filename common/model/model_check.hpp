#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/error.hpp"
#include "common/model/model.hpp"

namespace irdm {

/// What is wrong with a model, its response left aside: numbers are finite and within
/// range.hpp, indices in range, elements not flat, the surface is closed and its triangles
/// face outward, masses are positive and add up, and the inertia is symmetric and positive
/// definite; a rigid body has a density and one step. Nothing when all of that holds.
std::optional<std::string> description_fault(const Model& model);

/// What a reader of dense R sees while the columns go by, in no more time than they take anyway:
/// every driving-point response, and some columns and steps of all. `irdm-precompute check` sees
/// more.
class DenseSamples {
 public:
  DenseSamples(int degrees_of_freedom, int steps);

  /// @param column [s][a] of column b, as in the file
  template <typename Scalar>
  void add(int b, const Scalar* column);

  /// After all columns: R(a, b) is R(b, a) in the samples, and what a force does to the place where
  /// it acts is along the force, in the first step and when it lasts. Nothing when that holds.
  std::optional<std::string> fault() const;

 private:
  int degrees_of_freedom_;
  int steps_;
  std::vector<int> sample_;       ///< degrees of freedom
  std::vector<int> step_sample_;  ///< steps
  std::vector<double> peak_;      ///< largest |R(b, b)| (3n) [m/N]
  std::vector<double> sum_;       ///< of R(b, b) over all steps (3n) [m/N]
  std::vector<double> first_;     ///< R(b, b) of the first step (3n) [m/N]
  Eigen::MatrixXd columns_;       ///< R(a, b) of samples b: (3n, samples * step samples)
  Eigen::MatrixXd rows_;          ///< R(b, a) of samples b, of all columns a, in the same order
};

/// What is wrong with the modes of a model whose description holds: frequencies that increase and
/// decay rates within range.hpp; shapes that can be mass-normalised and add up to a compliance
/// that a body can have; loads of spin and gravity that modes can feel, and that go with the body's
/// support. Nothing when all of that holds.
/// @param response its rows and columns fit the model
std::optional<std::string> modal_fault(const Model& model, const ModalResponse& response);

/// Throws Error about a model file that is not what docs/files.md says.
[[noreturn]] inline void refuse_model(const std::string& file, const std::string& what) {
  throw Error(file, what, "make the model again with irdm-precompute");
}

}  // namespace irdm
