#include <unistd.h>

#include <filesystem>
#include <functional>

#include "common/error.hpp"
#include "common/model/compressed_file.hpp"
#include "common/model/dense_file.hpp"
#include "common/model/model_file.hpp"
#include "tests/common/one_tet_model.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/sparse_dataset.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;

namespace {

// A single tetrahedron with two made-up modes: enough to exercise every field.
Model small_model() {
  Model model = irdm::test::one_tet_model(3);
  model.mesh.com_offset = Vector3(0.1, 0.2, 0.3);
  ModalResponse response;
  response.angular_frequency = Eigen::Vector2d(10, 20);
  response.decay_rate = Eigen::Vector2d(1, 2);
  response.shapes = RowMatrix<float>(RowMatrix<float>::Random(12, 2));
  response.centrifugal = RowMatrix<double>::Random(2, 6);
  response.gravity = AxisColumns::Random(2, 3);
  response.gravity_rest = AxisColumns::Random(12, 3);
  model.response = response;
  return model;
}

// Its nodes 0 and 2, and each with itself.
ResidualCompliance small_residual() {
  UpperBlocks upper;
  upper.row_start = {0, 2, 3, 4, 5};
  upper.nodes = {0, 2, 1, 2, 3};
  for (int k = 0; k < 5; ++k) {
    const UpperBlocks::Block part = UpperBlocks::Block::Random();
    const UpperBlocks::Block own = part * part.transpose() + UpperBlocks::Block::Identity();
    const UpperBlocks::Block block = k == 1 ? part : own;
    upper.blocks.insert(upper.blocks.end(), block.data(), block.data() + 9);
  }
  ResidualCompliance residual = both_halves(upper);
  residual.reduction = {6, 300.0, 0.015, 0.03, 0.1, 0.004, 0.02, 8, 1e-5};
  return residual;
}

// As symmetric as a reader wants it, with numbers that tell b, s and a apart.
double r_entry(int b, int s, int a) {
  return 1'000'000 + 1000 * b + 100 * s + a;
}

struct ModelFolder {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("irdm-test-model-" + std::to_string(::getpid()));
  ModelFolder() { std::filesystem::create_directories(path); }
  ~ModelFolder() { std::filesystem::remove_all(path); }
};

}  // namespace

