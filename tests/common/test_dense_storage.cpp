#include <fstream>

#include "common/error.hpp"
#include "common/model/model_file.hpp"
#include "tests/common/one_tet_model.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;

namespace {

constexpr int kSteps = 40;

// Smooth, as responses are.
RowMatrix<float> column(int b, int dof) {
  RowMatrix<float> values(kSteps, dof);
  for (int s = 0; s < kSteps; ++s) {
    for (int a = 0; a < dof; ++a) {
      values(s, a) = static_cast<float>(std::exp(-0.05 * s) * std::cos(0.02 * s * (a + b + 1)));
    }
  }
  return values;
}

Model description() {
  return irdm::test::one_tet_model(kSteps);
}

struct File : irdm::test::TemporaryFolder {
  std::filesystem::path model = path() / "model.h5";
  int dof = description().degrees_of_freedom();

  void write() const {
    ModelFileWriter writer(model);
    writer.write_description(description());
    writer.begin_dense(dof, kSteps, Precision::kSingle);
    for (int b = 0; b < dof; ++b) writer.write_dense_column(b, column(b, dof).data());
    writer.commit();
  }
  /// R of 16-bit numbers, or with the filter of zfp; no column is there.
  void write_other_form(bool half) const {
    hdf5::File h5 = hdf5::File::create(model);
    write_description(h5, description());
    h5.create_group("/response/dense");
    const hdf5::Handle type(H5Tcopy(H5T_NATIVE_FLOAT), H5Tclose);
    const hdf5::Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    const auto n = static_cast<hsize_t>(dof);
    const hdf5::Shape shape{n, kSteps, n};
    H5Pset_chunk(creation.get(), 3, shape.data());
    if (half) {
      H5Tset_fields(type.get(), 15, 10, 5, 0, 10);
      H5Tset_size(type.get(), 2);
      H5Tset_ebias(type.get(), 15);
    } else {  // optional: it can be made where HDF5 does not have the filter
      H5Pset_filter(creation.get(), 32013, H5Z_FLAG_OPTIONAL, 0, nullptr);
    }
    const hdf5::Handle space(H5Screate_simple(3, shape.data(), nullptr), H5Sclose);
    const hdf5::Handle set(H5Dcreate2(h5.id(), kDenseR, type.get(), space.get(), H5P_DEFAULT,
                                      creation.get(), H5P_DEFAULT),
                           H5Dclose);
    REQUIRE(set.get() >= 0);
  }
  double largest_error() const {
    const Model read = read_model(model, ResponseKind::kDense);
    const auto& values =
        std::get<std::vector<float>>(std::get<DenseResponse>(read.response).values);
    float error = 0.0F;
    for (int b = 0; b < dof; ++b) {
      const RowMatrix<float> expected = column(b, dof);
      for (int a = 0; a < dof; ++a) {
        for (int s = 0; s < kSteps; ++s) {
          const auto at = static_cast<std::size_t>((b * dof + a) * kSteps + s);
          error = std::max(error, std::abs(values[at] - expected(s, a)));
        }
      }
    }
    return static_cast<double>(error);
  }
};

}  // namespace

