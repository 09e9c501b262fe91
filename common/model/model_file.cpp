#include "common/model/model_file.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/error.hpp"
#include "common/model/content_checksum.hpp"

namespace irdm {
namespace {

constexpr const char* kFormat = "irdm-model";
constexpr std::int64_t kVersion = 1;
constexpr const char* kDenseR = "/response/dense/R";

// ---- reading -------------------------------------------------------------------------------

class ModelReader {
 public:
  explicit ModelReader(const std::filesystem::path& path) : file_(hdf5::File::open(path)) {}

  Model read(ResponseKind kind) {
    describe();
    if (kind == ResponseKind::kModal) {
      read_modal();
    } else {
      read_dense();
    }
    return std::move(model_);
  }

  // All but the response.
  Model describe() {
    check_format();
    read_mesh();
    read_body();
    read_material();
    if (!file_.exists("/response")) damaged("has no /response");
    model_.dt = file_.read_double_attribute("/response", "dt");
    model_.steps = static_cast<int>(file_.read_integer_attribute("/response", "steps"));
    require(std::isfinite(model_.dt) && model_.dt > 0 && model_.steps > 0,
            "dt and steps must be positive");
    return model_;
  }

 private:
  [[noreturn]] void damaged(const std::string& what) const {
    throw Error(file_.name(), what, "make the model again with irdm-precompute");
  }
  void require(bool holds, const std::string& what) const {
    if (!holds) damaged(what);
  }

