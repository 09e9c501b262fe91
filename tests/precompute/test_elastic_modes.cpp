#include "common/error.hpp"
#include "precompute/mesh/surface.hpp"
#include "precompute/modal/elastic_modes.hpp"
#include "precompute/modal/elastic_statics.hpp"
#include "precompute/modal/lowest_modes.hpp"
#include "tests/precompute/discrete.hpp"
#include "tests/precompute/meshes.hpp"
#include "tests/support/catch.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::precompute;
using irdm::test::Discrete;
using irdm::test::inertia_relief;
using irdm::test::lowest_eigenvalues;
using irdm::test::lowest_frequency;
using irdm::test::node_at;

namespace {

const Material kModesMaterial{2000.0, 0.49, 110.0, 8.0, 2e-4};

Discrete small_box() {
  return Discrete(test::box_mesh(Vector3(0.12, 0.08, 0.10), {4, 3, 3}), kModesMaterial);
}

}  // namespace

TEST_CASE("symmetric eigensolver gives all pairs in order") {
  std::srand(1);
  Eigen::MatrixXd a = Eigen::MatrixXd::Random(40, 40);
  a = Eigen::MatrixXd(a + a.transpose());
  const EigenPairs pairs = symmetric_eigen(a);
  CHECK((a * pairs.vectors - pairs.vectors * pairs.values.asDiagonal()).norm() < 1e-12);
  CHECK((pairs.vectors.transpose() * pairs.vectors - Eigen::MatrixXd::Identity(40, 40)).norm() <
        1e-12);
  CHECK(std::is_sorted(pairs.values.begin(), pairs.values.end()));
}

TEST_CASE("a free body has six eigenvalues that are zero to rounding") {
  const Discrete body = small_box();
  const Eigen::VectorXd inverse_root = body.mass3.cwiseSqrt().cwiseInverse();
  const SparseMatrix scaled =
      inverse_root.asDiagonal() * body.stiffness * inverse_root.asDiagonal();
  const EigenPairs pairs = symmetric_eigen(Eigen::MatrixXd(scaled));
  const double largest = pairs.values.maxCoeff();
  CHECK(pairs.values.head(6).cwiseAbs().maxCoeff() < 1e-14 * largest);
  CHECK(pairs.values(6) > 1e-6 * largest);
}

TEST_CASE("elastic modes are mass-normalised eigenvectors and carry no momentum") {
  const Discrete body = small_box();
  const ElasticModes modes = elastic_modes(body.stiffness, body.mesh.nodes, body.mass);
  const Eigen::Index r = 3 * body.mesh.node_count() - 6;
  REQUIRE(modes.angular_frequency.size() == r);
  CHECK(modes.angular_frequency.minCoeff() > 0);
  const Eigen::MatrixXd momentum = body.mass3.asDiagonal() * modes.shapes;
  CHECK((modes.shapes.transpose() * momentum - Eigen::MatrixXd::Identity(r, r)).norm() < 1e-11);
  const Eigen::MatrixXd residual =
      body.stiffness * modes.shapes - momentum * modes.angular_frequency.cwiseAbs2().asDiagonal();
  CHECK(residual.norm() < 1e-12 * (body.stiffness * modes.shapes).norm());

  // Linear momentum sum m u and angular momentum sum m X x u of every mode.
  Eigen::MatrixXd linear = Eigen::MatrixXd::Zero(3, r);
  Eigen::MatrixXd angular = Eigen::MatrixXd::Zero(3, r);
  for (int i = 0; i < body.mesh.node_count(); ++i) {
    linear += momentum.middleRows<3>(3 * i);
    angular += skew(body.mesh.position(i)) * momentum.middleRows<3>(3 * i);
  }
  const double scale = momentum.colwise().lpNorm<1>().maxCoeff();
  CHECK(linear.cwiseAbs().maxCoeff() < 1e-13 * scale);
  CHECK(angular.cwiseAbs().maxCoeff() < 1e-13 * scale * 0.12);
}

TEST_CASE("static limit of R is the answer of an independent inertia-relief solve") {
  const Discrete body = small_box();
  const ElasticModes modes = elastic_modes(body.stiffness, body.mesh.nodes, body.mass);
  const Surface surface = extract_surface(body.mesh, "box");
  const ModalResponse response = modal_response(modes, surface.nodes, kModesMaterial);
  const auto& phi = std::get<RowMatrix<double>>(response.shapes);
  const Eigen::VectorXd compliance = response.angular_frequency.cwiseAbs2().cwiseInverse();
  for (const int b : {0, 7, 50, 3 * static_cast<int>(surface.nodes.size()) - 1}) {
    const Eigen::VectorXd modal = phi * (compliance.asDiagonal() * phi.row(b).transpose());
    Eigen::VectorXd force = Eigen::VectorXd::Zero(body.mass3.size());
    force(3 * surface.nodes[static_cast<std::size_t>(b / 3)] + b % 3) = 1.0;
    const Eigen::VectorXd all = inertia_relief(body, force, node_at(body.mesh, Vector3(0, 0, 0)),
                                               node_at(body.mesh, Vector3(0.12, 0, 0)),
                                               node_at(body.mesh, Vector3(0, 0.08, 0)));
    Eigen::VectorXd direct(modal.size());
    for (std::size_t i = 0; i < surface.nodes.size(); ++i) {
      direct.segment<3>(static_cast<Eigen::Index>(3 * i)) = all.segment<3>(3 * surface.nodes[i]);
    }
    CHECK((modal - direct).norm() < 1e-6 * direct.norm());
  }
}

