#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "common/model/model_file.hpp"
#include "common/response/modal_response.hpp"
#include "precompute/modal/elastic_statics.hpp"
#include "tests/precompute/program_run.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/child_process.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/file_size_limit.hpp"
#include "tests/support/small_disk.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::precompute;
using namespace irdm::test;

TEST_CASE("program writes a model whose dense columns are the closed form of its modes") {
  ProgramRun run;
  run.write("c.toml", kBox + kProgramMaterial +
                          "[response]\nsteps = 60\nstorage = \"both\"\nprecision = \"double\"\n");
  run.start("c.toml -o made/model.h5 --threads 1");
  INFO(run.err);
  REQUIRE(without_warnings(run.err).empty());
  CHECK_THAT(run.err,
             ContainsSubstring("the elements make it about 54 % too stiff") &&
                 ContainsSubstring(
                     "irdm-precompute: warning: more than 1 % of R is left at the last step; "
                     "raise response.steps or the damping\n"));
  REQUIRE(run.status == 0);
  CHECK_THAT(run.out, ContainsSubstring("free nodes (n)") && ContainsSubstring("BLAS kernel") &&
                          ContainsSubstring("columns of R  100 %") && !ContainsSubstring("\r"));

  const Model modal = read_model(run.model(), ResponseKind::kModal);
  const Model dense = read_model(run.model(), ResponseKind::kDense);
  CHECK(modal.mesh.surface_node_count() == 4 * 3 * 3 - 2 * 1 * 1);
  CHECK(modal.body.mass == Approx(110 * 0.12 * 0.1 * 0.08));
  CHECK((modal.mesh.com_offset - Vector3(0.06, 0.05, 0.04)).norm() < 1e-12);
  const auto& response = std::get<ModalResponse>(modal.response);
  const auto& phi = std::get<RowMatrix<double>>(response.shapes);
  CHECK(response.mode_count() == 3 * modal.mesh.nodes.rows() - 6);
  const RowMatrix<double> h = held_responses(response, modal.dt, modal.steps);
  const auto& r = std::get<std::vector<double>>(std::get<DenseResponse>(dense.response).values);
  const auto dof = static_cast<std::size_t>(phi.rows());
  for (const Eigen::Index s : {0, 1, 30, 59}) {
    const Eigen::MatrixXd exact = phi * h.row(s).asDiagonal() * phi.transpose();
    double error = 0.0;
    for (std::size_t b = 0; b < dof; ++b) {
      for (std::size_t a = 0; a < dof; ++a) {
        const double found = r[(b * dof + a) * 60 + static_cast<std::size_t>(s)];
        error = std::max(error, std::abs(found - exact(static_cast<Eigen::Index>(a),
                                                       static_cast<Eigen::Index>(b))));
      }
    }
    CHECK(error < 1e-12 * exact.cwiseAbs().maxCoeff());
  }

  // What a spin does: the same closed form with the modal centrifugal forces.
  REQUIRE(has_centrifugal(modal));
  REQUIRE(has_centrifugal(dense));
  const auto& spun =
      std::get<std::vector<double>>(std::get<DenseResponse>(dense.response).centrifugal);
  REQUIRE(spun.size() == 6 * dof * 60);
  for (const Eigen::Index s : {0, 30, 59}) {
    const Eigen::MatrixXd exact = phi * h.row(s).asDiagonal() * response.centrifugal;
    Eigen::MatrixXd found(exact.rows(), exact.cols());
    for (Eigen::Index p = 0; p < 6; ++p) {
      for (Eigen::Index a = 0; a < exact.rows(); ++a) {
        found(a, p) = spun[static_cast<std::size_t>((p * exact.rows() + a) * 60 + s)];
      }
    }
    CHECK((found - exact).cwiseAbs().maxCoeff() < 1e-12 * exact.cwiseAbs().maxCoeff());
  }
}

