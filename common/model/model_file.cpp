#include "common/model/model_file.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "common/config/range.hpp"
#include "common/error.hpp"
#include "common/model/compressed_file.hpp"
#include "common/model/content_checksum.hpp"
#include "common/model/dense_file.hpp"
#include "common/model/model_check.hpp"
#include "common/model/model_writer.hpp"
#include "common/response/modal_response.hpp"

namespace irdm {
namespace {

struct Unit {
  const char* object;
  const char* unit;
};

// What has none, or says it already, is not here.
constexpr Unit kDatasetUnits[] = {
    {"/mesh/nodes", "m"},
    {"/mesh/node_mass", "kg"},
    {kElementYoungsModulus, "Pa"},
    {kElementPoissonRatio, "1"},
    {kElementDensity, "kg/m^3"},
    {"/response/modal/angular_frequency", "rad/s"},
    {"/response/modal/decay_rate", "1/s"},
    {"/response/modal/shapes", "kg^-1/2"},
    {kResidualBlocks, "m/N"},
    {kModalGravity, "kg^1/2"},
    {kModalGravityRest, "s^2"},
    {kDenseGravity, "s^2"},
    {kDenseR, "m/N"},
    {kDisplayPositions, "m"},
    {kDisplayNormals, "1"},
    {kDisplayWeights, "1"},
    {kDisplayTextureCoordinates, "1"},
    {kCompressedFirScale, "m/N"},
    {kCompressedShapes, "1"},
    {kCompressedPole, "1"},
    {kCompressedAmplitude, "m/N"},
};

constexpr const char* kRigidMaterialUnits = "density: kg/m^3";
constexpr const char* kMaterialUnits =
    "youngs_modulus: Pa, poisson_ratio: 1, density: kg/m^3, rayleigh_alpha: 1/s, rayleigh_beta: s";

/// What a body's own spin does, of modes and of dense R.
constexpr Unit kSpinUnits[] = {
    {kModalCentrifugal, "kg^1/2 m"},
    {kDenseCentrifugal, "m s^2"},
};

constexpr Unit kGroupUnits[] = {
    {"/mesh", "com_offset: m"},
    {"/body", "mass: kg, inertia: kg m^2"},
    {"/response", "dt: s"},
    {kModalResidual,
     "cut_off: rad/s, contact_radius: m, residual_radius: m, press_time: s, added_compliance: m/N"},
};

/// Calls with object, attribute and unit of all that a model file may have.
template <typename Visit>
void for_each_unit(const hdf5::File& file, const Visit& visit) {
  for (const auto& [object, unit] : kDatasetUnits) visit(object, "unit", unit);
  for (const auto& [object, unit] : kSpinUnits) visit(object, "unit", unit);
  for (const auto& [object, unit] : kGroupUnits) visit(object, "units", unit);
  visit("/material", "units", holds_rigid_body(file) ? kRigidMaterialUnits : kMaterialUnits);
  visit(kCompressedFir, "unit", file.exists(kCompressedFirScale) ? "1" : "m/N");
}

}  // namespace

void write_model_units(hdf5::File& file) {
  for_each_unit(file, [&](const char* object, const char* name, const char* unit) {
    if (file.exists(object)) file.write_attribute(object, name, std::string(unit));
  });
}

void check_model_format(const hdf5::File& file) {
  if (!file.has_attribute("/", "format")) return;
  const std::string format = file.read_string_attribute("/", "format");
  if (format == kModelFormat) return;
  const std::string is =
      format == "irdm-trace" ? "it is a trace" : "its format is " + in_quotes(format);
  throw Error(file.name(), "is not a model file: " + is, "give one that irdm-precompute has made");
}

namespace {

class ModelReader {
 public:
  explicit ModelReader(hdf5::File file) : file_(std::move(file)) {}

  Model description() {
    read_description();
    return std::move(model_);
  }

  Model read(ResponseKind kind, Checksum checksum) {
    Model model = read_unchecked(kind);
    if (checksum == Checksum::kCompare) require_content_checksum(file_);
    return model;
  }

 private:
  Model read_unchecked(ResponseKind kind) {
    read_description();
    if (is_rigid(model_)) return std::move(model_);
    if (kind == ResponseKind::kModal) {
      read_modal();
    } else if (kind == ResponseKind::kDense) {
      model_.response = read_dense(file_, model_);
    } else {
      model_.response = read_compressed(file_, model_);
    }
    return std::move(model_);
  }

  [[noreturn]] void damaged(const std::string& what) const { refuse_model(file_.name(), what); }
  void require(bool holds, const std::string& what) const {
    if (!holds) damaged(what);
  }

  void read_description() {
    check_format();
    const bool rigid = holds_rigid_body(file_);
    if (rigid) read_rigid_response();
    read_mesh();
    read_body();
    read_material(rigid);
    if (!file_.exists("/response")) damaged("has no /response");
    model_.dt = file_.read_double_attribute("/response", "dt");
    const std::int64_t steps = file_.read_integer_attribute("/response", "steps");
    model_.steps = static_cast<int>(std::clamp<std::int64_t>(steps, 0, 1L + lab::kMostSteps));
    if (const auto fault = description_fault(model_)) damaged(*fault);
    model_.display = read_display(file_, model_.mesh.surface_node_count());
  }

