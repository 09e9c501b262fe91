#include <fstream>

#include "common/model/content_checksum.hpp"
#include "common/model/model_file.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/synthetic_model.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace irdm;

namespace {

void write(const std::filesystem::path& path, const Model& model) {
  ModelFileWriter writer(path);
  writer.write_description(model);
  writer.write_modal(std::get<ModalResponse>(model.response));
  writer.commit();
}

std::string stored(const std::filesystem::path& path) {
  return stored_content_checksum(hdf5::File::open(path)).value();
}

}  // namespace

TEST_CASE("a model file carries the checksum of its content") {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "a.h5";
  write(path, test::synthetic_cube(2, 5, 10));
  const hdf5::File file = hdf5::File::open(path);
  CHECK(stored(path).size() == 64);
  CHECK(content_checksum(file) == stored(path));
}

TEST_CASE("every part of a model has its share in the checksum") {
  const test::TemporaryFolder folder;
  const Model original = test::synthetic_cube(2, 5, 10);
  write(folder.path() / "a.h5", original);
  Model other = original;
  SECTION("mesh") {
    other.mesh.nodes(0, 0) += 1e-9;
  }
  SECTION("triangles") {
    std::swap(other.mesh.triangles(0, 0), other.mesh.triangles(0, 1));
  }
  SECTION("body") {
    other.body.mass *= 1.0 + 1e-9;
  }
  SECTION("support") {
    other.body.support = Support::kFixed;
  }
  SECTION("material") {
    other.material.rayleigh_beta *= 2.0;
  }
  SECTION("steps") {
    other.steps += 1;
  }
  SECTION("frequencies") {
    std::get<ModalResponse>(other.response).angular_frequency(4) += 1e-9;
  }
  SECTION("centrifugal forces") {
    test::add_centrifugal(other);
  }
  SECTION("gravity") {
    test::add_gravity(other);
  }
  SECTION("what other modes add to the sag") {
    Model whole = original;
    test::add_gravity(whole);
    write(folder.path() / "a.h5", whole);
    test::add_gravity(other, true);
  }
  SECTION("shapes") {
    std::get<RowMatrix<double>>(std::get<ModalResponse>(other.response).shapes)(3, 2) += 1e-9;
  }
  write(folder.path() / "b.h5", other);
  CHECK(stored(folder.path() / "a.h5") != stored(folder.path() / "b.h5"));
}

TEST_CASE("what gravity does to a dense response has its share in the checksum") {
  const test::TemporaryFolder folder;
  const Model model = test::synthetic_cube(1, 5, 2);
  const auto dof = static_cast<Eigen::Index>(model.degrees_of_freedom());
  const auto with = [&]<typename Scalar>(const std::string& name, Scalar gravity) {
    const RowMatrix<Scalar> column = RowMatrix<Scalar>::Ones(2, dof);
    const RowMatrix<Scalar> all = RowMatrix<Scalar>::Constant(6, dof, gravity);
    ModelFileWriter writer(folder.path() / name);
    writer.write_description(model);
    writer.begin_dense(static_cast<int>(dof), 2,
                       sizeof(Scalar) == 4 ? Precision::kSingle : Precision::kDouble);
    for (int b = 0; b < dof; ++b) writer.write_dense_column(b, column.data());
    writer.write_dense_gravity(all.data());
    writer.commit();
    return stored(folder.path() / name);
  };
  CHECK(with("a.h5", 1.0) != with("b.h5", 1.5));
  CHECK(with("c.h5", 1.0F) != with("d.h5", 1.5F));
}

TEST_CASE("every part of a compressed response has its share in the checksum") {
  const test::TemporaryFolder folder;
  const Model model = test::synthetic_cube(1, 5, 2);
  const CompressedResponse original = test::compressed_response(model);
  const auto with = [&](const std::string& name, const CompressedResponse& response) {
    ModelFileWriter writer(folder.path() / name);
    writer.write_description(model);
    writer.write_compressed(response, {0.01, 0.01, 0.005, 0.01, 24});
    writer.commit();
    return stored(folder.path() / name);
  };
  CompressedResponse other = original;
  SECTION("early part") {
    std::get<std::vector<std::int16_t>>(other.fir)[7] += 1;
  }
  SECTION("scales") {
    other.fir_scale[3] *= 2.0F;
  }
  SECTION("shapes") {
    other.shapes(1, 1) += 1e-3F;
  }
  SECTION("shapes of poles") {
    other.pole_shape = {0, 0};
  }
  SECTION("poles") {
    other.pole(1) += 1e-9;
  }
  SECTION("amplitudes") {
    other.amplitude(0) *= 1.0 + 1e-9;
  }
  CHECK(with("a.h5", original) != with("b.h5", other));
}

TEST_CASE("a file whose bytes changed does not have its checksum any more") {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "a.h5";
  const Model model = test::synthetic_cube(2, 5, 10);
  write(path, model);
  const double needle = std::get<ModalResponse>(model.response).angular_frequency(2);
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  const auto at = bytes.find(std::string(reinterpret_cast<const char*>(&needle), sizeof needle));
  REQUIRE(at != std::string::npos);
  file.seekp(static_cast<std::streamoff>(at));
  file.put(static_cast<char>(bytes[at] ^ 1));
  file.close();
  CHECK(content_checksum(hdf5::File::open(path)) != stored(path));
}

TEST_CASE("the description of a model file is read without its response") {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "a.h5";
  const Model model = test::synthetic_cube(2, 5, 10);
  write(path, model);
  const Model read = read_description(hdf5::File::open(path));
  CHECK(read.mesh.nodes == model.mesh.nodes);
  CHECK(read.steps == 10);
  CHECK(std::holds_alternative<std::monostate>(read.response));
}