TEST_CASE("program removes what killed runs have left of its output, and leaves what is written") {
  ProgramRun run;
  run.write("c.toml", kBox + kProgramMaterial);
  ChildProcess killed({"/bin/true"});
  const std::string part = "made/model.h5.part-";
  const std::string gone = part + std::to_string(killed.pid());
  const std::string ours = part + std::to_string(::getpid());
  killed.wait();
  run.write(gone, "half of a model");
  run.write(ours, "of a process that lives");
  run.start("c.toml -o made/model.h5");
  CHECK(run.status == 0);
  CHECK(std::filesystem::exists(run.model()));
  CHECK_FALSE(std::filesystem::exists(run.path() / gone));
  CHECK(std::filesystem::exists(run.path() / ours));
}

TEST_CASE("the body in a model file is what its nodes and masses make, about the origin") {
  ProgramRun run;
  run.write("c.toml", kBox + kProgramMaterial);
  run.start("c.toml -o made/model.h5");
  REQUIRE(run.status == 0);
  const Model model = read_model(run.model(), ResponseKind::kModal);
  Vector3 first = Vector3::Zero();
  Matrix3 inertia = Matrix3::Zero();
  for (Eigen::Index i = 0; i < model.mesh.nodes.rows(); ++i) {
    const Vector3 x = model.mesh.nodes.row(i).transpose();
    first += model.mesh.node_mass(i) * x;
    inertia -= model.mesh.node_mass(i) * skew(x) * skew(x);
  }
  CHECK(first.norm() < 1e-15);
  CHECK(model.mesh.node_mass.sum() == Approx(model.body.mass).epsilon(1e-13));
  CHECK((inertia - model.body.inertia).norm() < 1e-13 * inertia.norm());
  CHECK_THROWS_WITH(read_model(run.model(), ResponseKind::kDense),
                    ContainsSubstring("no dense response"));
}

TEST_CASE("command line overrides storage, and a mesh file works from end to end") {
  ProgramRun run;
  run.write("m.msh", kMsh);
  run.write("c.toml",
            "[mesh]\nfile = \"m.msh\"\n" + kProgramMaterial + "[response]\nsteps = 900\n");
  run.start("c.toml -o made/model.h5 --storage dense --method modal");
  CHECK(run.status == 0);
  CHECK(std::filesystem::exists(run.model()));
  CHECK_NOTHROW(read_model(run.model(), ResponseKind::kDense));
  CHECK_THROWS_WITH(read_model(run.model(), ResponseKind::kModal),
                    ContainsSubstring("no modal response"));
}

TEST_CASE("high Poisson ratio is warned about, unless the tetrahedra are quadratic") {
  ProgramRun run;
  run.write("c.toml", kBox + with_words(kProgramMaterial, "0.3", "0.49"));
  run.start("c.toml -o made/model.h5");
  CHECK(run.status == 0);
  CHECK_THAT(run.err,
             ContainsSubstring("warning: linear tetrahedra lock at Poisson's ratio 0.49") &&
                 ContainsSubstring("about 56 % too stiff under a fingertip") &&
                 ContainsSubstring("set mesh.order = 2"));
  run.write("c.toml", with_words(kBox, "order = 1", "order = 2") +
                          with_words(kProgramMaterial, "0.3", "0.49"));
  run.start("c.toml -o made/model.h5");
  CHECK(run.status == 0);
  CHECK_THAT(run.err, !ContainsSubstring("lock"));
}

TEST_CASE("a model of quadratic tetrahedra has their mid-side nodes at the surface") {
  ProgramRun run;
  run.write("c.toml", with_words(kBox, "order = 1", "order = 2") + kProgramMaterial);
  run.start("c.toml -o made/model.h5");
  REQUIRE(run.status == 0);
  const Model model = read_model(run.model(), ResponseKind::kModal);
  CHECK(model.mesh.tets.cols() == 10);
  CHECK(model.mesh.surface_node_count() == 7 * 5 * 5 - 5 * 3 * 3);
  CHECK(model.mesh.triangles.rows() == 4 * 2 * 2 * (3 * 2 + 2 * 2 + 2 * 3));
  CHECK(std::get<ModalResponse>(model.response).mode_count() == 3 * model.mesh.nodes.rows() - 6);
}