TEST_CASE("model file gives back what was written, modal and dense") {
  const ModelFolder folder;
  const auto path = folder.path / "model.h5";
  const Model model = small_model();
  const auto& modal = std::get<ModalResponse>(model.response);
  {
    ModelFileWriter writer(path);
    writer.write_description(model);
    writer.write_modal(modal);
    writer.begin_dense(12, 3, Precision::kSingle);
    for (int b = 0; b < 12; ++b) {
      RowMatrix<float> column(3, 12);
      for (int s = 0; s < 3; ++s) {
        for (int a = 0; a < 12; ++a) column(s, a) = static_cast<float>(r_entry(b, s, a));
      }
      writer.write_dense_column(b, column.data());
    }
    RowMatrix<float> centrifugal(6 * 3, 12);
    for (int p = 0; p < 6; ++p) {
      for (int s = 0; s < 3; ++s) {
        for (int a = 0; a < 12; ++a) {
          centrifugal(3 * p + s, a) = static_cast<float>(1000 * p + 100 * s + a);
        }
      }
    }
    writer.write_dense_centrifugal(centrifugal.data());
    const RowMatrix<float> gravity = 2.0F * centrifugal.topRows(9);
    writer.write_dense_gravity(gravity.data());
    CHECK_FALSE(std::filesystem::exists(path));
    writer.commit();
  }
  const Model read = read_model(path, ResponseKind::kModal);
  CHECK(read.mesh.nodes == model.mesh.nodes);
  CHECK(read.mesh.triangles == model.mesh.triangles);
  CHECK(read.mesh.com_offset == model.mesh.com_offset);
  CHECK(read.body.inertia == model.body.inertia);
  CHECK(read.material.poisson_ratio == 0.49);
  CHECK(read.dt == 0.002);
  const auto& response = std::get<ModalResponse>(read.response);
  CHECK(response.angular_frequency == modal.angular_frequency);
  CHECK(std::get<RowMatrix<float>>(response.shapes) == std::get<RowMatrix<float>>(modal.shapes));
  CHECK(response.centrifugal == modal.centrifugal);
  CHECK(has_centrifugal(read));
  CHECK(hdf5::File::open(path).read_string_attribute(kModalCentrifugal, "order") ==
        "xx yy zz yz xz xy");
  CHECK(hdf5::File::open(path).read_string_attribute(kDenseCentrifugal, "unit") == "m s^2");

  CHECK(response.gravity == modal.gravity);
  CHECK(response.gravity_rest == modal.gravity_rest);
  CHECK(has_gravity(read));
  CHECK(hdf5::File::open(path).read_string_attribute(kModalGravity, "unit") == "kg^1/2");
  CHECK(hdf5::File::open(path).read_string_attribute(kModalGravityRest, "unit") == "s^2");
  CHECK(hdf5::File::open(path).read_string_attribute(kDenseGravity, "unit") == "s^2");

  const Model dense_model = read_model(path, ResponseKind::kDense);
  const auto& dense = std::get<DenseResponse>(dense_model.response);
  const auto& values = std::get<std::vector<float>>(dense.values);
  CHECK(values[(7 * 12 + 5) * 3 + 2] ==
        static_cast<float>(r_entry(7, 2, 5)));  // b = 7, a = 5, s = 2
  const auto& spun = std::get<std::vector<float>>(dense.centrifugal);
  CHECK(spun[(4 * 12 + 5) * 3 + 2] == 4205.0f);  // product 4, a = 5, s = 2
  CHECK(has_gravity(dense_model));
  CHECK(dense.gravity.sag(5, 1) == 2.0 * 1205.0);  // axis 1, a = 5, s = 2
  const auto& approach = std::get<std::vector<float>>(dense.gravity.approach);
  CHECK(approach[(1 * 12 + 5) * 3 + 2] == 0.0F);
  CHECK(approach[(1 * 12 + 5) * 3 + 0] == -400.0F);
}

TEST_CASE("model file gives back what modes that are left out add") {
  const ModelFolder folder;
  const auto path = folder.path / "model.h5";
  Model model = small_model();
  const ResidualCompliance residual = small_residual();
  std::get<ModalResponse>(model.response).residual = residual;
  {
    ModelFileWriter writer(path);
    writer.write_description(model);
    writer.write_modal(std::get<ModalResponse>(model.response));
    writer.commit();
  }
  CHECK(hdf5::File::open(path).shape(kResidualBlocks) == hdf5::Shape({5, 3, 3}));
  const Model read = read_model(path, ResponseKind::kModal);
  const ResidualCompliance& found = std::get<ModalResponse>(read.response).residual;
  CHECK(found.row_start == residual.row_start);
  CHECK(found.nodes == std::vector<int>{0, 2, 1, 0, 2, 3});
  CHECK(found.blocks == residual.blocks);
  CHECK(found.diagonal(2) == residual.diagonal(2));
  CHECK(found.reduction.elastic_modes == 6);
  CHECK(found.reduction.cut_off == 300.0);
  CHECK(found.reduction.samples == 8);
  CHECK(found.reduction.force_error == 0.004);
  CHECK(found.reduction.added_compliance == 1e-5);
}