  void check_format() {
    if (file_.read_string_attribute("/", "format") != kFormat) damaged("is not a model file");
    const std::int64_t version = file_.read_integer_attribute("/", "version");
    if (version != kVersion) {
      damaged("has version " + std::to_string(version) + " and this program reads version " +
              std::to_string(kVersion));
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
    model_.response = std::move(response);
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

  void read_dense() {
    if (!file_.exists(kDenseR)) {
      throw Error(file_.name(), "has no dense response",
                  "use engine = \"modal\" or precompute with storage = \"dense\" or \"both\"");
    }
    const auto dof = static_cast<hsize_t>(model_.degrees_of_freedom());
    const auto steps = static_cast<hsize_t>(model_.steps);
    require(file_.shape(kDenseR) == hdf5::Shape({dof, steps, dof}),
            "/response/dense/R must have the shape (3n, steps, 3n)");
    DenseResponse response;
    response.degrees_of_freedom = static_cast<int>(dof);
    response.steps = static_cast<int>(steps);
    if (file_.element_size(kDenseR) == sizeof(float)) {
      response.values = read_columns<float>(dof, steps);
    } else {
      response.values = read_columns<double>(dof, steps);
    }
    model_.response = std::move(response);
  }

  // The file has [b][s][a]; in memory the step runs fastest: [b][a][s].
  template <typename Scalar>
  std::vector<Scalar> read_columns(hsize_t dof, hsize_t steps) const {
    std::vector<Scalar> values(dof * steps * dof);
    RowMatrix<Scalar> column(static_cast<Eigen::Index>(steps), static_cast<Eigen::Index>(dof));
    for (hsize_t b = 0; b < dof; ++b) {
      file_.read_slab<Scalar>(kDenseR, {b, 0, 0}, {1, steps, dof}, column.data());
      require(column.allFinite(), "/response/dense/R has numbers that are not finite");
      Eigen::Map<RowMatrix<Scalar>>(values.data() + b * dof * steps, column.cols(), column.rows()) =
          column.transpose();
    }
    return values;
  }

  hdf5::File file_;
  Model model_;
};

std::filesystem::path temporary_name(const std::filesystem::path& path) {
  return path.string() + ".part-" + std::to_string(::getpid());
}

}  // namespace

Model read_model(const std::filesystem::path& path, ResponseKind kind) {
  return ModelReader(path).read(kind);
}

Model read_model_description(const std::filesystem::path& path) {
  return ModelReader(path).describe();
}

// ---- writing -------------------------------------------------------------------------------

ModelFileWriter::ModelFileWriter(std::filesystem::path path)
    : path_(std::move(path)), temporary_(temporary_name(path_)) {
  file_ = hdf5::File::create(temporary_);
}

ModelFileWriter::~ModelFileWriter() {
  if (!file_) return;
  file_.reset();
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
}

void ModelFileWriter::write_description(const Model& model) {
  hdf5::File& file = *file_;
  file.write_attribute("/", "format", std::string(kFormat));
  file.write_attribute("/", "version", kVersion);
  file.write_attribute("/", "created_by", std::string("irdm ") + IRDM_VERSION);

  const ModelMesh& mesh = model.mesh;
  const auto rows = [](const auto& matrix) { return static_cast<hsize_t>(matrix.rows()); };
  file.create_group("/mesh");
  file.write<double>("/mesh/nodes", {rows(mesh.nodes), 3}, mesh.nodes.data());
  file.write<std::int32_t>("/mesh/tets", {rows(mesh.tets), static_cast<hsize_t>(mesh.tets.cols())},
                           mesh.tets.data());
  file.write<std::int32_t>("/mesh/surface_nodes", {mesh.surface_nodes.size()},
                           mesh.surface_nodes.data());
  file.write<std::int32_t>("/mesh/triangles", {rows(mesh.triangles), 3}, mesh.triangles.data());
  file.write<double>("/mesh/node_mass", {rows(mesh.node_mass)}, mesh.node_mass.data());
  file.write_attribute("/mesh", "com_offset", {3}, mesh.com_offset.data());

  file.create_group("/body");
  file.write_attribute("/body", "mass", model.body.mass);
  file.write_attribute("/body", "inertia", {3, 3}, model.body.inertia.data());  // symmetric
  file.write_attribute("/body", "support",
                       std::string(model.body.support == Support::kFixed ? "fixed" : "floating"));

  file.create_group("/material");
  file.write_attribute("/material", "youngs_modulus", model.material.youngs_modulus);
  file.write_attribute("/material", "poisson_ratio", model.material.poisson_ratio);
  file.write_attribute("/material", "density", model.material.density);
  file.write_attribute("/material", "rayleigh_alpha", model.material.rayleigh_alpha);
  file.write_attribute("/material", "rayleigh_beta", model.material.rayleigh_beta);

  file.create_group("/response");
  file.write_attribute("/response", "dt", model.dt);
  file.write_attribute("/response", "steps", static_cast<std::int64_t>(model.steps));
}

void ModelFileWriter::write_modal(const ModalResponse& response) {
  const auto modes = static_cast<hsize_t>(response.mode_count());
  file_->write<double>("/response/modal/angular_frequency", {modes},
                       response.angular_frequency.data());
  file_->write<double>("/response/modal/decay_rate", {modes}, response.decay_rate.data());
  std::visit(
      [&]<typename Scalar>(const RowMatrix<Scalar>& shapes) {
        file_->write<Scalar>("/response/modal/shapes", {static_cast<hsize_t>(shapes.rows()), modes},
                             shapes.data());
      },
      response.shapes);
}

void ModelFileWriter::begin_dense(int degrees_of_freedom, int steps, Precision precision) {
  dense_dof_ = static_cast<hsize_t>(degrees_of_freedom);
  dense_steps_ = static_cast<hsize_t>(steps);
  const hdf5::Shape shape{dense_dof_, dense_steps_, dense_dof_};
  if (precision == Precision::kSingle) {
    file_->create_dataset<float>(kDenseR, shape);
  } else {
    file_->create_dataset<double>(kDenseR, shape);
  }
}

template <typename Scalar>
void ModelFileWriter::write_column(int b, const Scalar* values) {
  file_->write_slab<Scalar>(kDenseR, {static_cast<hsize_t>(b), 0, 0}, {1, dense_steps_, dense_dof_},
                            values);
}

void ModelFileWriter::write_dense_column(int b, const float* values) {
  write_column(b, values);
}
void ModelFileWriter::write_dense_column(int b, const double* values) {
  write_column(b, values);
}

void ModelFileWriter::commit() {
  store_content_checksum(*file_);
  file_->close();
  std::error_code error;
  std::filesystem::rename(temporary_, path_, error);
  if (error) {
    throw Error(path_.string(), "cannot be given its name: " + error.message(),
                "check permissions of the folder");
  }
  file_.reset();
}

}  // namespace irdm