TEST_CASE("a fixed body does not move where it is clamped and has all other modes") {
  ProgramRun run;
  run.write("c.toml", kBox + kProgramMaterial +
                          "[response]\nsupport = \"fixed\"\n[support]\n"
                          "half_space = { point = [0, 0, 0], normal = [0, 0, 1] }\n");
  run.start("c.toml -o made/model.h5");
  REQUIRE(run.status == 0);
  CHECK_THAT(run.out, ContainsSubstring("clamped nodes                     12"));
  const Model model = read_model(run.model(), ResponseKind::kModal);
  CHECK(model.body.support == Support::kFixed);
  const auto& response = std::get<ModalResponse>(model.response);
  CHECK(response.mode_count() == 3 * (model.mesh.nodes.rows() - 12));
  const auto& phi = std::get<RowMatrix<float>>(response.shapes);
  for (int i = 0; i < model.mesh.surface_node_count(); ++i) {
    const bool clamped = std::abs(model.mesh.rest_position(i).z() + 0.04) < 1e-9;
    CHECK(phi.middleRows<3>(3 * i).isZero(0.0f) == clamped);
  }
}

TEST_CASE("a mesh file in millimetres becomes metres, and the wrong unit is hinted at") {
  ProgramRun run;
  std::string large = kMsh;
  for (const char* line : {"2 1 0 0\n", "3 0 1 0\n", "4 0 0 1\n", "5 1 1 1\n"}) {
    std::string scaled = line;
    for (std::size_t i = 2; i < scaled.size(); ++i) {
      if (scaled[i] == '1') scaled.replace(i++, 1, "120");
    }
    large = with_words(large, line, scaled);
  }
  run.write("m.msh", large);
  run.write("c.toml", "[mesh]\nfile = \"m.msh\"\n" + kProgramMaterial);
  run.start("c.toml -o made/model.h5");
  CHECK(run.status == 0);
  CHECK_THAT(run.err, ContainsSubstring("the body is 120 x 120 x 120 m") &&
                          ContainsSubstring("mesh.unit = \"mm\""));
  run.write("c.toml", "[mesh]\nfile = \"m.msh\"\nunit = \"mm\"\n" + kProgramMaterial);
  run.start("c.toml -o made/model.h5");
  CHECK(run.status == 0);
  CHECK_THAT(run.err, !ContainsSubstring("mesh.unit"));
  CHECK_THAT(run.out, ContainsSubstring("bounding box                      0.12 x 0.12 x 0.12 m"));
  const Model model = read_model(run.model(), ResponseKind::kModal);
  CHECK(model.body.mass == Approx(110 * 0.12 * 0.12 * 0.12 / 2.0));
}

TEST_CASE("wrong usage ends with status 2, help and version with 0") {
  ProgramRun run;
  for (const char* arguments :
       {"", "c.toml", "-o made/model.h5", "c.toml -o made/model.h5 --storage sparse",
        "c.toml -o made/model.h5 --method magic", "c.toml -o made/model.h5 --threads 0",
        "c.toml -o made/model.h5 --frobnicate"}) {
    run.start(arguments);
    CHECK(run.status == 2);
  }
  run.start("--help");
  CHECK(run.status == 0);
  CHECK_THAT(run.out, ContainsSubstring("--storage") && ContainsSubstring("--threads") &&
                          ContainsSubstring("--method"));
  run.start("--version");
  CHECK(run.status == 0);
  CHECK_THAT(run.out, Catch::Matchers::StartsWith("irdm-precompute "));
}