TEST_CASE("model file of before there were responses to spin and gravity is read as ever") {
  const ModelFolder folder;
  const auto path = folder.path / "model.h5";
  Model model = small_model();
  std::get<ModalResponse>(model.response).centrifugal.resize(0, 0);
  std::get<ModalResponse>(model.response).gravity.resize(0, 3);
  {
    ModelFileWriter writer(path);
    writer.write_description(model);
    writer.write_modal(std::get<ModalResponse>(model.response));
    writer.begin_dense(12, 3, Precision::kDouble);
    const RowMatrix<double> column = RowMatrix<double>::Ones(3, 12);
    for (int b = 0; b < 12; ++b) writer.write_dense_column(b, column.data());
    writer.commit();
  }
  CHECK_FALSE(hdf5::File::open(path).exists(kModalCentrifugal));
  CHECK_FALSE(hdf5::File::open(path).exists(kDenseCentrifugal));
  CHECK_FALSE(has_centrifugal(read_model(path, ResponseKind::kModal)));
  CHECK_FALSE(has_centrifugal(read_model(path, ResponseKind::kDense)));
  CHECK_FALSE(hdf5::File::open(path).exists(kModalGravity));
  CHECK_FALSE(hdf5::File::open(path).exists(kModalGravityRest));
  CHECK_FALSE(has_gravity(read_model(path, ResponseKind::kModal)));
  CHECK_FALSE(has_gravity(read_model(path, ResponseKind::kDense)));
}

TEST_CASE("model file without commit leaves nothing behind") {
  const ModelFolder folder;
  { ModelFileWriter(folder.path / "model.h5").write_description(small_model()); }
  CHECK(std::filesystem::is_empty(folder.path));
}

