#include <hdf5.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "common/config/toml_reader.hpp"
#include "common/error.hpp"
#include "common/hdf5/file.hpp"
#include "common/model/model_file.hpp"
#include "tests/common/one_tet_model.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/file_size_limit.hpp"

using Catch::Matchers::ContainsSubstring;
namespace hdf5 = irdm::hdf5;
using irdm::hdf5::Handle;

namespace {

/// Files as other programs can make them, by HDF5's own interface.
class ForeignFiles {
 public:
  ForeignFiles() { std::filesystem::create_directories(folder_); }
  ~ForeignFiles() { std::filesystem::remove_all(folder_); }

  std::string path(const char* name) const { return (folder_ / name).string(); }

  Handle create(const char* name) const {
    return {H5Fcreate(path(name).c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose};
  }

 private:
  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("irdm-test-foreign-" + std::to_string(::getpid()));
};

/// Writes an attribute of `count` texts, each "floating".
void write_texts(hid_t object, const char* name, hsize_t count, bool variable) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.get(), variable ? H5T_VARIABLE : 8);
  const Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose);
  const Handle attribute(
      H5Acreate2(object, name, type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  const std::vector<const char*> pointers(count, "floating");
  std::string text;
  for (hsize_t i = 0; i < count; ++i) text += "floating";
  const void* values = text.data();
  if (variable) values = pointers.data();
  REQUIRE(H5Awrite(attribute.get(), type.get(), values) >= 0);
}

}  // namespace

TEST_CASE("a text attribute that is a list is refused, however long it is") {
  const ForeignFiles files;
  const hsize_t count = GENERATE(2, 3, 3000);
  const bool variable = GENERATE(false, true);
  write_texts(files.create("list.h5").get(), "support", count, variable);
  const hdf5::File file = hdf5::File::open(files.path("list.h5"));
  CHECK_THROWS_WITH(file.read_string_attribute("/", "support"),
                    ContainsSubstring("attribute support of / is not one text"));
}

TEST_CASE("a text attribute of one text is read, as h5py writes it and with one axis") {
  const ForeignFiles files;
  const bool variable = GENERATE(false, true);
  write_texts(files.create("one.h5").get(), "support", 1, variable);
  CHECK(hdf5::File::open(files.path("one.h5")).read_string_attribute("/", "support") == "floating");
}

TEST_CASE("a text attribute without any text is refused") {
  const ForeignFiles files;
  {
    const Handle file = files.create("none.h5");
    const Handle space(H5Screate(H5S_NULL), H5Sclose);
    const Handle attribute(
        H5Acreate2(file.get(), "support", H5T_C_S1, space.get(), H5P_DEFAULT, H5P_DEFAULT),
        H5Aclose);
  }
  CHECK_THROWS_WITH(hdf5::File::open(files.path("none.h5")).read_string_attribute("/", "support"),
                    ContainsSubstring("is not one text"));
}

