// What a reader of models refuses, whatever program it reads for.
#include <functional>
#include <limits>

#include "common/error.hpp"
#include "common/model/dense_file.hpp"
#include "common/model/model_file.hpp"
#include "common/response/stored_response.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/edited_numbers.hpp"
#include "tests/support/synthetic_model.hpp"
#include "tests/support/temporary_folder.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Every node, mode and step of it can be edited.
struct CubeFile : TemporaryFolder {
  CubeFile() { write(cube()); }

  static Model cube() {
    Model model = synthetic_cube(1, 4, 6);
    add_centrifugal(model);
    add_gravity(model, true);
    return model;
  }

  void write(const Model& model) const {
    std::filesystem::remove(file);
    ModelFileWriter writer(file);
    writer.write_description(model);
    writer.write_modal(std::get<ModalResponse>(model.response));
    writer.write_compressed(test::compressed_response(model), {0.01, 0.01, 0.005, 0.01, 24});
    writer.commit();
  }

  template <typename Scalar>
  void write_dense() const {
    const Model model = with_dense_response<Scalar>(cube());
    const auto& response = std::get<DenseResponse>(model.response);
    const auto& values = std::get<std::vector<Scalar>>(response.values);
    const int dof = response.degrees_of_freedom;
    std::filesystem::remove(file);
    ModelFileWriter writer(file);
    writer.write_description(model);
    writer.begin_dense(dof, response.steps,
                       sizeof(Scalar) == 4 ? Precision::kSingle : Precision::kDouble);
    for (int b = 0; b < dof; ++b) {
      RowMatrix<Scalar> column(response.steps, dof);
      for (int s = 0; s < response.steps; ++s) {
        for (int a = 0; a < dof; ++a) {
          column(s, a) = values[static_cast<std::size_t>((b * dof + a) * response.steps + s)];
        }
      }
      writer.write_dense_column(b, column.data());
    }
    writer.commit();
  }

  /// Of the description: all that every program reads.
  void refuses(const std::function<void(Model&)>& change, const std::string& message) const {
    Model model = cube();
    change(model);
    write(model);
    CAPTURE(message);
    CHECK_THROWS_WITH(read_description(hdf5::File::open(file)), ContainsSubstring(message));
    CHECK_THROWS_WITH(read_model(file, ResponseKind::kModal), ContainsSubstring(message));
    CHECK_THROWS_WITH(read_model(file, ResponseKind::kCompressed), ContainsSubstring(message));
  }

  void refuses_modes(const std::function<void(ModalResponse&)>& change,
                     const std::string& message) const {
    Model model = cube();
    change(std::get<ModalResponse>(model.response));
    write(model);
    CAPTURE(message);
    CHECK_THROWS_WITH(read_model(file, ResponseKind::kModal), ContainsSubstring(message));
  }

  void refuses_compressed(const std::string& set, std::size_t place, double value,
                          const std::string& message) const {
    write(cube());
    set_number(file, "/response/compressed/" + set, place, value);
    CAPTURE(set, value);
    CHECK_THROWS_WITH(read_model(file, ResponseKind::kCompressed), ContainsSubstring(message));
  }

  std::filesystem::path file = path() / "cube.h5";
};

}  // namespace

TEST_CASE("a sound model is read in every form") {
  const CubeFile cube;
  CHECK_NOTHROW(read_model(cube.file, ResponseKind::kModal));
  CHECK_NOTHROW(read_model(cube.file, ResponseKind::kCompressed));
  cube.write_dense<double>();
  CHECK_NOTHROW(read_model(cube.file, ResponseKind::kDense));
  CHECK_NOTHROW(read_streamed_model(cube.file));
  cube.write_dense<float>();
  CHECK_NOTHROW(read_model(cube.file, ResponseKind::kDense));
}