TEST_CASE("bad configuration: one line on stderr, status 1, no output") {
  ProgramRun run;
  const auto refused = [&](const std::string& text, const std::string& message) {
    CAPTURE(text);
    run.write("c.toml", text);
    run.check_refused(message);
  };
  run.check_refused("no such file");
  refused("", "mesh is missing");
  refused((kBox + kProgramMaterial).substr(0, 40), "c.toml:2");
  refused(kBox + with_words(kProgramMaterial, "2000", "\"soft\""),
          "c.toml:5: material.youngs_modulus");
  refused(kBox + kProgramMaterial + "typo = 1\n", "material.typo is not a known key");
  refused(kBox + with_words(kProgramMaterial, "2000", "nan"), "material.youngs_modulus is nan");
  refused(kBox + with_words(kProgramMaterial, "0.3", "0.5"), "material.poisson_ratio is 0.5");
  refused(kBox + with_words(kProgramMaterial, "110", "-110"), "material.density is -110");
  refused(kBox + kProgramMaterial + "[response]\ndt = 0\n", "response.dt is 0");
  const std::string fixed =
      kBox + kProgramMaterial + "[response]\nsupport = \"fixed\"\n[support]\n";
  refused(kBox + kProgramMaterial + "[response]\nsupport = \"fixed\"\n", "support is missing");
  refused(fixed + "group = \"base\"\n", "has no group 'base'");
  refused(fixed + "box = { min = [5, 5, 5], max = [6, 6, 6] }\n", "holds no node");
  refused(fixed + "box = { min = [0, 0, 0], max = [6, 6, 6] }\n", "every node of the surface");
  refused(fixed + "box = { min = [0, 0, 0], max = [1, 0, 0] }\n", "can still turn");
  const std::string stepped = "[response]\nmethod = \"time-stepping\"\n";
  refused(kBox + kProgramMaterial + stepped, "time-stepping gives R in dense form only");
  refused(kBox + kProgramMaterial + stepped + "storage = \"both\"\n",
          "time-stepping gives R in dense form only");
  refused(with_words(kBox, "order = 1", "order = 2") + kProgramMaterial + stepped +
              "storage = \"dense\"\n",
          "linear tetrahedra only");
  refused(kBox + kProgramMaterial + stepped +
              "storage = \"dense\"\nsupport = \"fixed\"\n[support]\n"
              "box = { min = [0, 0, 0], max = [0, 1, 1] }\n",
          "floating bodies only");
}

TEST_CASE("a part of the modes that cannot be had is told in one line") {
  ProgramRun run;
  const auto refused = [&](const std::string& lines, const std::string& message) {
    CAPTURE(lines);
    run.write("c.toml", kBox + kProgramMaterial + lines);
    run.check_refused(message);
  };
  refused("[modes]\ncount = 100\n", "at most half of them are computed one by one");
  refused("[modes]\nhighest_frequency = 1.0\n", "no mode is as low as 1");
  refused("[modes]\nhighest_frequency = 1e5\n", "at most half of them are computed one by one");
  refused("[modes]\ncount = 5\n[response]\nstorage = \"both\"\n", "dense R is made of all modes");
  refused("[modes]\ncount = 5\n[response]\nmethod = \"time-stepping\"\nstorage = \"dense\"\n",
          "[modes] belongs to method = \"modal\"");
}

TEST_CASE("the program says how well some modes stand for all of them, in the file as well") {
  ProgramRun run;
  run.write("c.toml", "[mesh]\nbox = { size = [0.12, 0.1, 0.08], cells = [6, 5, 4] }\norder = 1\n" +
                          kProgramMaterial + "[modes]\ncount = 60\n");
  run.start("c.toml -o made/model.h5");
  INFO(run.err);
  REQUIRE(run.status == 0);
  CHECK_THAT(run.out, ContainsSubstring("error of force under a fingertip"));
  const Model model = read_model(run.model(), ResponseKind::kModal);
  const auto& response = std::get<ModalResponse>(model.response);
  CHECK(response.mode_count() == 60);
  const ModeReduction& reduction = response.residual.reduction;
  CHECK(reduction.elastic_modes == 3 * model.mesh.nodes.rows() - 6);
  CHECK(reduction.contact_radius == 0.015);
  CHECK(reduction.samples == 8);
  CHECK((reduction.force_error > 0.0 && reduction.force_error < 0.02));
  CHECK((reduction.shape_error > 0.0 && reduction.shape_error < 0.2));
  std::filesystem::rename(run.model(), run.path() / "first.h5");
  run.start("c.toml -o made/model.h5 --threads 1");
  REQUIRE(run.status == 0);
  CHECK(file_content(run.model()) == file_content(run.path() / "first.h5"));
}

