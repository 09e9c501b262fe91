#include "python/core/model.hpp"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <map>

#include "common/config/range.hpp"
#include "common/error.hpp"
#include "common/model/model_file.hpp"
#include "common/number_text.hpp"
#include "python/core/module.hpp"

namespace py = pybind11;

namespace irdm::python {
namespace {

ResponseKind kind_of(const std::string& word) {
  static const std::map<std::string, ResponseKind> kinds{{"modal", ResponseKind::kModal},
                                                         {"dense", ResponseKind::kDense},
                                                         {"compressed", ResponseKind::kCompressed}};
  const auto kind = kinds.find(word);
  if (kind != kinds.end()) return kind->second;
  throw Error("response", "is " + in_quotes(word), "use \"modal\", \"dense\" or \"compressed\"");
}

Points surface_nodes(const ModelMesh& mesh) {
  Points nodes(mesh.surface_node_count(), 3);
  for (int i = 0; i < mesh.surface_node_count(); ++i) {
    nodes.row(i) = mesh.rest_position(i).transpose();
  }
  return nodes;
}

py::object modes(const py::object& self) {
  const Model& model = self.cast<PythonModel&>().model();
  const auto* response = std::get_if<ModalResponse>(&model.response);
  if (response == nullptr) return py::none();
  py::dict modes;
  const py::ssize_t count = response->mode_count();
  modes["angular_frequency"] = view<double>({count}, response->angular_frequency.data(), self);
  modes["decay_rate"] = view<double>({count}, response->decay_rate.data(), self);
  modes["shapes"] = std::visit(
      [&]<typename Scalar>(const RowMatrix<Scalar>& shapes) {
        return view<Scalar>({shapes.rows() / 3, 3, count}, shapes.data(), self);
      },
      response->shapes);
  return modes;
}

int degree_of_freedom(const Model& model, int node, int axis) {
  if (node < 0 || node >= model.mesh.surface_node_count()) {
    throw py::index_error("node is " + std::to_string(node) + "; use 0 to " +
                          std::to_string(model.mesh.surface_node_count() - 1));
  }
  if (axis < 0 || axis > 2)
    throw py::index_error("axis is " + std::to_string(axis) + "; use 0, 1 or 2");
  return 3 * node + axis;
}

int step_count(const Model& model, std::optional<int> steps) {
  const int count = steps.value_or(model.steps);
  if (count < 1 || count > lab::kMostSteps) throw py::value_error("steps must be 1 to 1000000");
  return count;
}

py::array response_column(PythonModel& self, int node, int axis, std::optional<int> steps) {
  const int b = degree_of_freedom(self.model(), node, axis);
  const RowMatrix<double> column = self.response().column(b, step_count(self.model(), steps));
  py::array_t<double> array({column.rows(), column.cols() / 3, Eigen::Index{3}});
  std::copy_n(column.data(), column.size(), array.mutable_data());
  return array;
}

py::array response_block(PythonModel& self, int to, int from, std::optional<int> steps) {
  const int count = step_count(self.model(), steps);
  const int row = degree_of_freedom(self.model(), to, 0);
  py::array_t<double> array({count, 3, 3});
  for (int axis = 0; axis < 3; ++axis) {
    const int b = degree_of_freedom(self.model(), from, axis);
    const RowMatrix<double> column = self.response().column(b, count);
    for (int s = 0; s < count; ++s) {
      for (int a = 0; a < 3; ++a) *array.mutable_data(s, a, axis) = column(s, row + a);
    }
  }
  return array;
}

py::array zero_lag(PythonModel& self) {
  const Eigen::MatrixXd matrix = self.response().zero_lag();
  const py::ssize_t nodes = matrix.rows() / 3;
  py::array_t<double> array({nodes, py::ssize_t{3}, nodes, py::ssize_t{3}});
  Eigen::Map<RowMatrix<double>>(array.mutable_data(), matrix.rows(), matrix.cols()) = matrix;
  return array;
}

py::dict material(const PythonModel& self) {
  const Material& of = self.model().material;
  py::dict material;
  material["density"] = of.density;
  if (is_rigid(self.model())) return material;
  material["youngs_modulus"] = of.youngs_modulus;
  material["poisson_ratio"] = of.poisson_ratio;
  material["rayleigh_alpha"] = of.rayleigh_alpha;
  material["rayleigh_beta"] = of.rayleigh_beta;
  return material;
}

py::dict element_materials(const PythonModel& self) {
  const ElementMaterials& of = self.model().material.elements;
  py::dict materials;
  if (of.empty()) return materials;
  const auto array = [](const auto& values) {
    using Value = typename std::decay_t<decltype(values)>::value_type;
    return py::array_t<Value>(static_cast<py::ssize_t>(values.size()), values.data());
  };
  materials["region"] = array(of.region);
  materials["density"] = array(of.density);
  if (is_rigid(self.model())) return materials;
  materials["youngs_modulus"] = array(of.youngs_modulus);
  materials["poisson_ratio"] = array(of.poisson_ratio);
  return materials;
}

std::string description(const PythonModel& self) {
  const Model& model = self.model();
  return "<irdm.Model of " + std::to_string(model.mesh.surface_node_count()) +
         " surface nodes, dt " + number_text(model.dt) + " s" +
         (is_rigid(model) ? ", rigid>" : ">");
}

}  // namespace

PythonModel::PythonModel(const std::filesystem::path& path, const std::string& response)
    : model_(std::make_shared<const Model>(read_model(path, kind_of(response)))),
      path_(path.string()) {}

const StoredResponse& PythonModel::response() {
  if (is_rigid(*model_)) {
    throw Error(path_.empty() ? "model" : path_, "is of a rigid body, which has no response",
                "ask for that of a soft one");
  }
  if (!response_) response_ = stored_response(*model_);
  return *response_;
}

void bind_model(py::module_& module) {
  using Self = PythonModel;
  const auto of_model = [](auto&& get) {
    return [get](const Self& self) { return get(self.model()); };
  };
  py::class_<Self>(module, "Model", R"(A model file, read. Arrays are copies unless they say so.

n surface nodes, N nodes, E tetrahedra, t triangles, r modes, T steps. Frame B: axes of the input mesh, origin at the
centre of mass.)")
      .def(py::init<const std::filesystem::path&, const std::string&>(), py::arg("path"),
           py::arg("response") = "modal", R"(Reads a model file.

response: the form of R to read, "modal", "dense" or "compressed"; of a rigid body it does not matter.
Raises irdm.Error.)")
      .def_static(
          "open",
          [](const std::filesystem::path& path, const std::string& response) {
            return Self(path, response);
          },
          py::arg("path"), py::arg("response") = "modal", "The same as Model(path, response).")
      .def("__repr__", &description)
      .def_property_readonly("path", &Self::path,
                             "Of the file; \"\" of a model that a simulation gives.")
      .def_property_readonly("dt", of_model([](const Model& m) { return m.dt; }),
                             "Step of the response and of simulations [s].")
      .def_property_readonly("steps", of_model([](const Model& m) { return m.steps; }),
                             "T, recorded steps of the response.")
      .def_property_readonly("rigid", of_model([](const Model& m) { return is_rigid(m); }),
                             "Whether the body does not deform.")
      .def_property_readonly(
          "fixed", of_model([](const Model& m) { return m.body.support == Support::kFixed; }),
          "Whether some of its nodes are clamped; otherwise it floats.")
      .def_property_readonly("mass", of_model([](const Model& m) { return m.body.mass; }), "[kg]")
      .def_property_readonly("com_offset", of_model([](const Model& m) {
                               return py::array_t<double>(3, m.mesh.com_offset.data());
                             }),
                             "Where the centre of mass is in the frame of the mesh file, (3) [m].")
      .def_property_readonly("inertia",
                             of_model([](const Model& m) { return copy(m.body.inertia); }),
                             "About the centre of mass, (3, 3) [kg m^2], B.")
      .def_property_readonly(
          "material", &material,
          "dict: density [kg/m^3], and of a soft body youngs_modulus [Pa], poisson_ratio, "
          "rayleigh_alpha [1/s], rayleigh_beta [s]. With regions: of what is in none.")
      .def_property_readonly(
          "element_materials", &element_materials,
          "Of a body with [[region]]s: dict of arrays (E): region (from 1, the last one that the "
          "tetrahedron lies in; 0: none), density, and of a soft body youngs_modulus, "
          "poisson_ratio. Otherwise empty.")
      .def_property_readonly("nodes",
                             of_model([](const Model& m) { return copy(surface_nodes(m.mesh)); }),
                             "Surface nodes at rest, (n, 3) [m], B.")
      .def_property_readonly(
          "triangles", of_model([](const Model& m) { return copy(m.mesh.triangles); }),
          "Of the surface, (t, 3) into nodes, seen counter-clockwise from outside.")
      .def_property_readonly("volume_nodes",
                             of_model([](const Model& m) { return copy(m.mesh.nodes); }),
                             "All nodes at rest, (N, 3) [m], B.")
      .def_property_readonly("tetrahedra",
                             of_model([](const Model& m) { return copy(m.mesh.tets); }),
                             "(E, 4) or (E, 10) into volume_nodes.")
      .def_property_readonly("surface_nodes", of_model([](const Model& m) {
                               return py::array_t<int>(
                                   static_cast<py::ssize_t>(m.mesh.surface_nodes.size()),
                                   m.mesh.surface_nodes.data());
                             }),
                             "(n) into volume_nodes.")
      .def_property_readonly(
          "modes", &modes, R"(None where R was not read as modes; else a dict of views, not copied:

angular_frequency (r) [rad/s], decay_rate (r) [1/s], shapes (n, 3, r), mass-normalised [kg^-1/2].)")
      .def("response_column", &response_column, py::arg("node"), py::arg("axis"),
           py::arg("steps") = py::none(),
           R"(How all nodes answer a force of 1 N held on one during step 0, without rigid motion.

axis: 0, 1, 2 of B. steps: None for T. Returns (steps, n, 3) [m/N], B, equation (10).
Raises IndexError, ValueError, irdm.Error of a rigid body.)")
      .def(
          "response_block", &response_block, py::arg("to"), py::arg("from_"),
          py::arg("steps") = py::none(),
          R"(R between two surface nodes, (steps, 3, 3) [m/N], B: [s, a, b] is the displacement of `to`
along a, s steps after a force of 1 N along b was held on `from_` for a step. Raises as response_column().)")
      .def(
          "zero_lag", &zero_lag,
          R"(R[0] between all surface nodes, (n, 3, n, 3) [m/N], B: the displacement within the step.
Takes 72 n^2 bytes. Raises irdm.Error of a rigid body.)");
}

}  // namespace irdm::python
