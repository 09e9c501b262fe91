#include "precompute/modal/element_error.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string_view>
#include <utility>
#include <vector>

#include "common/error.hpp"
#include "precompute/dynamics/sparse_solver.hpp"
#include "precompute/fem/assembly.hpp"
#include "precompute/modal/elastic_statics.hpp"
#include "precompute/modal/lowest_modes.hpp"

namespace irdm::precompute {
namespace {

constexpr double kLargeError = 0.1;  // of the lowest frequency
constexpr double kAgreement = 0.05;  // of two meshes' lowest frequencies
constexpr double kLockingPoissonRatio = 0.45;

double lowest_frequency(const TetMesh& mesh, const Material& material) {
  const ElasticStatics statics(assemble_stiffness(mesh, material), mesh.nodes,
                               lumped_mass(mesh, material), {});
  return lowest_modes(statics, 1).angular_frequency(0) / (2.0 * std::numbers::pi);
}

// A tetrahedron's eight children have its material.
void split_values(std::vector<double>& values) {
  std::vector<double> split;
  split.reserve(8 * values.size());
  for (const double value : values) split.insert(split.end(), 8, value);
  values = std::move(split);
}

// Halves the distance between nodes; the elements become quadratic.
void refine(TetMesh& mesh, ElementMaterials& elements) {
  if (mesh.order() == 2) {
    mesh = split_mesh(mesh);
    split_values(elements.youngs_modulus);
    split_values(elements.poisson_ratio);
    split_values(elements.density);
  }
  mesh = quadratic_mesh(mesh);
}

double largest_poisson_ratio(const Material& material) {
  const std::vector<double>& own = material.elements.poisson_ratio;
  return own.empty() ? material.poisson_ratio : std::ranges::max(own);
}

// Two digits are all that an estimate has.
std::string number(double value) {
  const double unit = value >= 10.0 ? std::pow(10.0, std::floor(std::log10(value)) - 1.0) : 0.1;
  char text[32];
  std::snprintf(text, sizeof text, "%.12g", unit * std::round(value / unit));
  return text;
}

}  // namespace

int most_finer_unknowns() {
  return std::string_view(sparse_solver_name()) == "CHOLMOD" ? 50'000 : 20'000;
}

bool ElementError::is_large() const {
  return std::abs(frequency / finer_frequency - 1.0) > kLargeError;
}

std::optional<ElementError> element_error(const TetMesh& mesh, const Material& material) {
  // The finer mesh has at least four times the nodes.
  if (4 * 3 * mesh.node_count() > most_finer_unknowns()) return std::nullopt;
  TetMesh finer = mesh;
  Material finer_material = material;
  refine(finer, finer_material.elements);
  if (3 * finer.node_count() > most_finer_unknowns()) return std::nullopt;
  ElementError error{lowest_frequency(mesh, material), lowest_frequency(finer, finer_material)};
  for (double coarse = error.frequency;
       std::abs(coarse / error.finer_frequency - 1.0) > kAgreement;) {
    refine(finer, finer_material.elements);
    if (3 * finer.node_count() > most_finer_unknowns()) break;
    coarse = error.finer_frequency;
    error.finer_frequency = lowest_frequency(finer, finer_material);
  }
  return error;
}

std::string stiffness_text(double ratio) {
  if (ratio >= 2.0) return "about " + number(ratio) + " times too stiff";
  if (ratio <= 0.5) return "about " + number(1.0 / ratio) + " times too soft";
  return "about " + number(100.0 * std::abs(ratio - 1.0)) + " % too " +
         (ratio > 1.0 ? "stiff" : "soft");
}

double locking_ratio(double poisson_ratio) {
  return 1.0705 + 0.0098 / (1.0 - 2.0 * poisson_ratio);
}

std::optional<std::string> locking_hint(int order, const Material& material) {
  const double nu = largest_poisson_ratio(material);
  if (order != 1 || nu < kLockingPoissonRatio) return std::nullopt;
  char text[192];
  std::snprintf(text, sizeof text,
                "linear tetrahedra lock at Poisson's ratio %.4g: a cube with 12 of them an edge is "
                "%s under a fingertip; set mesh.order = 2, with half the cells",
                nu, stiffness_text(locking_ratio(nu)).c_str());
  return text;
}

ElementReport report_elements(const TetMesh& mesh, const Material& material) {
  std::optional<ElementError> error;
  try {
    error = element_error(mesh, material);
  } catch (const Error& fault) {
    return {false, std::string("not compared with finer ones: ") + fault.what(), std::nullopt};
  }
  if (!error) {
    return {false,
            "not compared with finer ones, which would have more than " +
                std::to_string(most_finer_unknowns()) + " unknowns",
            std::nullopt};
  }
  char text[128];
  std::snprintf(text, sizeof text,
                "lowest frequency of the free body %.4g Hz, with finer elements %.4g Hz",
                error->frequency, error->finer_frequency);
  ElementReport report{true, text, std::nullopt};
  if (error->is_large()) {
    report.warning =
        report.found + ": the elements make it " + stiffness_text(error->stiffness_ratio()) + "; " +
        (mesh.order() == 1 ? "set mesh.order = 2" : "use smaller ones (cells, mesh.edge_length)");
  }
  return report;
}

}  // namespace irdm::precompute