TEST_CASE("bad mesh: one line on stderr, status 1, no output") {
  ProgramRun run;
  run.write("c.toml", "[mesh]\nfile = \"m.msh\"\n" + kProgramMaterial);
  const auto refused = [&](const std::string& text, const std::string& message) {
    CAPTURE(text);
    run.write("m.msh", text);
    run.check_refused(message);
  };
  run.check_refused("m.msh: no such file");
  refused("", "m.msh: is empty");
  refused(kMsh.substr(0, 100), "truncated");
  refused(with_words(kMsh, "2 1 0 0", "2 one 0 0"), "m.msh:7: 'one' is not a number");
  refused(with_words(kMsh, "2 1 0 0", "2 nan 0 0"), "not finite");
  refused(with_words(kMsh, "2 1 0 0", "2 inf 0 0"), "not finite");
  refused(with_words(kMsh, "1 2 3 4", "2 1 3 4"), "1 of 2 tetrahedra are inverted");
  refused(with_words(with_words(kMsh, "1 2 3 4", "2 1 3 4"), "2 3 4 5", "3 2 4 5"),
          "all 2 tetrahedra are inverted");
  refused(with_words(kMsh, "5 1 1 1", "5 0.25 0.25 0.5"),
          "the tetrahedron around (0.3125, 0.3125, 0.375) has zero volume");
  refused(with_words(kMsh, "5 1 1 1", "5 0.33333333 0.33333333 0.33333337"),
          "the lowest modes are lost in rounding beside the stiffness of the tetrahedron around "
          "(0.333333, 0.333333, 0.333333) m, which is flat (mean ratio");
  const std::string eight_nodes = with_words(with_words(kMsh, "$Nodes\n5", "$Nodes\n8"),
                                             "5 1 1 1\n", "5 9 0 0\n6 10 0 0\n7 9 1 0\n8 9 0 1\n");
  refused(with_words(eight_nodes, "2 3 4 5", "5 6 7 8"), "2 pieces");
}

TEST_CASE("a surface in millimetres is filled, its edge length is in metres", "[slow]") {
  ProgramRun run;
  // A cube of 120 mm, which has 8 nodes.
  const std::string cube =
      "v 0 0 0\nv 0 0 120\nv 0 120 0\nv 0 120 120\nv 120 0 0\nv 120 0 120\nv 120 120 0\n"
      "v 120 120 120\nf 1 2 4\nf 1 4 3\nf 5 7 8\nf 5 8 6\nf 1 5 6\nf 1 6 2\nf 3 4 8\nf 3 8 7\n"
      "f 1 3 7\nf 1 7 5\nf 2 6 8\nf 2 8 4\n";
  const auto config = [](const std::string& more) {
    return "[mesh]\nfile = \"s.obj\"\n" + more + "\n" + kProgramMaterial;
  };
  run.write("s.obj", cube);
  run.write("c.toml", config("unit = \"mm\"\nedge_length = 0.04"));
  run.start("c.toml -o made/model.h5");
  CAPTURE(run.err);
  REQUIRE(run.status == 0);
  CHECK_THAT(run.out, ContainsSubstring("bounding box                      0.12 x 0.12 x 0.12 m"));
  const Model model = read_model(run.model(), ResponseKind::kModal);
  CHECK(model.body.mass == Approx(110 * 0.12 * 0.12 * 0.12));
  CHECK(model.mesh.nodes.rows() > 20);
  std::filesystem::remove(run.model());
  run.write("c.toml", config("edge_length = 0.04"));  // the unit forgotten: of 120 m
  run.check_refused("s.obj: mesh.edge_length is 0.000192");
  run.write("c.toml", config("unit = \"mm\"\nedge_length = 40"));
  run.check_refused("s.obj: mesh.edge_length is 192.45");
  run.write("s.obj", with_words(cube, "f 2 8 4\n", ""));
  run.check_refused("s.obj: the surface is open at 3 edges, for instance from (");
}