TEST_CASE("model file that is missing, truncated, foreign or damaged is refused with its name") {
  const ModelFolder folder;
  const auto path = folder.path / "model.h5";
  CHECK_THROWS_WITH(read_model(path, ResponseKind::kModal), ContainsSubstring("no such file"));

  Model model = small_model();
  const auto write = [&] {
    ModelFileWriter writer(path);
    writer.write_description(model);
    writer.write_modal(std::get<ModalResponse>(model.response));
    writer.commit();
  };
  SECTION("no dense response") {
    write();
    CHECK_THROWS_WITH(read_model(path, ResponseKind::kDense),
                      ContainsSubstring("no dense response"));
  }
  SECTION("truncated") {
    write();
    std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
    CHECK_THROWS_WITH(read_model(path, ResponseKind::kModal),
                      ContainsSubstring("not a complete HDF5 file"));
  }
  SECTION("triangle out of range") {
    model.mesh.triangles(0, 0) = 99;
    write();
    CHECK_THROWS_WITH(read_model(path, ResponseKind::kModal), ContainsSubstring("points outside"));
  }
  SECTION("number that is not finite") {
    model.mesh.nodes(0, 0) = std::numeric_limits<double>::quiet_NaN();
    write();
    CHECK_THROWS_WITH(read_model(path, ResponseKind::kModal), ContainsSubstring("not finite"));
  }
  SECTION("mass that is not positive") {
    model.body.mass = 0;
    write();
    CHECK_THROWS_WITH(read_model(path, ResponseKind::kModal), ContainsSubstring("mass"));
  }
  SECTION("centrifugal force that is not finite") {
    std::get<ModalResponse>(model.response).centrifugal(1, 5) =
        std::numeric_limits<double>::infinity();
    write();
    CHECK_THROWS_WITH(read_model(path, ResponseKind::kModal), ContainsSubstring("centrifugal"));
  }
  SECTION("gravity that is not finite") {
    auto& response = std::get<ModalResponse>(model.response);
    response.gravity(1, 2) = std::numeric_limits<double>::quiet_NaN();
    write();
    CHECK_THROWS_WITH(read_model(path, ResponseKind::kModal),
                      ContainsSubstring(std::string(kModalGravity) + " has numbers"));
    response.gravity(1, 2) = 0.0;
    response.gravity_rest(3, 0) = std::numeric_limits<double>::infinity();
    write();
    CHECK_THROWS_WITH(read_model(path, ResponseKind::kModal),
                      ContainsSubstring(std::string(kModalGravityRest) + " has numbers"));
  }
  SECTION("gravity of another number of modes or nodes") {
    auto& response = std::get<ModalResponse>(model.response);
    const AxisColumns rest = response.gravity_rest;
    response.gravity_rest = AxisColumns::Ones(9, 3);
    write();
    CHECK_THROWS_WITH(read_model(path, ResponseKind::kModal), ContainsSubstring(kModalGravityRest));
    response.gravity_rest = rest;
    write();
    irdm::test::make_sparse(path, kModalGravity, {3, 3});
    CHECK_THROWS_WITH(read_model(path, ResponseKind::kModal), ContainsSubstring(kModalGravity));
    irdm::test::make_sparse(path, kModalGravity, {2, 6});
    CHECK_THROWS_WITH(read_model(path, ResponseKind::kModal), ContainsSubstring(kModalGravity));
  }
  SECTION("dense gravity of another shape or not finite") {
    const auto write_dense = [&](const RowMatrix<double>& gravity) {
      ModelFileWriter writer(path);
      writer.write_description(model);
      writer.begin_dense(12, 3, Precision::kDouble);
      const RowMatrix<double> column = RowMatrix<double>::Ones(3, 12);
      for (int b = 0; b < 12; ++b) writer.write_dense_column(b, column.data());
      writer.write_dense_gravity(gravity.data());
      writer.commit();
    };
    RowMatrix<double> gravity = RowMatrix<double>::Ones(9, 12);
    write_dense(gravity);
    CHECK(has_gravity(read_model(path, ResponseKind::kDense)));
    irdm::test::make_sparse(path, kDenseGravity, {3, 4, 12});
    CHECK_THROWS_WITH(
        read_model(path, ResponseKind::kDense),
        ContainsSubstring("/response/dense/gravity must have the shape (3, steps, 3n)"));
    gravity(4, 7) = std::numeric_limits<double>::infinity();
    write_dense(gravity);
    CHECK_THROWS_WITH(read_model(path, ResponseKind::kDense),
                      ContainsSubstring("/response/dense/gravity has numbers that are not finite"));
    CHECK_THROWS_WITH(read_streamed_model(path), ContainsSubstring("/response/dense/gravity"));
  }
  SECTION("residual compliance that is none") {
    const auto refused = [&](const std::function<void(ResidualCompliance&)>& spoil,
                             const std::string& message) {
      std::filesystem::remove(path);
      auto& residual = std::get<ModalResponse>(model.response).residual;
      residual = small_residual();
      spoil(residual);
      write();
      CHECK_THROWS_WITH(read_model(path, ResponseKind::kModal), ContainsSubstring(message));
    };
    refused([](auto& g) { g.blocks[0] = std::numeric_limits<float>::quiet_NaN(); }, "not finite");
    // Not the first number: where comparisons decide, it may hide behind another.
    refused([](auto& g) { g.blocks[9 + 5] = std::numeric_limits<float>::quiet_NaN(); },
            "not finite");
    refused([](auto& g) { g.blocks[9 + 5] = 100.0F; }, "more than to themselves");
    refused([](auto& g) { g.blocks[1] += 1.0F; }, "own compliance is not symmetric");
    refused([](auto& g) { g.blocks[0] = -1.0F; }, "own compliance is not symmetric or negative");
    refused([](auto& g) { g.nodes[1] = 4; }, "columns that are none");
    refused([](auto& g) { g.nodes[2] = 3; }, "columns that are none");
    refused([](auto& g) { g.reduction.force_error = -1.0; }, "has no force_error");
  }
  SECTION("negative frequency") {
    std::get<ModalResponse>(model.response).angular_frequency(0) = -1;
    write();
    CHECK_THROWS_WITH(read_model(path, ResponseKind::kModal),
                      ContainsSubstring("angular_frequency"));
  }
  SECTION("shapes that there is neither memory nor a number for") {
    write();
    // So many that their count does not fit into 64 bits, and room for none would be made.
    irdm::test::make_sparse(path, "/mesh/tets", {hsize_t{1} << 62, 4});
    CHECK_THROWS_WITH(
        read_model(path, ResponseKind::kModal),
        ContainsSubstring("/mesh/tets has shape") && ContainsSubstring("but not the numbers"));
    irdm::test::make_sparse(path, "/mesh/nodes", {hsize_t{1} << 40, 3});
    CHECK_THROWS_WITH(read_model(path, ResponseKind::kModal),
                      ContainsSubstring("but not the numbers"));
  }
}
