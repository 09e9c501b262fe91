#include <fstream>
#include <span>

#include "common/hdf5/file.hpp"
#include "common/model/model_file.hpp"
#include "precompute/check/lines.hpp"
#include "tests/check/dense_file.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/child_process.hpp"
#include "tests/support/temporary_folder.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using irdm::test::DenseCube;

namespace {

struct CheckRun {
  int status;
  std::string out;
  std::string err;
};

CheckRun run(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {IRDM_PROGRAM, "check"});
  test::ChildProcess process(arguments, {});
  const int status = process.wait();
  return {status, process.out(), process.err()};
}

void write_modal(const std::filesystem::path& path, const Model& model) {
  ModelFileWriter writer(path);
  writer.write_description(model);
  writer.write_modal(std::get<ModalResponse>(model.response));
  writer.commit();
}

// Writes R as one chunk a column, each with its checksum, into a file that has none.
void add_dense_with_checksums(const std::filesystem::path& path, const Model& model, double value) {
  const auto dof = static_cast<hsize_t>(model.degrees_of_freedom());
  const auto steps = static_cast<hsize_t>(model.steps);
  const hdf5::Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
  const hdf5::Handle group(
      H5Gcreate2(file.get(), "/response/dense", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
  const hsize_t shape[] = {dof, steps, dof};
  const hsize_t chunk[] = {1, steps, dof};
  const hdf5::Handle space(H5Screate_simple(3, shape, nullptr), H5Sclose);
  const hdf5::Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_chunk(creation.get(), 3, chunk);
  H5Pset_fletcher32(creation.get());
  const hdf5::Handle set(H5Dcreate2(group.get(), "R", H5T_NATIVE_DOUBLE, space.get(), H5P_DEFAULT,
                                    creation.get(), H5P_DEFAULT),
                         H5Dclose);
  const std::vector<double> values(dof * steps * dof, value);
  REQUIRE(H5Dwrite(set.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >=
          0);
}

// Changes one bit of the first place in the file where these bytes stand.
void flip(const std::filesystem::path& path, double needle) {
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  const auto at = bytes.find(std::string(reinterpret_cast<const char*>(&needle), sizeof needle));
  REQUIRE(at != std::string::npos);
  file.seekp(static_cast<std::streamoff>(at));
  file.put(static_cast<char>(bytes[at] ^ 1));
}

}  // namespace

TEST_CASE("check passes a good model file and says what it found") {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "cube.h5";
  write_modal(path, DenseCube(10).model);
  const CheckRun result = run({path.string()});
  CHECK(result.err.empty());
  CHECK(result.status == 0);
  for (const char* line :
       {"checksum", "modes", "momentum", "static compliance", "decay at T", "passivity",
        "stable force", "stiffness in a step", "virtual coupling", "wave speed"}) {
    CHECK_THAT(result.out, ContainsSubstring(line));
  }
  CHECK_THAT(result.out, !ContainsSubstring("FAIL"));
}

TEST_CASE("check fails a model file with a changed byte and names the line") {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "cube.h5";
  const Model model = DenseCube(10).model;
  write_modal(path, model);
  flip(path, std::get<ModalResponse>(model.response).decay_rate(3));
  const CheckRun result = run({path.string()});
  CHECK(result.status == 1);
  CHECK_THAT(result.out, ContainsSubstring("checksum             FAIL"));
  CHECK_THAT(result.err, ContainsSubstring("fails: checksum"));
}

TEST_CASE("check fails dense R with a changed byte by the checksum of its chunk") {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "cube.h5";
  const Model model = DenseCube(10).model;
  write_modal(path, model);
  constexpr double kValue = 1.2345e-6;
  add_dense_with_checksums(path, model, kValue);
  CHECK_THAT(run({path.string()}).out, ContainsSubstring("Fletcher32 of every chunk matches"));
  flip(path, kValue);
  const CheckRun result = run({path.string()});
  CHECK(result.status == 1);
  CHECK_THAT(result.err, ContainsSubstring("fails: dense response (dense)"));
}

TEST_CASE("check fails modes that cannot be, and goes on with the rest") {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "cube.h5";
  Model model = DenseCube(10).model;
  std::get<ModalResponse>(model.response).decay_rate(2) = -1.0;
  write_modal(path, model);
  const CheckRun result = run({path.string()});
  CHECK(result.status == 1);
  CHECK_THAT(result.err, ContainsSubstring("fails: modes"));
  CHECK_THAT(result.out, ContainsSubstring("checksum") &&
                             ContainsSubstring("decay_rate has a number that is not"));
}

TEST_CASE("check refuses what is no model file and what is wrong usage") {
  const test::TemporaryFolder folder;
  std::ofstream(folder.path() / "text.h5") << "no";
  CHECK(run({(folder.path() / "text.h5").string()}).status == 1);
  CHECK(run({(folder.path() / "none.h5").string()}).status == 1);
  CHECK(run({}).status == 2);
  CHECK(run({"a.h5", "--hand-mass", "0"}).status == 2);
  CHECK(run({"a.h5", "--delay", "-1"}).status == 2);
  CHECK(run({"--help"}).status == 0);
}

TEST_CASE("check fails a surface that is not that of the elements") {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "cube.h5";
  Model model = DenseCube(10).model;
  CHECK(precompute::surface_lines(model).empty());
  // Two nodes change their places in all triangles: still closed and outward.
  for (int& node : std::span(model.mesh.triangles.data(),
                             static_cast<std::size_t>(model.mesh.triangles.size()))) {
    if (node < 2) node = 1 - node;
  }
  const precompute::Report lines = precompute::surface_lines(model);
  REQUIRE(lines.size() == 1);
  CHECK(lines[0].verdict == precompute::Verdict::kFail);
  CHECK_THAT(lines[0].found, ContainsSubstring("triangles are no outer faces of elements"));
}