TEST_CASE("time stepping gives the dense R of the modes, the same for any number of threads",
          "[slow]") {
  ProgramRun run;
  const std::string box = with_words(kBox, "[3, 2, 2]", "[2, 1, 1]");
  run.write("c.toml", box + kProgramMaterial +
                          "[response]\nsteps = 12\nprecision = \"double\"\nstorage = \"dense\"\n"
                          "[time_stepping]\nfirst_step = 1e-5\nlast_step = 1e-5\n");
  const auto numbers = [&](const std::string& options) {
    run.start("c.toml -o made/model.h5 " + options);
    CAPTURE(run.err);
    REQUIRE(run.status == 0);
    const Model model = read_model(run.model(), ResponseKind::kDense);
    return std::get<std::vector<double>>(std::get<DenseResponse>(model.response).values);
  };
  const std::vector<double> modal = numbers("");
  CHECK_THAT(run.out, ContainsSubstring("elastic modes"));
  const std::vector<double> stepped = numbers("--method time-stepping --threads 1");
  CHECK_THAT(run.out, !ContainsSubstring("elastic modes") && ContainsSubstring("time stepping: "));
  CHECK(stepped == numbers("--method time-stepping --threads 2"));
  REQUIRE(stepped.size() == modal.size());
  double error = 0.0;
  double largest = 0.0;
  for (std::size_t i = 0; i < modal.size(); ++i) {
    error = std::max(error, std::abs(stepped[i] - modal[i]));
    largest = std::max(largest, std::abs(modal[i]));
  }
  CHECK(error < 1e-3 * largest);
}

TEST_CASE("an output folder that does not exist is told") {
  ProgramRun run;
  run.write("c.toml", kBox + kProgramMaterial);
  run.start("c.toml -o nowhere/model.h5");
  CHECK(run.status == 1);
  CHECK(std::count(run.err.begin(), run.err.end(), '\n') == 1);
  CHECK_THAT(run.err, ContainsSubstring("nowhere/model.h5"));
}

TEST_CASE("SIGINT and SIGTERM leave neither the model nor its temporary file") {
  for (const int signal : {SIGINT, SIGTERM}) {
    ProgramRun run;
    // Long enough to be interrupted while dense R is written.
    run.write("c.toml", "[mesh]\nbox = { size = [1, 1, 1], cells = [6, 6, 6] }\norder = 1\n" +
                            kProgramMaterial + "[response]\nsteps = 500\nstorage = \"dense\"\n");
    ChildProcess process = run.begin("c.toml -o made/model.h5");
    const auto writing = [&] {
      for (const auto& entry : std::filesystem::directory_iterator(run.path() / "made")) {
        if (std::filesystem::file_size(entry.path()) > 1'000'000) return true;
      }
      return false;
    };
    REQUIRE(eventually(writing, ChildProcess::kDeadlineMs));
    process.signal(signal);
    CHECK(process.wait() == -signal);
    CHECK(std::filesystem::is_empty(run.path() / "made"));
  }
}

namespace {

// A folder with a gmsh that begins a file in its folder, says its process and never ends, and one
// for temporary files.
struct EndlessGmsh : ProgramRun {
  std::filesystem::path temporary = path() / "tmp";