  void check_format() {
    if (!file_.has_attribute("/", "format")) damaged("is not a model file");
    check_model_format(file_);
    const std::int64_t version = file_.read_integer_attribute("/", "version");
    if (version != kModelVersion) {
      damaged("has version " + std::to_string(version) + " and this program reads version " +
              std::to_string(kModelVersion));
    }
    check_dense_form(file_);
    // Files of older versions have fewer of them.
    for_each_unit(file_, [&](const char* object, const char* name, const char* unit) {
      if (file_.exists(object)) file_.require_text(object, name, unit);
    });
    for (const auto& [object, unit] : kSpinUnits) {
      if (file_.exists(object)) file_.require_text(object, "order", kSpinOrder);
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
  }

  void read_body() {
    if (!file_.exists("/body")) damaged("has no /body");
    BodyProperties& body = model_.body;
    body.mass = file_.read_double_attribute("/body", "mass");
    body.inertia = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(
        file_.read_doubles_attribute("/body", "inertia", 9).data());
    const std::string support = file_.read_string_attribute("/body", "support");
    require(support == "floating" || support == "fixed",
            "/body support is " + in_quotes(support) + ", neither floating nor fixed");
    body.support = support == "fixed" ? Support::kFixed : Support::kFloating;
  }

  void read_rigid_response() {
    for (const char* group : {"/response/modal", "/response/dense", kCompressedGroup}) {
      require(!file_.exists(group), std::string("is of a rigid body and has ") + group);
    }
    model_.response = RigidResponse{};
  }

  void read_material(bool rigid) {
    if (!file_.exists("/material")) damaged("has no /material");
    Material& material = model_.material;
    material.density = file_.read_double_attribute("/material", "density");
    read_elements(rigid);
    if (rigid) return;
    material.youngs_modulus = file_.read_double_attribute("/material", "youngs_modulus");
    material.poisson_ratio = file_.read_double_attribute("/material", "poisson_ratio");
    material.rayleigh_alpha = file_.read_double_attribute("/material", "rayleigh_alpha");
    material.rayleigh_beta = file_.read_double_attribute("/material", "rayleigh_beta");
  }

  void read_elements(bool rigid) {
    if (!file_.exists(kElementRegion)) return;
    ElementMaterials& elements = model_.material.elements;
    const hdf5::Shape shape{static_cast<hsize_t>(model_.mesh.tets.rows())};
    elements.region = file_.read<std::int32_t>(kElementRegion, shape);
    elements.density = file_.read<double>(kElementDensity, shape);
    if (rigid) return;
    elements.youngs_modulus = file_.read<double>(kElementYoungsModulus, shape);
    elements.poisson_ratio = file_.read<double>(kElementPoissonRatio, shape);
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
    if (file_.element_size("/response/modal/shapes") == sizeof(float)) {
      response.shapes = read_shapes<float>(modes);
    } else {
      response.shapes = read_shapes<double>(modes);
    }
    if (file_.exists(kModalCentrifugal)) {
      const auto loads = file_.read<double>(kModalCentrifugal, {modes, kSpinProducts});
      response.centrifugal = Eigen::Map<const RowMatrix<double>>(
          loads.data(), static_cast<Eigen::Index>(modes), kSpinProducts);
    }
    response.gravity = read_loads(kModalGravity, modes);
    response.gravity_rest =
        read_loads(kModalGravityRest, static_cast<hsize_t>(model_.degrees_of_freedom()));
    if (const auto fault = modal_fault(model_, response)) damaged(*fault);
    response.residual = read_residual(file_, model_.mesh.surface_node_count());
    model_.response = std::move(response);
  }

  // One column an axis; no rows where there is none.
  AxisColumns read_loads(const char* dataset, hsize_t rows) const {
    if (!file_.exists(dataset)) return {};
    const auto values = file_.read<double>(dataset, {rows, 3});
    return Eigen::Map<const AxisColumns>(values.data(), static_cast<Eigen::Index>(rows), 3);
  }

  template <typename Scalar>
  RowMatrix<Scalar> read_shapes(hsize_t modes) const {
    const int dof = model_.degrees_of_freedom();
    const auto values =
        file_.read<Scalar>("/response/modal/shapes", {static_cast<hsize_t>(dof), modes});
    return Eigen::Map<const RowMatrix<Scalar>>(values.data(), dof,
                                               static_cast<Eigen::Index>(modes));
  }

  hdf5::File file_;
  Model model_;
};

}  // namespace

Model read_model(const std::filesystem::path& path, ResponseKind kind, Checksum checksum) {
  return ModelReader(hdf5::File::open(path)).read(kind, checksum);
}

Model read_streamed_model(const std::filesystem::path& path) {
  const hdf5::File file = hdf5::File::open(path);
  Model model = read_description(hdf5::File::open(path));
  if (!is_rigid(model)) model.response = read_streamed(file, model);
  require_content_checksum(file);
  return model;
}

Model read_description(hdf5::File file) {
  return ModelReader(std::move(file)).description();
}

}  // namespace irdm
