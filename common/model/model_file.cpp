#include "common/model/model_file.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/error.hpp"
#include "common/model/compressed_file.hpp"
#include "common/model/dense_file.hpp"
#include "common/model/residual_file.hpp"
#include "common/response/spin_products.hpp"

namespace irdm {
namespace {

class ModelReader {
 public:
  explicit ModelReader(hdf5::File file) : file_(std::move(file)) {}

  Model description() {
    read_description();
    return std::move(model_);
  }

  Model read(ResponseKind kind) {
    read_description();
    if (kind == ResponseKind::kModal) {
      read_modal();
    } else if (kind == ResponseKind::kDense) {
      model_.response = read_dense(file_, model_);
    } else {
      model_.response = read_compressed(file_, model_);
    }
    return std::move(model_);
  }

 private:
  [[noreturn]] void damaged(const std::string& what) const {
    throw Error(file_.name(), what, "make the model again with irdm-precompute");
  }
  void require(bool holds, const std::string& what) const {
    if (!holds) damaged(what);
  }

  void read_description() {
    check_format();
    read_mesh();
    read_body();
    read_material();
    if (!file_.exists("/response")) damaged("has no /response");
    model_.dt = file_.read_double_attribute("/response", "dt");
    model_.steps = static_cast<int>(file_.read_integer_attribute("/response", "steps"));
    require(std::isfinite(model_.dt) && model_.dt > 0 && model_.steps > 0,
            "dt and steps must be positive");
  }

  void check_format() {
    if (file_.read_string_attribute("/", "format") != kModelFormat) damaged("is not a model file");
    const std::int64_t version = file_.read_integer_attribute("/", "version");
    if (version != kModelVersion) {
      damaged("has version " + std::to_string(version) + " and this program reads version " +
              std::to_string(kModelVersion));
    }
  }

  void read_mesh() {
    ModelMesh& mesh = model_.mesh;
    const auto nodes = file_.read<double>("/mesh/nodes", {0, 3});
    mesh.nodes =
        Eigen::Map<const Points>(nodes.data(), static_cast<Eigen::Index>(nodes.size() / 3), 3);
    const hdf5::Shape tets_shape = file_.shape("/mesh/tets");
    require(tets_shape.size() == 2 && (tets_shape[1] == 4 || tets_shape[1] == 10),
            "/mesh/tets must have 4 or 10 columns");
    const auto tets = file_.read<std::int32_t>("/mesh/tets", {0, 0});
    mesh.tets =
        Eigen::Map<const RowMatrix<int>>(tets.data(), static_cast<Eigen::Index>(tets_shape[0]),
                                         static_cast<Eigen::Index>(tets_shape[1]));
    mesh.surface_nodes = file_.read<std::int32_t>("/mesh/surface_nodes", {0});
    const auto triangles = file_.read<std::int32_t>("/mesh/triangles", {0, 3});
    mesh.triangles = Eigen::Map<const Triangles>(
        triangles.data(), static_cast<Eigen::Index>(triangles.size() / 3), 3);
    const auto mass =
        file_.read<double>("/mesh/node_mass", {static_cast<hsize_t>(mesh.nodes.rows())});
    mesh.node_mass = Eigen::Map<const Eigen::VectorXd>(mass.data(), mesh.nodes.rows());
    mesh.com_offset = Vector3(file_.read_doubles_attribute("/mesh", "com_offset", 3).data());
    check_mesh();
  }

  void check_mesh() const {
    const ModelMesh& mesh = model_.mesh;
    const auto within = [](const int* begin, const int* end, Eigen::Index limit) {
      return std::all_of(begin, end, [limit](int i) { return i >= 0 && i < limit; });
    };
    require(!mesh.surface_nodes.empty() && mesh.triangles.rows() > 0, "has no surface");
    require(mesh.nodes.allFinite(), "/mesh/nodes has numbers that are not finite");
    require(within(mesh.tets.data(), mesh.tets.data() + mesh.tets.size(), mesh.nodes.rows()),
            "/mesh/tets points outside /mesh/nodes");
    require(within(mesh.surface_nodes.data(), mesh.surface_nodes.data() + mesh.surface_nodes.size(),
                   mesh.nodes.rows()),
            "/mesh/surface_nodes points outside /mesh/nodes");
    require(within(mesh.triangles.data(), mesh.triangles.data() + mesh.triangles.size(),
                   mesh.surface_node_count()),
            "/mesh/triangles points outside /mesh/surface_nodes");
    require(mesh.node_mass.allFinite() && mesh.node_mass.minCoeff() >= 0,
            "/mesh/node_mass must be finite and not negative");
  }