  EndlessGmsh() {
    std::filesystem::create_directories(path() / "bin");
    std::filesystem::create_directory(temporary);
    const std::filesystem::path program = path() / "bin" / "gmsh";
    write("bin/gmsh", "#!/bin/sh\n: > begun\necho $$ > '" + pid_file().string() + ".new'\nmv '" +
                          pid_file().string() + ".new' '" + pid_file().string() +
                          "'\nexec sleep 100000\n");
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    write("a.geo", "SetFactory(\"OpenCASCADE\");\nBox(1) = {0, 0, 0, 1, 1, 1};\n");
    write("c.toml", "[mesh]\nfile = \"a.geo\"\n" + kProgramMaterial);
  }
  std::filesystem::path pid_file() const { return path() / "pid"; }
  ChildProcess begin() const {
    return ChildProcess({IRDM_PROGRAM, "c.toml", "-o", model().string()},
                        {.folder = path(),
                         .environment = {"TMPDIR=" + temporary.string(),
                                         "PATH=" + (path() / "bin").string() + ":/usr/bin:/bin"}});
  }
  // Waits for it.
  pid_t gmsh() const {
    REQUIRE(
        eventually([&] { return std::filesystem::exists(pid_file()); }, ChildProcess::kDeadlineMs));
    pid_t pid = 0;
    std::ifstream(pid_file()) >> pid;
    return pid;
  }
};

// A process that has ended and waits for init is gone, too.
bool is_gone(pid_t pid) {
  std::ifstream stat("/proc/" + std::to_string(pid) + "/stat");
  std::string number;
  std::string name;
  std::string state;
  return !(stat >> number >> name >> state) || state == "Z" || state == "X";
}

}  // namespace

TEST_CASE("a signal that ends the program ends gmsh, too, and leaves no temporary folder") {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    CAPTURE(signal);
    EndlessGmsh run;
    ChildProcess process = run.begin();
    const pid_t gmsh = run.gmsh();
    CHECK_FALSE(std::filesystem::is_empty(run.temporary));
    process.signal(signal);
    CHECK(process.wait() == -signal);
    CHECK(is_gone(gmsh));
    CHECK(std::filesystem::is_empty(run.temporary));
    CHECK(std::filesystem::is_empty(run.path() / "made"));
  }
}

TEST_CASE("gmsh ends with a program that is killed") {
  EndlessGmsh run;
  ChildProcess process = run.begin();
  const pid_t gmsh = run.gmsh();
  process.signal(SIGKILL);
  CHECK(process.wait() == -SIGKILL);
  CHECK(eventually([&] { return is_gone(gmsh); }, ChildProcess::kDeadlineMs));
}

TEST_CASE("no space for TetGen's files: that is what is said") {
  const auto disk = small_disk("tmpfs", "size=64k");
  if (!disk) return;
  ProgramRun run;
  run.write("c.toml", "[mesh]\nbox = { size = [1, 1, 1], cells = [8, 8, 8] }\n" + kProgramMaterial);
  // A name that the program's children have for it, too.
  const std::string folder = with_words(disk->path().string(), "self", std::to_string(::getpid()));
  const FinishedProgram ended =
      run_to_end({IRDM_PROGRAM, "c.toml", "-o", run.model().string()},
                 {.folder = run.path(), .environment = {"TMPDIR=" + folder}});
  CHECK(ended.status == 1);
  CHECK_THAT(ended.err, ContainsSubstring("no space is left for temporary files; make room there, "
                                          "or set TMPDIR"));
  CHECK(std::filesystem::is_empty(disk->path()));
}

TEST_CASE("a model that does not fit on the disk: one error, and nothing is left of it") {
  ProgramRun run;
  run.write("c.toml", kBox + kProgramMaterial);
  const FinishedProgram ended =
      run_to_end(on_full_disk(10'000, {IRDM_PROGRAM, "c.toml", "-o", run.model().string()}),
                 {.folder = run.path()});
  CHECK(ended.status == 1);
  const std::string error = without_warnings(ended.err);
  CHECK(std::count(error.begin(), error.end(), '\n') == 1);
  CHECK_THAT(error, Catch::Matchers::StartsWith("irdm-precompute: error: ") &&
                        ContainsSubstring("check free space"));
  CHECK(std::filesystem::is_empty(run.path() / "made"));
}
