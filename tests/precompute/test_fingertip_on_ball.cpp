// What the default fingertip feels on one ball, as different meshes have it: by static finite
// elements of the whole mesh, without modes, responses or steps.

#include "precompute/mesh/make_mesh.hpp"
#include "precompute/mesh/surface.hpp"
#include "precompute/modal/elastic_statics.hpp"
#include "simulation/contact/fingertip_loads.hpp"
#include "simulation/step/default_fingertip.hpp"
#include "tests/precompute/discrete.hpp"
#include "tests/precompute/mesh_files.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using namespace irdm::precompute;
using irdm::test::Discrete;

namespace {

constexpr double kFeltBall = 0.05;  // m

/// A ball of linear or of curved quadratic elements, by the program gmsh.
class Ball {
 public:
  Ball(int order, double edge_length, double poisson_ratio)
      : body_(mesh_of(order, edge_length), {3000.0, poisson_ratio, 1000.0, 0.0, 0.0}) {
    const Surface surface = extract_surface(body_.mesh, "ball");
    auto model = std::make_shared<Model>();
    model->mesh.nodes = body_.mesh.nodes;
    model->mesh.surface_nodes = surface.nodes;
    model->mesh.triangles = surface.triangles;
    model_ = model;
  }

  int nodes() const { return model_->mesh.surface_node_count(); }
  double default_radius() const {
    SimulationConfig config;
    config.objects.emplace_back().model = model_;
    return default_fingertip(config);
  }

  /// Of some 50 nodes, along their normals, by loads that inertia balances [m/N].
  Eigen::ArrayXd compliance(double radius) const {
    constexpr int kAsked = 50;
    const Eigen::SparseMatrix<double> loads = fingertip_loads(RestSurface(model_->mesh), radius);
    Eigen::MatrixXd force = Eigen::MatrixXd::Zero(3 * body_.mesh.node_count(), kAsked);
    for (int a = 0; a < kAsked; ++a) {
      for (Eigen::SparseMatrix<double>::InnerIterator it(loads, a * nodes() / kAsked); it; ++it) {
        const auto row = static_cast<std::size_t>(it.row());
        force(3 * model_->mesh.surface_nodes[row / 3] + it.row() % 3, a) = it.value();
      }
    }
    const ElasticStatics statics(body_.stiffness, body_.mesh.nodes, body_.mass, {});
    return force.cwiseProduct(statics.displacement(force)).colwise().sum().transpose();
  }

 private:
  static TetMesh mesh_of(int order, double edge_length) {
    const test::MeshFiles files;
    const std::string length = std::to_string(edge_length);
    const std::string text =
        "SetFactory(\"OpenCASCADE\");\nSphere(1) = {0, 0, 0, 0.05};\n"
        "Mesh.CharacteristicLengthMin = " +
        length + ";\nMesh.CharacteristicLengthMax = " + length +
        ";\nMesh.ElementOrder = " + std::to_string(order) + ";\n";
    return make_mesh({.source = files.write("ball.geo", text),
                      .edge_length = std::nullopt,
                      .order = order})
        .mesh;
  }

  Discrete body_;
  std::shared_ptr<const Model> model_;
};

double spread(const Eigen::ArrayXd& values) {
  return values.maxCoeff() / values.minCoeff() - 1.0;
}

}  // namespace

TEST_CASE("under the default fingertip a ball is equally soft everywhere, whatever its mesh",
          "[slow]") {
  const double poisson_ratio = GENERATE(0.3, 0.45);
  struct Meshes {
    int order;
    double coarse, fine;  // edge lengths, for 400 and 1600 surface nodes
  };
  const auto [order, coarse, fine] = GENERATE(Meshes{1, 0.197, 0.099}, Meshes{2, 0.42, 0.205});
  CAPTURE(poisson_ratio, order);
  double mean[2] = {0.0, 0.0};
  for (const int i : {0, 1}) {
    const Ball ball(order, (i == 0 ? coarse : fine) * kFeltBall, poisson_ratio);
    CAPTURE(ball.nodes());
    CHECK(ball.nodes() == Approx(i == 0 ? 400 : 1600).epsilon(0.05));
    CHECK(ball.default_radius() == Approx(0.55 * kFeltBall).epsilon(0.02));
    const Eigen::ArrayXd felt = ball.compliance(ball.default_radius());
    CHECK(spread(felt) < 0.05);
    mean[i] = felt.mean();
    if (i == 0) CHECK(spread(ball.compliance(0.0)) > 0.3);
  }
  CHECK(mean[0] == Approx(mean[1]).epsilon(0.03));
}
