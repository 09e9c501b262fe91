// Every stored form of R against the same R in another form, and against the engine that plays it.

#include "common/model/model_file.hpp"
#include "common/response/compressed_response.hpp"
#include "common/response/stored_response.hpp"
#include "simulation/engine/response_engine.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/point_loads.hpp"
#include "tests/support/shared_model.hpp"
#include "tests/support/streamed_model.hpp"
#include "tests/support/synthetic_model.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

constexpr int kStoredSteps = 60;

double difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return (a - b).norm() / b.norm();
}

// Loads over several nodes, and on one degree of freedom, yield as the columns of those say.
void check_compliance(const StoredResponse& R, int nodes) {
  Eigen::SparseMatrix<double> loads(3 * nodes, 2);
  for (int b = 3; b < 3 * nodes; b += 4) loads.insert(b, 0) = std::sin(b);
  loads.insert(3, 1) = 2.0;
  const Eigen::VectorXd yielding = R.static_compliance(loads);
  REQUIRE(yielding.size() == 2);
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(2);
  for (int b = 0; b < 3 * nodes; ++b) {
    const Eigen::VectorXd column = R.static_column(b);
    for (int a = 0; a < 2; ++a) expected(a) += loads.coeff(b, a) * loads.col(a).dot(column);
  }
  CHECK(difference(yielding, expected) < 1e-10);
}

// What the members say of one another, whatever the form. `limit`: also the static limit is that of
// these steps.
void check_consistent(const StoredResponse& R, int nodes, int steps, bool limit) {
  const Eigen::MatrixXd first = R.zero_lag();
  REQUIRE(first.rows() == 3 * nodes);
  const std::vector<DrivingPoint> own = R.driving_points(1, nodes - 2, steps);
  REQUIRE(static_cast<int>(own.size()) == nodes - 2);
  check_compliance(R, nodes);
  const Eigen::MatrixXd static_limit = R.static_limit();
  for (const int b : {3, 3 * nodes - 4}) {
    CAPTURE(b);
    const RowMatrix<double> column = R.column(b, steps);
    REQUIRE(column.rows() == steps);
    CHECK(difference(column.row(0), first.col(b).transpose()) < 1e-12);
    CHECK(difference(R.column(b, steps / 2), column.topRows(steps / 2)) < 1e-12);
    const int node = b / 3;
    const Eigen::MatrixXd rows = own[static_cast<std::size_t>(node - 1)].middleRows<3>(3 * (b % 3));
    CHECK(difference(rows.transpose(), column.middleCols<3>(3 * node)) < 1e-10);
    const Eigen::VectorXd settled = R.static_column(b);
    CHECK(difference(static_limit.col(b), settled) < 1e-10);
    if (limit) CHECK(difference(column.colwise().sum().transpose(), settled) < 1e-6);
  }
}

}  // namespace

TEST_CASE("stored response: modes, with and without residual, are the R of the closed form") {
  Model modal = synthetic_cube(2, 12, kStoredSteps);
  if (GENERATE(false, true)) add_residual(modal);
  const Model dense = with_dense_response<double>(modal);
  const auto of_modes = stored_response(modal);
  const auto of_dense = stored_response(dense);
  const int nodes = modal.mesh.surface_node_count();
  check_consistent(*of_modes, nodes, kStoredSteps, false);
  check_consistent(*of_dense, nodes, kStoredSteps, true);
  CHECK(difference(of_modes->zero_lag(), of_dense->zero_lag()) < 1e-12);
  for (int b = 0; b < 3 * nodes; b += 7) {
    CHECK(difference(of_modes->column(b, kStoredSteps), of_dense->column(b, kStoredSteps)) < 1e-11);
  }
}

TEST_CASE("stored response: the static limit of modes is the sum over all time") {
  Model modal = synthetic_cube(2, 12, 4000);
  add_residual(modal);
  const int nodes = modal.mesh.surface_node_count();
  check_consistent(*stored_response(modal), nodes, 4000, true);
  auto& shapes = std::get<ModalResponse>(modal.response).shapes;
  const Eigen::VectorXd in_double = stored_response(modal)->static_column(4);
  shapes = RowMatrix<float>(std::get<RowMatrix<double>>(shapes).cast<float>());
  check_consistent(*stored_response(modal), nodes, kStoredSteps, false);
  CHECK(difference(stored_response(modal)->static_column(4), in_double) < 1e-6);
}

TEST_CASE("stored response: dense in a file and streamed are the dense one in memory") {
  const StreamedModel model(with_dense_response<float>(synthetic_cube(2, 12, kStoredSteps)));
  const int nodes = model.dense->mesh.surface_node_count();
  const auto dense = stored_response(*model.dense);
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "dense.h5";
  write_dense_model(*model.dense, path);
  const auto file = stored_response(path, 3 * nodes, kStoredSteps);
  const auto streamed = stored_response(*model.streamed);
  check_consistent(*file, nodes, kStoredSteps, true);
  check_consistent(*streamed, nodes, kStoredSteps, true);
  CHECK(file->zero_lag() == dense->zero_lag());
  CHECK(streamed->zero_lag() == dense->zero_lag());
  CHECK(file->column(7, kStoredSteps) == dense->column(7, kStoredSteps));
  CHECK(difference(streamed->static_column(7), dense->static_column(7)) < 1e-6);
  CHECK_THROWS_WITH(stored_response(path, 3 * nodes, kStoredSteps - 1),
                    Catch::Matchers::ContainsSubstring("must have the shape"));
}

TEST_CASE("stored response: a compressed one is what its engine plays") {
  Model model = synthetic_cube(2, 12, kStoredSteps);
  model.response = compressed_response(model);
  const int nodes = model.mesh.surface_node_count();
  const auto R = stored_response(model);
  check_consistent(*R, nodes, 3000, true);
  const auto engine = make_engine(share(model));
  const NodalForce push{0, Vector3(1, 0, 0)};
  const RowMatrix<double> column = R->column(0, kStoredSteps);
  REQUIRE(column.row(kStoredSteps / 2).norm() > 0.0);
  for (int s = 0; s < kStoredSteps; ++s) {
    engine->advance(s == 0 ? std::span(&push, 1) : std::span<const NodalForce>());
    Points u;
    engine->displacement(u);
    const Eigen::Map<const Eigen::VectorXd> moved(u.data(), u.size());
    CHECK((moved - column.row(s).transpose()).norm() < 1e-6 * column.norm());
  }
}

TEST_CASE("static compliance of a model without a response is not a number") {
  Model model = synthetic_cube(2, 12, kStoredSteps);
  model.response = std::monostate{};
  const std::vector<Vector3> up(static_cast<std::size_t>(model.mesh.surface_node_count()),
                                Vector3::UnitY());
  const Eigen::VectorXd compliance = static_compliance(model, test::point_loads(up));
  REQUIRE(compliance.size() == model.mesh.surface_node_count());
  CHECK(compliance.array().isNaN().all());
}