TEST_CASE("decay rates are those of Rayleigh damping") {
  ElasticModes modes;
  modes.angular_frequency = Eigen::Vector2d(10.0, 100.0);
  modes.shapes = Eigen::MatrixXd::Random(6, 2);
  const ModalResponse response = modal_response(modes, {1}, kModesMaterial);
  CHECK(response.decay_rate(0) == Approx(0.5 * (8.0 + 2e-4 * 100.0)));
  CHECK(response.decay_rate(1) == Approx(0.5 * (8.0 + 2e-4 * 10000.0)));
  CHECK(std::get<RowMatrix<double>>(response.shapes) == modes.shapes.bottomRows(3));
}

TEST_CASE("bodies with more than six modes without energy are refused") {
  // Two tetrahedra that hang on one edge swing about it.
  TetMesh mesh = test::one_tet();
  mesh.nodes.conservativeResize(6, 3);
  mesh.nodes.row(4) << -1, 0, 0;
  mesh.nodes.row(5) << 0, -1, 0;
  mesh.tets.conservativeResize(2, 4);
  mesh.tets.row(1) << 0, 4, 5, 3;
  const Discrete body(mesh, kModesMaterial);
  CHECK_THROWS_WITH(elastic_modes(body.stiffness, body.mesh.nodes, body.mass),
                    ContainsSubstring("7 modes without elastic energy"));
}

// A flat tetrahedron on a face of a box, whose apex lies `height` above the middle of the face.
TetMesh with_flat_tet(const TetMesh& box, double height) {
  TetMesh mesh = box;
  const Triangles surface = boundary_faces(box, "box");
  const Vector3 a = box.position(surface(0, 0));
  const Vector3 b = box.position(surface(0, 1));
  const Vector3 c = box.position(surface(0, 2));
  const Vector3 apex = (a + b + c) / 3.0 + height * (b - a).cross(c - a).normalized();
  mesh.nodes.conservativeResize(box.node_count() + 1, 3);
  mesh.nodes.row(box.node_count()) = apex.transpose();
  mesh.tets.conservativeResize(box.tet_count() + 1, 4);
  mesh.tets.row(box.tet_count()) << surface(0, 0), surface(0, 1), surface(0, 2), box.node_count();
  return mesh;
}

TEST_CASE("a tetrahedron a hundred-thousandth as high as the body changes no frequency") {
  const TetMesh box = test::box_mesh(Vector3::Constant(0.1), {2, 2, 2});
  const double height = GENERATE(1e-6, 5e-7);
  CAPTURE(height);
  const Discrete sound(box, kModesMaterial);
  const Discrete flat(with_flat_tet(box, height), kModesMaterial);
  const Eigen::VectorXd expected =
      elastic_modes(sound.stiffness, sound.mesh.nodes, sound.mass).angular_frequency;
  const ElasticModes all = elastic_modes(flat.stiffness, flat.mesh.nodes, flat.mass);
  const ElasticModes lowest =
      lowest_modes(ElasticStatics(flat.stiffness, flat.mesh.nodes, flat.mass, {}), 6);
  for (int i = 0; i < 6; ++i) {
    CAPTURE(i);
    CHECK(all.angular_frequency(i) == Approx(expected(i)).epsilon(1e-3));
    CHECK(lowest.angular_frequency(i) == Approx(expected(i)).epsilon(1e-4));
  }
}

TEST_CASE("lowest elastic frequency of the paper's cube is 10.7 Hz", "[slow]") {
  const Discrete body(test::box_mesh(Vector3(0.12, 0.12, 0.12), {12, 12, 12}), kModesMaterial);
  CHECK(lowest_frequency(body, 1000.0) == Approx(10.7).margin(0.2));
}

TEST_CASE("dense solver finds the lowest modes that subspace iteration finds") {
  const Discrete body = small_box();
  const Eigen::VectorXd reference = lowest_eigenvalues(body, 1000.0, 16, 40);
  const ElasticModes modes = elastic_modes(body.stiffness, body.mesh.nodes, body.mass);
  for (int i = 0; i < 6; ++i) {
    CHECK(std::pow(modes.angular_frequency(i), 2) == Approx(reference(i)).epsilon(1e-9));
  }
}