  void read_body() {
    if (!file_.exists("/body")) damaged("has no /body");
    BodyProperties& body = model_.body;
    body.mass = file_.read_double_attribute("/body", "mass");
    body.inertia = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(
        file_.read_doubles_attribute("/body", "inertia", 9).data());
    const std::string support = file_.read_string_attribute("/body", "support");
    require(support == "floating" || support == "fixed",
            "/body support is '" + support + "', neither floating nor fixed");
    body.support = support == "fixed" ? Support::kFixed : Support::kFloating;
    require(std::isfinite(body.mass) && body.mass > 0, "/body mass must be positive");
    require(body.inertia.allFinite() && Eigen::LLT<Matrix3>(body.inertia).info() == Eigen::Success,
            "/body inertia must be positive definite");
  }

  void read_material() {
    if (!file_.exists("/material")) damaged("has no /material");
    Material& material = model_.material;
    material.youngs_modulus = file_.read_double_attribute("/material", "youngs_modulus");
    material.poisson_ratio = file_.read_double_attribute("/material", "poisson_ratio");
    material.density = file_.read_double_attribute("/material", "density");
    material.rayleigh_alpha = file_.read_double_attribute("/material", "rayleigh_alpha");
    material.rayleigh_beta = file_.read_double_attribute("/material", "rayleigh_beta");
  }

  void read_modal() {
    if (!file_.exists("/response/modal")) {
      throw Error(file_.name(), "has no modal response",
                  "use engine = \"dense\" or precompute with storage = \"modal\" or \"both\"");
    }
    ModalResponse response;
    const auto frequency = file_.read<double>("/response/modal/angular_frequency", {0});
    const auto modes = static_cast<hsize_t>(frequency.size());
    const auto decay = file_.read<double>("/response/modal/decay_rate", {modes});
    response.angular_frequency =
        Eigen::Map<const Eigen::VectorXd>(frequency.data(), static_cast<Eigen::Index>(modes));
    response.decay_rate =
        Eigen::Map<const Eigen::VectorXd>(decay.data(), static_cast<Eigen::Index>(modes));
    require(modes > 0 && response.angular_frequency.allFinite() &&
                response.decay_rate.allFinite() && response.angular_frequency.minCoeff() > 0 &&
                response.decay_rate.minCoeff() >= 0,
            "/response/modal must have positive frequencies and decay rates that are not negative");
    if (file_.element_size("/response/modal/shapes") == sizeof(float)) {
      response.shapes = read_shapes<float>(modes);
    } else {
      response.shapes = read_shapes<double>(modes);
    }
    if (file_.exists(kModalCentrifugal)) {
      const auto loads = file_.read<double>(kModalCentrifugal, {modes, kSpinProducts});
      response.centrifugal = Eigen::Map<const RowMatrix<double>>(
          loads.data(), static_cast<Eigen::Index>(modes), kSpinProducts);
      require(response.centrifugal.allFinite(),
              std::string(kModalCentrifugal) + " has numbers that are not finite");
    }
    response.gravity = read_loads(kModalGravity, modes);
    response.gravity_rest =
        read_loads(kModalGravityRest, static_cast<hsize_t>(model_.degrees_of_freedom()));
    response.residual = read_residual(file_, model_.mesh.surface_node_count());
    model_.response = std::move(response);
  }

  // One column an axis; no rows where there is none.
  AxisColumns read_loads(const char* dataset, hsize_t rows) const {
    if (!file_.exists(dataset)) return {};
    const auto values = file_.read<double>(dataset, {rows, 3});
    AxisColumns loads =
        Eigen::Map<const AxisColumns>(values.data(), static_cast<Eigen::Index>(rows), 3);
    require(loads.allFinite(), std::string(dataset) + " has numbers that are not finite");
    return loads;
  }

  template <typename Scalar>
  RowMatrix<Scalar> read_shapes(hsize_t modes) const {
    const int dof = model_.degrees_of_freedom();
    const auto values =
        file_.read<Scalar>("/response/modal/shapes", {static_cast<hsize_t>(dof), modes});
    RowMatrix<Scalar> shapes =
        Eigen::Map<const RowMatrix<Scalar>>(values.data(), dof, static_cast<Eigen::Index>(modes));
    require(shapes.allFinite(), "/response/modal/shapes has numbers that are not finite");
    return shapes;
  }

  hdf5::File file_;
  Model model_;
};

}  // namespace

Model read_model(const std::filesystem::path& path, ResponseKind kind) {
  return ModelReader(hdf5::File::open(path)).read(kind);
}

Model read_streamed_model(const std::filesystem::path& path) {
  Model model = read_description(hdf5::File::open(path));
  model.response = read_streamed(hdf5::File::open(path), model);
  return model;
}

Model read_description(hdf5::File file) {
  return ModelReader(std::move(file)).description();
}

}  // namespace irdm