TEST_CASE("a model whose support is a list of texts is refused by name") {
  const ForeignFiles files;
  irdm::Model model = irdm::test::one_tet_model(3);
  irdm::ModalResponse response;
  response.angular_frequency = Eigen::Vector2d(10, 20);
  response.decay_rate = Eigen::Vector2d(1, 2);
  response.shapes = irdm::RowMatrix<float>(irdm::RowMatrix<float>::Random(12, 2));
  model.response = response;
  {
    irdm::ModelFileWriter writer(files.path("model.h5"));
    writer.write_description(model);
    writer.write_modal(response);
    writer.commit();
  }
  {
    const Handle file(H5Fopen(files.path("model.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
    const Handle body(H5Gopen2(file.get(), "/body", H5P_DEFAULT), H5Gclose);
    REQUIRE(H5Adelete(body.get(), "support") >= 0);
    write_texts(body.get(), "support", 3000, true);
  }
  CHECK_THROWS_WITH(irdm::read_model(files.path("model.h5"), irdm::ResponseKind::kModal),
                    ContainsSubstring("attribute support of /body is not one text"));
}

TEST_CASE("a dataset in HDF5's external storage is refused, and what it names is not read") {
  const ForeignFiles files;
  std::ofstream(files.path("secret")) << "root:x:0:0";
  {
    const Handle file = files.create("external.h5");
    const hsize_t count = 10;
    const Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose);
    const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_external(creation.get(), files.path("secret").c_str(), 0, count);
    const Handle set(H5Dcreate2(file.get(), "texture", H5T_NATIVE_UINT8, space.get(), H5P_DEFAULT,
                                creation.get(), H5P_DEFAULT),
                     H5Dclose);
    REQUIRE(set.get() >= 0);
  }
  const hdf5::File file = hdf5::File::open(files.path("external.h5"));
  CHECK_THROWS_WITH(file.read<std::uint8_t>("/texture", {0}),
                    ContainsSubstring("dataset /texture lies in another file"));
}

TEST_CASE("a virtual dataset is refused, also where its source is gone and it reads as zero") {
  const ForeignFiles files;
  {
    const Handle file = files.create("virtual.h5");
    const hsize_t count = 4;
    const Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose);
    const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_virtual(creation.get(), space.get(), files.path("gone.h5").c_str(), "/shapes",
                   space.get());
    const Handle set(H5Dcreate2(file.get(), "shapes", H5T_NATIVE_DOUBLE, space.get(), H5P_DEFAULT,
                                creation.get(), H5P_DEFAULT),
                     H5Dclose);
    REQUIRE(set.get() >= 0);
  }
  const hdf5::File file = hdf5::File::open(files.path("virtual.h5"));
  CHECK_THROWS_WITH(file.read<double>("/shapes", {0}),
                    ContainsSubstring("dataset /shapes is put together from other datasets"));
}

TEST_CASE("links to other files are refused, on every part of a path") {
  const ForeignFiles files;
  {
    const Handle other = files.create("other.h5");
    const Handle group(H5Gcreate2(other.get(), "body", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                       H5Gclose);
    write_texts(group.get(), "support", 1, true);
    const Handle file = files.create("linked.h5");
    REQUIRE(H5Lcreate_external(files.path("other.h5").c_str(), "/body", file.get(), "body",
                               H5P_DEFAULT, H5P_DEFAULT) >= 0);
  }
  const hdf5::File file = hdf5::File::open(files.path("linked.h5"));
  CHECK_THROWS_WITH(file.read_string_attribute("/body", "support"),
                    ContainsSubstring("/body is a link to another file"));
  CHECK_THROWS_WITH(file.read<double>("/body/mass", {0}),
                    ContainsSubstring("another file") || ContainsSubstring("has no dataset"));
}

TEST_CASE("a file that is open elsewhere in this program is read, or is said to be open") {
  const ForeignFiles files;
  write_texts(files.create("open.h5").get(), "support", 1, true);
  const auto opened = [&](H5F_close_degree_t degree) {
    const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    H5Pset_fclose_degree(access.get(), degree);
    return Handle(H5Fopen(files.path("open.h5").c_str(), H5F_ACC_RDONLY, access.get()), H5Fclose);
  };
  {
    const Handle as_h5py = opened(H5F_CLOSE_STRONG);
    CHECK(hdf5::File::open(files.path("open.h5")).read_string_attribute("/", "support") ==
          "floating");
    CHECK(H5Aexists(as_h5py.get(), "support") > 0);  // ours was closed, not theirs
  }
  const Handle other = opened(H5F_CLOSE_SEMI);
  CHECK_THROWS_WITH(hdf5::File::open(files.path("open.h5")),
                    ContainsSubstring("open.h5: is open elsewhere in this program"));
}

TEST_CASE("a file that cannot be opened for want of descriptors is not called damaged") {
  const ForeignFiles files;
  files.create("sound.h5");
  rlimit before{};
  REQUIRE(::getrlimit(RLIMIT_NOFILE, &before) == 0);
  const rlimit none{3, before.rlim_max};
  REQUIRE(::setrlimit(RLIMIT_NOFILE, &none) == 0);
  std::string message;
  try {
    hdf5::File::open(files.path("sound.h5"));
  } catch (const irdm::Error& error) {
    message = error.what();
  }
  ::setrlimit(RLIMIT_NOFILE, &before);
  CHECK_THAT(message, ContainsSubstring("sound.h5: cannot be opened: Too many open files"));
  CHECK_NOTHROW(hdf5::File::open(files.path("sound.h5")));
}

TEST_CASE("a pipe in the place of a file is refused at once") {
  const ForeignFiles files;
  REQUIRE(::mkfifo(files.path("pipe").c_str(), 0600) == 0);
  CHECK_THROWS_WITH(hdf5::File::open(files.path("pipe")),
                    ContainsSubstring("pipe: is not a regular file"));
  CHECK_THROWS_WITH(irdm::TomlTable::parse_file(files.path("pipe")),
                    ContainsSubstring("pipe: is not a regular file"));
}

TEST_CASE("a text file of absurd size is refused before it is read") {
  const ForeignFiles files;
  std::ofstream(files.path("big.toml")) << "[[object]]";
  std::filesystem::resize_file(files.path("big.toml"), 3'000'000'000);
  CHECK_THROWS_WITH(irdm::TomlTable::parse_file(files.path("big.toml")),
                    ContainsSubstring("big.toml: has 3000000000 bytes; give a text file of at most "
                                      "1048576 bytes"));
}

TEST_CASE("a file that cannot be created leaves none, and names the cause") {
  const ForeignFiles files;
  CHECK_THROWS_WITH(hdf5::File::create(files.path("no/where.h5")),
                    ContainsSubstring("cannot be created: No such file or directory"));
  files.create("there.h5");
  CHECK_THROWS_WITH(hdf5::File::create(files.path("there.h5")),
                    ContainsSubstring("exists already"));
  const irdm::test::FileSizeLimit full(10);
  const auto path = std::filesystem::path(files.path("full.h5"));
  CHECK_THROWS_WITH(
      [&] {
        irdm::ModelFileWriter writer(path);
        writer.write_description(irdm::test::one_tet_model(3));
        writer.commit();
      }(),
      ContainsSubstring("File too large"));
  for (const auto& entry : std::filesystem::directory_iterator(path.parent_path())) {
    CAPTURE(entry.path());
    CHECK_FALSE(entry.path().filename().string().starts_with("full.h5"));
  }
}

TEST_CASE("an empty extent of a shape is a zero in messages") {
  const ForeignFiles files;
  {
    const Handle file = files.create("empty.h5");
    const hsize_t none = 0;
    const Handle space(H5Screate_simple(1, &none, nullptr), H5Sclose);
    const Handle set(H5Dcreate2(file.get(), "numbers", H5T_NATIVE_DOUBLE, space.get(), H5P_DEFAULT,
                                H5P_DEFAULT, H5P_DEFAULT),
                     H5Dclose);
  }
  CHECK_THROWS_WITH(hdf5::File::open(files.path("empty.h5")).read<double>("/numbers", {0, 3}),
                    ContainsSubstring("has shape (0), expected (any, 3)"));
}