TEST_CASE("a model whose mesh is none is refused") {
  const CubeFile cube;
  cube.refuses([](Model& m) { m.mesh.nodes.setZero(); }, "/mesh/nodes");
  cube.refuses([](Model& m) { m.mesh.nodes *= 1e200; }, "/mesh/nodes");
  cube.refuses([](Model& m) { m.mesh.nodes *= 1e-200; }, "/mesh/nodes");
  cube.refuses([](Model& m) { m.mesh.nodes(2, 1) = kNan; }, "/mesh/nodes");
  cube.refuses([](Model& m) { m.mesh.nodes.row(1) = m.mesh.nodes.row(0); }, "/mesh/t");
  cube.refuses([](Model& m) { m.mesh.com_offset.x() = kNan; }, "com_offset");
  cube.refuses([](Model& m) { m.mesh.com_offset.x() = 1e300; }, "com_offset");
  cube.refuses([](Model& m) { m.mesh.tets.resize(0, 4); }, "/mesh/tets");
  cube.refuses([](Model& m) { std::swap(m.mesh.tets(0, 0), m.mesh.tets(0, 1)); }, "inverted");
  cube.refuses([](Model& m) { m.mesh.tets(0, 3) = m.mesh.tets(0, 0); }, "flat");
  cube.refuses([](Model& m) { m.mesh.triangles(3, 1) = m.mesh.triangles(3, 0); }, "without area");
  cube.refuses([](Model& m) { m.mesh.triangles.conservativeResize(11, 3); }, "not closed");
  cube.refuses([](Model& m) { m.mesh.triangles.col(0).swap(m.mesh.triangles.col(1)); }, "inward");
  cube.refuses([](Model& m) { std::swap(m.mesh.surface_nodes[0], m.mesh.surface_nodes[1]); },
               "does not increase");
}

TEST_CASE("a model whose body is none is refused") {
  const CubeFile cube;
  cube.refuses([](Model& m) { m.mesh.node_mass(0) = 0.0; }, "/mesh/node_mass");
  cube.refuses([](Model& m) { m.mesh.node_mass(0) *= 2.0; }, "add up");
  cube.refuses([](Model& m) { m.body.mass = -m.body.mass; }, "/body mass");
  cube.refuses([](Model& m) { m.body.mass = 1e300; }, "/body mass");
  cube.refuses([](Model& m) { m.body.inertia(0, 0) *= -1.0; }, "positive definite");
  cube.refuses([](Model& m) { m.body.inertia(2, 2) *= 1e-20; }, "positive definite");
  cube.refuses([](Model& m) { m.body.inertia(0, 1) = m.body.inertia(1, 0) = m.body.inertia(0, 0); },
               "positive definite");
  cube.refuses([](Model& m) { m.body.inertia(0, 1) = 0.1 * m.body.inertia(0, 0); },
               "not symmetric");
  cube.refuses([](Model& m) { m.body.inertia *= 1e3; }, "larger than");
}

