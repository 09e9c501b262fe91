#include "common/model/content_checksum.hpp"
#include "common/model/model_file.hpp"
#include "common/response/stored_response.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/point_loads.hpp"
#include "tests/support/synthetic_model.hpp"
#include "tests/support/temporary_folder.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

namespace {

struct RigidFile : TemporaryFolder {
  RigidFile() { write(cube); }

  void write(const Model& model) const {
    std::filesystem::remove(file);
    ModelFileWriter writer(file);
    writer.write_description(model);
    writer.commit();
  }
  void refuses(const std::string& message) const {
    CAPTURE(message);
    for (const ResponseKind kind :
         {ResponseKind::kModal, ResponseKind::kDense, ResponseKind::kCompressed}) {
      CHECK_THROWS_WITH(read_model(file, kind),
                        ContainsSubstring(message) && ContainsSubstring("cube.h5"));
    }
    CHECK_THROWS_WITH(read_streamed_model(file), ContainsSubstring(message));
    CHECK_THROWS_WITH(read_description(hdf5::File::open(file)), ContainsSubstring(message));
  }
  void refuses(void (*change)(Model&), const std::string& message) const {
    Model model = cube;
    change(model);
    write(model);
    refuses(message);
  }

  Model cube = made_rigid(synthetic_cube(2, 4, 6));
  std::filesystem::path file = path() / "cube.h5";
};

}  // namespace

TEST_CASE("a rigid body comes back as it was written, whatever response is asked for") {
  const RigidFile rigid;
  for (const ResponseKind kind :
       {ResponseKind::kModal, ResponseKind::kDense, ResponseKind::kCompressed}) {
    const Model read = read_model(rigid.file, kind);
    CHECK(is_rigid(read));
    CHECK(read.mesh.nodes == rigid.cube.mesh.nodes);
    CHECK(read.mesh.triangles == rigid.cube.mesh.triangles);
    CHECK(read.body.mass == rigid.cube.body.mass);
    CHECK(read.body.inertia == rigid.cube.body.inertia);
    CHECK(read.material.density == rigid.cube.material.density);
    CHECK(read.material.youngs_modulus == 0.0);
    CHECK(read.dt == rigid.cube.dt);
    CHECK(read.steps == 1);
  }
  CHECK(is_rigid(read_streamed_model(rigid.file)));
  CHECK(is_rigid(read_description(hdf5::File::open(rigid.file))));
  CHECK_FALSE(is_rigid(synthetic_cube(2, 4, 6)));
}

TEST_CASE("the file of a rigid body has no elastic material and no response") {
  const RigidFile rigid;
  const hdf5::File file = hdf5::File::open(rigid.file);
  CHECK(file.read_string_attribute("/response", "kind") == "rigid");
  CHECK(file.read_string_attribute("/material", "units") == "density: kg/m^3");
  CHECK_FALSE(file.has_attribute("/material", "youngs_modulus"));
  CHECK_FALSE(file.exists("/response/modal"));
  CHECK(content_checksum(file) == stored_content_checksum(file));
}

TEST_CASE("the checksum tells a rigid body from a soft one") {
  const RigidFile rigid;
  const auto stored = [&] { return stored_content_checksum(hdf5::File::open(rigid.file)); };
  const auto first = stored();
  Model soft = synthetic_cube(2, 4, 1);
  rigid.write(soft);
  CHECK(stored() != first);
}

TEST_CASE("a file of a rigid body that is not one is refused") {
  const RigidFile rigid;
  rigid.refuses([](Model& m) { m.steps = 2; }, "steps of a rigid body must be 1");
  rigid.refuses([](Model& m) { m.material.density = 0.0; }, "/material density");
  rigid.refuses([](Model& m) { m.body.mass = -1.0; }, "/body mass");
  rigid.refuses([](Model& m) { m.dt = 0.0; }, "/response dt");
  rigid.refuses([](Model& m) { m.body.inertia(0, 0) *= -1.0; }, "positive definite");
}

TEST_CASE("a file of a rigid body that has a response is refused") {
  const RigidFile rigid;
  std::filesystem::remove(rigid.file);
  {
    ModelFileWriter writer(rigid.file);
    writer.write_description(rigid.cube);
    const Model soft = synthetic_cube(2, 4, 1);
    writer.write_modal(std::get<ModalResponse>(soft.response));
    writer.commit();
  }
  rigid.refuses("is of a rigid body and has /response/modal");
}

TEST_CASE("a model file of an unknown kind is refused") {
  const RigidFile rigid;
  std::filesystem::remove(rigid.file);
  {
    hdf5::File file = hdf5::File::create(rigid.file);
    write_description(file, synthetic_cube(2, 4, 1));
    file.write_attribute("/response", "kind", std::string("liquid"));
  }
  rigid.refuses("kind is 'liquid', which is not known");
}

TEST_CASE("the stored response of a rigid body is zero") {
  const Model model = made_rigid(synthetic_cube(2, 4, 6));
  const auto R = stored_response(model);
  const int dof = model.degrees_of_freedom();
  CHECK(R->zero_lag() == Eigen::MatrixXd::Zero(dof, dof));
  CHECK(R->column(4, 3) == RowMatrix<double>::Zero(3, dof));
  CHECK(R->static_column(4) == Eigen::VectorXd::Zero(dof));
  const std::vector<Vector3> normals(static_cast<std::size_t>(dof / 3), Vector3::UnitX());
  CHECK(static_compliance(model, test::point_loads(normals)).isZero(0.0));
}