TEST_CASE("dense R lies in chunks of whole steps of one column, with checksums") {
  const File file;
  {
    // 1200 degrees of freedom and 500 steps: columns of 2.4 MB, in three chunks.
    ModelFileWriter writer(file.model);
    writer.write_description(description());
    writer.begin_dense(1200, 500, Precision::kSingle);
    writer.commit();
  }
  const hdf5::Handle opened(H5Fopen(file.model.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  const hdf5::Handle set(H5Dopen2(opened.get(), kDenseR, H5P_DEFAULT), H5Dclose);
  const hdf5::Handle properties(H5Dget_create_plist(set.get()), H5Pclose);
  hdf5::Shape chunk(3);
  REQUIRE(H5Pget_chunk(properties.get(), 3, chunk.data()) == 3);
  CHECK(chunk == hdf5::Shape{1, 167, 1200});
  REQUIRE(H5Pget_nfilters(properties.get()) == 1);
  std::size_t none = 0;
  CHECK(H5Pget_filter2(properties.get(), 0, nullptr, &none, nullptr, 0, nullptr, nullptr) ==
        H5Z_FILTER_FLETCHER32);
}

TEST_CASE("dense R comes back bit for bit, and a flipped bit is noticed") {
  const File file;
  file.write();
  CHECK(file.largest_error() == 0.0);
  // Column 5 is somewhere in the file as it was written.
  const RowMatrix<float> values = column(5, file.dof);
  const std::string needle(reinterpret_cast<const char*>(values.data()), 400);
  std::ifstream in(file.model, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(in)), {});
  const std::size_t at = bytes.find(needle);
  REQUIRE(at != std::string::npos);
  bytes[at + 200] = static_cast<char>(bytes[at + 200] ^ 1);
  std::ofstream(file.model, std::ios::binary) << bytes;
  CHECK_THROWS_WITH(read_model(file.model, ResponseKind::kDense),
                    ContainsSubstring("checksum is wrong"));
}

TEST_CASE("the same model written twice is the same file") {
  const auto bytes = [] {
    const File file;
    file.write();
    std::ifstream in(file.model, std::ios::binary);
    return std::string((std::istreambuf_iterator<char>(in)), {});
  };
  const std::string once = bytes();
  CHECK(once.size() > 1000);
  CHECK(once == bytes());
}

TEST_CASE("a model with R in half precision or compressed by zfp is refused, whatever is read") {
  const auto [half, what] = GENERATE(std::tuple(true, "/response/dense/R is in half precision"),
                                     std::tuple(false, "/response/dense/R is compressed by zfp"));
  const File file;
  file.write_other_form(half);
  const std::string message = file.model.string() + ": " + what +
                              ", which is not read; compute the model again; irdm-precompute "
                              "compress makes dense R small";
  for (const ResponseKind kind :
       {ResponseKind::kModal, ResponseKind::kDense, ResponseKind::kCompressed}) {
    CHECK_THROWS_WITH(read_model(file.model, kind), message);
  }
  CHECK_THROWS_WITH(read_streamed_model(file.model), message);
  CHECK_THROWS_WITH(read_description(hdf5::File::open(file.model)), message);
}

TEST_CASE("contiguous dense R of earlier versions is read") {
  const File file;
  {
    hdf5::File h5 = hdf5::File::create(file.model);
    write_description(h5, description());
    const auto n = static_cast<hsize_t>(file.dof);
    h5.create_dataset<float>(kDenseR, {n, kSteps, n});
    for (int b = 0; b < file.dof; ++b) {
      h5.write_slab<float>(kDenseR, {static_cast<hsize_t>(b), 0, 0}, {1, kSteps, n},
                           column(b, file.dof).data());
    }
    h5.close();
  }
  CHECK(file.largest_error() == 0.0);
}

TEST_CASE("a description goes through memory and back") {
  hdf5::File file = hdf5::File::in_memory("description");
  write_description(file, description());
  const std::string image = file.image();
  const Model read = read_description(hdf5::File::from_image(image, "description"));
  CHECK(read.mesh.nodes == description().mesh.nodes);
  CHECK(read.steps == kSteps);
  CHECK(std::holds_alternative<std::monostate>(read.response));
  CHECK_THROWS_WITH(hdf5::File::from_image(image.substr(0, 100), "cut"), ContainsSubstring("cut"));
}

// HDF5 would take what stands behind two numbers for a third.
TEST_CASE("a part of a dataset of another rank is not read") {
  const File file;
  file.write();
  const hdf5::File open = hdf5::File::open(file.model);
  std::vector<float> numbers(1);
  CHECK_THROWS_WITH(open.read_slab<float>(kDenseR, {0, 0}, {1, 1}, numbers.data()),
                    ContainsSubstring("has not 2 axes"));
  CHECK_THROWS_WITH(open.read_slab<float>(kDenseR, {0, 0, 0, 0}, {1, 1, 1, 1}, numbers.data()),
                    ContainsSubstring("has not 4 axes"));
  open.read_slab<float>(kDenseR, {0, 2, 1}, {1, 1, 1}, numbers.data());
  CHECK(numbers[0] == column(0, file.dof)(2, 1));
}