TEST_CASE("a model whose material or step no laboratory has is refused") {
  const CubeFile cube;
  for (const double value : {kNan, 0.0, 1e-308, 1e300}) {
    cube.refuses([&](Model& m) { m.material.youngs_modulus = value; }, "youngs_modulus");
    cube.refuses([&](Model& m) { m.material.density = value; }, "density");
    cube.refuses([&](Model& m) { m.dt = value; }, "/response dt");
  }
  cube.refuses([](Model& m) { m.material.poisson_ratio = 0.5; }, "poisson_ratio");
  cube.refuses([](Model& m) { m.material.rayleigh_alpha = -1.0; }, "rayleigh_alpha");
  cube.refuses([](Model& m) { m.material.rayleigh_beta = 1e300; }, "rayleigh_beta");
  cube.refuses([](Model& m) { m.dt = 1e-10; }, "/response dt");
  cube.refuses([](Model& m) { m.steps = 0; }, "/response steps");
  cube.refuses([](Model& m) { m.steps = 2'000'000'000; }, "/response steps");
}

TEST_CASE("modes that no body of this mass has are refused") {
  const CubeFile cube;
  const auto shapes = [](ModalResponse& r) -> RowMatrix<double>& {
    return std::get<RowMatrix<double>>(r.shapes);
  };
  cube.refuses_modes([](ModalResponse& r) { r.angular_frequency.reverseInPlace(); }, "increase");
  cube.refuses_modes([](ModalResponse& r) { r.angular_frequency(3) = 1e300; }, "angular_frequency");
  cube.refuses_modes([](ModalResponse& r) { r.angular_frequency(0) = 1e-300; },
                     "angular_frequency");
  cube.refuses_modes([](ModalResponse& r) { r.decay_rate(1) = -1.0; }, "decay_rate");
  cube.refuses_modes([](ModalResponse& r) { r.decay_rate(1) = 1e300; }, "decay_rate");
  cube.refuses_modes([&](ModalResponse& r) { shapes(r)(3, 2) = kNan; }, "shapes");
  cube.refuses_modes([&](ModalResponse& r) { shapes(r)(3, 2) = 100.0; }, "not mass-normalised");
  cube.refuses_modes([](ModalResponse& r) { r.angular_frequency(0) = 1e-8; }, "gives way");
  cube.refuses_modes([](ModalResponse& r) { r.centrifugal(1, 2) = 1e3; }, "centrifugal has a load");
  cube.refuses_modes([](ModalResponse& r) { r.gravity(1, 2) = 1e3; }, "gravity has a load");
  cube.refuses_modes([](ModalResponse& r) { r.gravity_rest(1, 2) = 1e300; }, "gravity_rest has");
}

TEST_CASE("a dense response that is none is refused, however it is read") {
  const CubeFile cube;
  const auto model = CubeFile::cube();
  const auto dof = static_cast<std::size_t>(model.degrees_of_freedom());
  const auto steps = static_cast<std::size_t>(model.steps);
  const auto refused = [&](const std::function<void(std::vector<double>&)>& change,
                           const std::string& message) {
    cube.write_dense<double>();
    edit_numbers(cube.file, kDenseR, change);
    sign_model(cube.file);
    CAPTURE(message);
    CHECK_THROWS_WITH(read_model(cube.file, ResponseKind::kDense), ContainsSubstring(message));
    CHECK_THROWS_WITH(read_streamed_model(cube.file), ContainsSubstring(message));
  };
  // Entry [b][s][a].
  const auto at = [&](std::vector<double>& R, std::size_t b, std::size_t s,
                      std::size_t a) -> double& { return R[(b * steps + s) * dof + a]; };
  refused([&](auto& R) { at(R, 3, 2, 1) = kNan; }, "not finite");
  refused([&](auto& R) { at(R, 3, 2, 1) = 1e300; }, "beyond 1e+12");
  refused([&](auto& R) { at(R, 0, 1, 7) += 0.1; }, "is not symmetric");
  refused([&](auto& R) { at(R, 7, 1, 0) += 0.1; }, "is not symmetric");
  refused(
      [&](auto& R) {
        for (std::size_t s = 0; s < steps; ++s) at(R, 5, s, 5) *= -1.0;
      },
      "gives way against the force on degree of freedom 5");
}

TEST_CASE("a column that changes after the model was read is noticed") {
  const CubeFile cube;
  cube.write_dense<double>();
  const Model model = read_streamed_model(cube.file);
  const auto& response = std::get<StreamedResponse>(model.response);
  const auto dof = static_cast<std::size_t>(response.degrees_of_freedom);
  const auto steps = static_cast<std::size_t>(response.steps);
  std::vector<double> columns(3 * dof * steps);
  CHECK_NOTHROW(DenseColumnFile(cube.file, response).read(2, columns.data()));
  edit_numbers(cube.file, kDenseR, [&](auto& R) { R[(7 * steps + 2) * dof + 1] *= 1.001; });
  DenseColumnFile changed(cube.file, response);
  CHECK_NOTHROW(changed.read(1, columns.data()));
  CHECK_THROWS_WITH(changed.read(2, columns.data()),
                    ContainsSubstring("has changed since it was opened"));
}

TEST_CASE("a compressed response that is none is refused") {
  const CubeFile cube;
  // Of two poles the second alone, and the real part of it.
  cube.refuses_compressed("pole", 2, 1.0, "a pole that does not decay");
  cube.refuses_compressed("pole", 0, -1.5, "a pole that does not decay");
  cube.refuses_compressed("pole", 3, kNan, "not finite");
  cube.refuses_compressed("amplitude", 0, 1e300, "amplitudes out of range");
  cube.refuses_compressed("shapes", 0, 1e30, "longer than 1");
  cube.refuses_compressed("early_scale", 0, -1e-6, "early_scale that is negative");
  cube.refuses_compressed("early_scale", 0, 1e30, "early_scale that is negative");
  cube.refuses_compressed("early", 0, -30000, "gives way against a force");
  cube.refuses_compressed("early", 2, 30000, "not symmetric");
}

TEST_CASE("a model that was changed after it was written is refused when it is read") {
  const CubeFile cube;
  for (const char* set : {"/response/modal/decay_rate", "/response/modal/gravity_rest",
                          "/response/compressed/amplitude"}) {
    CAPTURE(set);
    cube.write(CubeFile::cube());
    edit_numbers(cube.file, set, [](std::vector<double>& values) { values.back() *= 1.0001; });
    for (const ResponseKind kind : {ResponseKind::kModal, ResponseKind::kCompressed}) {
      CHECK_THROWS_WITH(read_model(cube.file, kind),
                        ContainsSubstring("was changed after it was written"));
      CHECK_NOTHROW(read_model(cube.file, kind, Checksum::kIgnore));
    }
    sign_model(cube.file);
    CHECK_NOTHROW(read_model(cube.file, ResponseKind::kModal));
  }
}

TEST_CASE("dense R that was changed after it was written is refused, however it is read") {
  const CubeFile cube;
  const auto change = [&] {
    const auto dof = static_cast<std::size_t>(CubeFile::cube().degrees_of_freedom());
    edit_numbers(cube.file, kDenseR, [&](auto& R) { R[(7 * 6 + 2) * dof + 1] *= 1.001; });
  };
  const auto refuses = [&](const std::string& message) {
    CHECK_THROWS_WITH(read_model(cube.file, ResponseKind::kDense), ContainsSubstring(message));
    CHECK_THROWS_WITH(read_streamed_model(cube.file), ContainsSubstring(message));
  };
  const std::string message = "/response/dense/R was changed after it was written: column 7 has";
  cube.write_dense<float>();
  change();
  refuses(message);
  cube.write_dense<double>();
  change();
  refuses(message);
  {
    const auto R = stored_response(cube.file, CubeFile::cube().degrees_of_freedom(), 6);
    CHECK_NOTHROW(R->column(6, 6));
    CHECK_THROWS_WITH(R->column(7, 6), ContainsSubstring(message));
  }
  // The checksums of the columns are themselves part of the content.
  take_away(cube.file, kDenseColumnChecksum);
  refuses("was changed after it was written: its content_sha256");
}

TEST_CASE("a model of before there were checksums is read") {
  const CubeFile cube;
  cube.write_dense<double>();
  take_away(cube.file, kDenseColumnChecksum);
  sign_model(cube.file);  // as it was before columns had some
  CHECK_NOTHROW(read_model(cube.file, ResponseKind::kDense));
  CHECK_NOTHROW(read_streamed_model(cube.file));
  take_away(cube.file, "content_sha256");
  CHECK_NOTHROW(read_model(cube.file, ResponseKind::kDense));
  cube.write(CubeFile::cube());
  take_away(cube.file, "content_sha256");
  CHECK_NOTHROW(read_model(cube.file, ResponseKind::kModal));
}

TEST_CASE("dense R whose first step goes against the force is refused") {
  const CubeFile cube;
  const auto dof = static_cast<std::size_t>(CubeFile::cube().degrees_of_freedom());
  cube.write_dense<double>();
  edit_numbers(cube.file, kDenseR, [&](auto& R) { R[5 * 6 * dof + 5] *= -0.01; });
  sign_model(cube.file);
  const std::string message = "gives way against the force on degree of freedom 5";
  CHECK_THROWS_WITH(read_model(cube.file, ResponseKind::kDense), ContainsSubstring(message));
  CHECK_THROWS_WITH(read_streamed_model(cube.file), ContainsSubstring(message));
}

TEST_CASE("modes of a body with another support are refused") {
  const CubeFile cube;
  Model model = synthetic_cube(1, 4, 6);
  add_centrifugal(model);
  const auto write_and_read = [&] {
    cube.write(model);
    return read_model(cube.file, ResponseKind::kModal);
  };
  CHECK_NOTHROW(write_and_read());
  model.body.support = Support::kFixed;
  CHECK_THROWS_WITH(write_and_read(), ContainsSubstring("support is fixed, but the modes are those "
                                                        "of a floating body"));
  auto& response = std::get<ModalResponse>(model.response);
  std::get<RowMatrix<double>>(response.shapes).topRows(3).setZero();
  CHECK_NOTHROW(write_and_read());  // a clamped node: of a version without gravity
  response.centrifugal.resize(0, 0);
  add_gravity(model);
  CHECK_NOTHROW(write_and_read());
  model.body.support = Support::kFloating;
  CHECK_THROWS_WITH(write_and_read(), ContainsSubstring("support is floating, but the modes are "
                                                        "those of a fixed body"));
}

TEST_CASE("types are part of what a model must be") {
  const CubeFile cube;
  const auto refused = [&](const std::string& message) {
    CAPTURE(message);
    CHECK_THROWS_WITH(read_description(hdf5::File::open(cube.file)), ContainsSubstring(message));
    cube.write(CubeFile::cube());
  };
  retype(cube.file, "/mesh/triangles", H5T_NATIVE_DOUBLE, 0.7);
  refused("dataset /mesh/triangles does not hold integers");
  retype(cube.file, "/mesh/nodes", H5T_NATIVE_INT32);
  refused("dataset /mesh/nodes does not hold floating-point numbers");
  replace_attribute(cube.file, "/response", "steps", 50.5);
  refused("attribute steps at /response is not an integer");
  replace_attribute(cube.file, "/", "version", 1.9);
  refused("attribute version at / is not an integer");
  cube.write_dense<double>();
  retype(cube.file, kDenseR, H5T_NATIVE_INT32);
  CHECK_THROWS_WITH(read_model(cube.file, ResponseKind::kDense),
                    ContainsSubstring("does not hold floating-point numbers"));
  CHECK_THROWS_WITH(
      stored_response(cube.file, CubeFile::cube().degrees_of_freedom(), 6)->column(0, 6),
      ContainsSubstring("does not hold floating-point numbers"));
}

TEST_CASE("units are part of what a model must be") {
  const CubeFile cube;
  const auto refused = [&](const char* object, const char* name, const char* unit,
                           const std::string& message) {
    cube.write(CubeFile::cube());
    replace_attribute(cube.file, object, name, std::string(unit));
    CAPTURE(message);
    CHECK_THROWS_WITH(read_description(hdf5::File::open(cube.file)), ContainsSubstring(message));
  };
  refused("/mesh/nodes", "unit", "mm", "attribute unit of /mesh/nodes is 'mm', not 'm'");
  refused("/response", "units", "dt: ms", "attribute units of /response is 'dt: ms', not 'dt: s'");
  refused("/response/modal/centrifugal", "unit", "g", "attribute unit of /response/modal/centri");
  refused("/response/modal/centrifugal", "order", "zz yy xx yz xz xy", "attribute order of ");
}
