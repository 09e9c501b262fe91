// The lowest modes by SLEPc, on one rank and on two (ctest runs this program under mpirun too),
// against Spectra's. Only rank 0 has results to look at.
#include <algorithm>
#include <fstream>

#include "common/error.hpp"
#include "common/model/model_file.hpp"
#include "precompute/mesh/region.hpp"
#include "precompute/mesh/tet_mesh.hpp"
#include "precompute/modal/lowest_modes.hpp"
#include "precompute/modal/shared_modes.hpp"
#include "precompute/parallel/bisection_order.hpp"
#include "tests/precompute/discrete.hpp"
#include "tests/precompute/meshes.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/child_process.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::precompute;
using irdm::test::Discrete;

namespace {

const Material kMaterial{2000.0, 0.4, 110.0, 8.0, 2e-4};
const HalfSpace kLeft{Vector3::Zero(), Vector3(1, 0, 0)};

// MPI is started once in a process.
const Ranks& all_ranks() {
  static const Ranks ranks;
  return ranks;
}

// What rank 0 sees; the others help.
template <typename Look>
void share(const Discrete& body, const std::vector<int>& clamped, ModeSolver solver,
           const Look& look) {
  const auto shared =
      make_shared_modes(body.mesh, kMaterial, body.mass, clamped, solver, all_ranks());
  if (all_ranks().rank() > 0) return shared->help();
  look(*shared);
}

}  // namespace

TEST_CASE("SLEPc's modes are Spectra's, by either solver, free and fixed") {
  const Discrete body(test::box_mesh(Vector3(0.12, 0.08, 0.10), {5, 3, 4}), kMaterial);
  const std::vector<int> clamped =
      GENERATE_COPY(std::vector<int>{}, nodes_in(body.mesh, kLeft, "box"));
  const auto solver = GENERATE(ModeSolver::kSlepc, ModeSolver::kSlepcMultigrid);
  CAPTURE(clamped.size(), solver == ModeSolver::kSlepc);
  share(body, clamped, solver, [&](SharedModes& shared) {
    const ElasticStatics statics(body.stiffness, body.mesh.nodes, body.mass, clamped);
    for (const int count : {12, 20}) {
      const ElasticModes expected = lowest_modes(statics, count);
      const ElasticModes found = shared.lowest(count);
      const Eigen::VectorXd square = expected.angular_frequency.cwiseAbs2();
      CHECK((found.angular_frequency.cwiseAbs2() - square)
                .cwiseQuotient(square)
                .cwiseAbs()
                .maxCoeff() < 1e-8);
      // Orthonormal in the mass, and the same space: all of each one's norm is there.
      const Eigen::MatrixXd momentum = body.mass3.asDiagonal() * found.shapes;
      CHECK((found.shapes.transpose() * momentum - Eigen::MatrixXd::Identity(count, count)).norm() <
            1e-9);
      const Eigen::MatrixXd overlap = expected.shapes.transpose() * momentum;
      CHECK(overlap.colwise().squaredNorm().minCoeff() > 1.0 - 1e-8);
      if (clamped.empty()) CHECK((body.rigid.transpose() * momentum).cwiseAbs().maxCoeff() < 1e-10);
      for (const int node : clamped) CHECK(found.shapes.middleRows<3>(3 * node).isZero(0.0));
    }
  });
}

TEST_CASE("SLEPc's modes of quadratic elements are Spectra's") {
  const Discrete body(quadratic_mesh(test::box_mesh(Vector3(0.12, 0.08, 0.10), {2, 2, 2})),
                      kMaterial);
  share(body, {}, ModeSolver::kSlepc, [&](SharedModes& shared) {
    const ElasticStatics statics(body.stiffness, body.mesh.nodes, body.mass, {});
    const Eigen::VectorXd expected = lowest_modes(statics, 20).angular_frequency;
    const Eigen::VectorXd found = shared.lowest(20).angular_frequency;
    CHECK((found - expected).cwiseQuotient(expected).cwiseAbs().maxCoeff() < 1e-8);
  });
}

TEST_CASE("shared factors solve as those of one process do, and tell what is not definite") {
  const Discrete body(test::box_mesh(Vector3(0.12, 0.08, 0.10), {5, 3, 4}), kMaterial);
  const std::vector<int> clamped = nodes_in(body.mesh, kLeft, "box");
  share(body, clamped, ModeSolver::kSlepc, [&](SharedModes& shared) {
    const ElasticStatics alone(body.stiffness, body.mesh.nodes, body.mass, clamped);
    for (int round = 0; round < 2; ++round) {
      const ElasticStatics together(body.stiffness, body.mesh.nodes, body.mass, clamped,
                                    shared.solver());
      for (const int columns : {1, 7, 48}) {
        const Eigen::MatrixXd loads = Eigen::MatrixXd::Random(alone.degrees_of_freedom(), columns);
        const Eigen::MatrixXd expected = alone.displacement(loads);
        CHECK((together.displacement(loads) - expected).norm() < 1e-10 * expected.norm());
      }
      // In between, as where modes are chosen by an error.
      CHECK(shared.lowest(6).angular_frequency.size() == 6);
      const Eigen::MatrixXd load = Eigen::MatrixXd::Random(alone.degrees_of_freedom(), 2);
      CHECK((together.displacement(load) - alone.displacement(load)).norm() <
            1e-10 * alone.displacement(load).norm());
    }
    const auto solver = shared.solver();
    Eigen::SparseMatrix<double> turned = body.stiffness;
    turned.coeffRef(0, 0) = -1.0;
    CHECK_THROWS_WITH(solver->factorise(turned), ContainsSubstring("not positive definite"));
    const Eigen::SparseMatrix<double> unit = 2.0 * Eigen::MatrixXd::Identity(30, 30).sparseView();
    solver->factorise(unit);
    CHECK(solver->solve(Eigen::MatrixXd::Ones(30, 3)) == Eigen::MatrixXd::Constant(30, 3, 0.5));
  });
}

