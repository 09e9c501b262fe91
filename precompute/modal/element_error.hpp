#pragma once

#include <optional>
#include <string>

#include "common/model/model.hpp"
#include "precompute/mesh/tet_mesh.hpp"

namespace irdm::precompute {

/// The lowest elastic frequency of a free body, from its own elements and from finer ones.
struct ElementError {
  double frequency;        ///< [Hz], > 0
  double finer_frequency;  ///< [Hz], > 0

  /// Stiffness that the body's own elements give it, over that of finer ones.
  double stiffness_ratio() const {
    const double ratio = frequency / finer_frequency;
    return ratio * ratio;
  }
  /// Whether the frequency differs by more than a tenth.
  bool is_large() const;
};

/// Degrees of freedom up to which meshes are compared with finer ones: some ten seconds on one
/// core. 50 000 with CHOLMOD, 20 000 with Eigen's solver; the time grows with their square.
int most_finer_unknowns();

/// Compares the body's elements with quadratic ones that have half the distance between nodes, then
/// half of that and so on, until two agree within 5 % or the next would have more than
/// most_finer_unknowns() degrees of freedom. None: already the first would have more. Clamped nodes
/// are left free: the question is how well the elements bend. Throws Error when a lowest mode is
/// not found.
std::optional<ElementError> element_error(const TetMesh& mesh, const Material& material);

/// "about 17 % too stiff", "about 75 times too stiff", "about 8 % too soft".
/// @param ratio of the stiffness to the right one
std::string stiffness_text(double ratio);

/// What a person should see of element_error().
struct ElementReport {
  bool compared = false;               ///< an error was found
  std::string found;                   ///< both frequencies, or why they are not there
  std::optional<std::string> warning;  ///< estimate and remedy, where the error is large
};

/// Never throws Error: a body whose elements cannot be compared can be sound.
ElementReport report_elements(const TetMesh& mesh, const Material& material);

/// Stiffness under a fingertip of a cube of 12 linear cells an edge, over the right one. A fit of
/// the paper's cube: 1.09 at nu = 0.3, 1.17 at 0.45, 1.56 at 0.49.
double locking_ratio(double poisson_ratio);

/// Warning for linear tetrahedra of a Poisson's ratio of 0.45 or more, with the estimate of
/// locking_ratio(): they resist a change of volume by bending far more than the material does.
std::optional<std::string> locking_hint(int order, const Material& material);

}  // namespace irdm::precompute