// MUMPS sums up what other ranks send in the order that it comes.
TEST_CASE("SLEPc gives the same every time, bit for bit on one rank") {
  const Discrete body(test::box_mesh(Vector3(0.12, 0.08, 0.10), {4, 3, 3}), kMaterial);
  std::vector<ElasticModes> twice;
  for (int i = 0; i < 2; ++i) {
    share(body, {}, ModeSolver::kSlepc,
          [&](SharedModes& shared) { twice.push_back(shared.lowest(12)); });
  }
  if (twice.empty()) return;
  const Eigen::VectorXd difference = twice[0].angular_frequency - twice[1].angular_frequency;
  CHECK(difference.cwiseQuotient(twice[0].angular_frequency).cwiseAbs().maxCoeff() < 1e-11);
  if (all_ranks().size() > 1) return;
  CHECK(twice[0].angular_frequency == twice[1].angular_frequency);
  CHECK(twice[0].shapes == twice[1].shapes);
}

TEST_CASE("what SLEPc cannot do is one error, and it goes on after it") {
  TetMesh mesh = test::together(test::box_mesh(Vector3::Constant(0.1), {2, 2, 2}),
                                test::box_mesh(Vector3::Constant(0.1), {2, 2, 2}));
  mesh.nodes.bottomRows(mesh.node_count() / 2).col(0).array() += 0.2;
  const Discrete two(mesh, kMaterial);
  share(two, {}, ModeSolver::kSlepc, [&](SharedModes& shared) {
    CHECK_THROWS_WITH(shared.lowest(8), ContainsSubstring("motions without elastic energy"));
    CHECK_THROWS_WITH(shared.lowest(100'000),
                      ContainsSubstring("SLEPc") && ContainsSubstring("solver"));
    CHECK_THROWS_WITH(shared.lowest(8), ContainsSubstring("motions without elastic energy"));
  });
}

TEST_CASE("an order by bisection has each point once, and halves that lie apart") {
  const TetMesh mesh = test::box_mesh(Vector3(0.3, 0.1, 0.1), {9, 3, 3});
  const std::vector<int> order = bisection_order(mesh.nodes);
  std::vector<int> sorted = order;
  std::sort(sorted.begin(), sorted.end());
  for (int i = 0; i < mesh.node_count(); ++i) CHECK(sorted[static_cast<std::size_t>(i)] == i);
  const auto half = static_cast<Eigen::Index>(order.size() / 2);
  const Eigen::VectorXd x = mesh.nodes.col(0)(order);
  CHECK(x.head(half).maxCoeff() <= x.tail(x.size() - half).minCoeff());
}

TEST_CASE("rows of the stiffness are those of the whole") {
  const Discrete body(test::box_mesh(Vector3(0.12, 0.08, 0.10), {3, 2, 2}), kMaterial);
  const RowSparseMatrix whole = body.stiffness;
  const RowSparseMatrix some = assemble_stiffness_rows(body.mesh, kMaterial, 5, 17);
  CHECK(some.rows() == 36);
  CHECK((Eigen::MatrixXd(some) - Eigen::MatrixXd(whole.middleRows(15, 36))).norm() <
        1e-12 * whole.norm());
}

// Not under mpirun itself.
TEST_CASE("two ranks make the model file of one process with Spectra", "[program]") {
  const irdm::test::TemporaryFolder folder;
  const auto run = [&](std::vector<std::string> command, const std::string& solver) {
    std::ofstream(folder.path() / (solver + ".toml"))
        << "[mesh]\nbox = { size = [0.12, 0.1, 0.08], cells = [6, 5, 4] }\norder = 1\n"
           "[material]\nyoungs_modulus = 2000\npoisson_ratio = 0.3\ndensity = 110\n"
           "[response]\nsteps = 40\nprecision = \"double\"\n[modes]\ncount = 20\nsolver = \""
        << solver << "\"\n";
    for (const std::string& word :
         {std::string(IRDM_PROGRAM), solver + ".toml", std::string("-o"), solver + ".h5"}) {
      command.push_back(word);
    }
    irdm::test::ChildProcess process(command, {.folder = folder.path()});
    const int status = process.wait();
    CAPTURE(solver, process.err());
    CHECK(status == 0);
    return read_model(folder.path() / (solver + ".h5"), ResponseKind::kModal);
  };
  const std::vector<std::string> two{
      IRDM_MPIRUN, "-n", "2", "--oversubscribe", "--bind-to", "none", "--allow-run-as-root"};
  const Model one_process = run({}, "spectra");
  const auto& expected = std::get<ModalResponse>(one_process.response);
  for (const char* solver : {"slepc", "slepc-multigrid"}) {
    const Model model = run(two, solver);
    const auto& found = std::get<ModalResponse>(model.response);
    CHECK((found.angular_frequency - expected.angular_frequency)
              .cwiseQuotient(expected.angular_frequency)
              .cwiseAbs()
              .maxCoeff() < 1e-8);
    CHECK(found.residual.reduction.force_error ==
          Approx(expected.residual.reduction.force_error).epsilon(1e-5));
    CHECK(found.residual.nodes == expected.residual.nodes);
  }
}
