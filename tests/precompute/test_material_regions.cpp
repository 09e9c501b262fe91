#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include "common/hdf5/file.hpp"
#include "common/model/content_checksum.hpp"
#include "common/model/model_check.hpp"
#include "common/model/model_file.hpp"
#include "common/response/stored_response.hpp"
#include "precompute/check/check_model.hpp"
#include "precompute/fem/mass_properties.hpp"
#include "precompute/mesh/material_regions.hpp"
#include "precompute/mesh/surface.hpp"
#include "precompute/modal/elastic_modes.hpp"
#include "precompute/modal/elastic_statics.hpp"
#include "precompute/precompute.hpp"
#include "tests/precompute/discrete.hpp"
#include "tests/precompute/meshes.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/point_loads.hpp"
#include "tests/support/temporary_folder.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::precompute;
using irdm::test::Discrete;

namespace {

// A bar along x of so many cells, one across, each of six tetrahedra about a diagonal: a plane
// between two cells cuts no element.
TetMesh bar_mesh(double length, double side, int cells) {
  TetMesh mesh;
  mesh.nodes.resize(4 * (cells + 1), 3);
  const auto node = [](int i, int j, int k) { return 4 * i + 2 * j + k; };
  for (int i = 0; i <= cells; ++i) {
    for (int j = 0; j < 2; ++j) {
      for (int k = 0; k < 2; ++k) {
        mesh.nodes.row(node(i, j, k)) << length * i / cells, side * j, side * k;
      }
    }
  }
  mesh.tets.resize(6 * cells, 4);
  const std::array<std::array<int, 3>, 6> orders{
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
  for (int i = 0; i < cells; ++i) {
    for (int t = 0; t < 6; ++t) {
      std::array<int, 3> at{};
      std::array<int, 4> corner{node(i, 0, 0)};
      for (std::size_t step = 0; step < 3; ++step) {
        at[static_cast<std::size_t>(orders[static_cast<std::size_t>(t)][step])] = 1;
        corner[step + 1] = node(i + at[0], at[1], at[2]);
      }
      if (t >= 3) std::swap(corner[2], corner[3]);
      for (int c = 0; c < 4; ++c) mesh.tets(6 * i + t, c) = corner[static_cast<std::size_t>(c)];
    }
  }
  return mesh;
}

constexpr double kLength = 0.3;
constexpr double kSide = 0.05;
constexpr double kInterface = 0.1;  // from x = 0

// The body's own values up to the interface, others beyond it.
Material layered(const TetMesh& mesh, const Material& first, const MaterialValues& second) {
  Material material = first;
  const HalfSpace beyond{Vector3(kInterface, 0, 0), -Vector3::UnitX()};
  material.elements = element_materials(mesh, first, {{Region(beyond), second}}, false, "bar");
  return material;
}

const HalfSpace kFoot{Vector3::Zero(), Vector3::UnitX()};

}  // namespace

TEST_CASE("layers in series yield by the sum of their compliances") {
  const int order = GENERATE(1, 2);
  TetMesh mesh = bar_mesh(kLength, kSide, 6);
  if (order == 2) mesh = quadratic_mesh(mesh);
  const Material material =
      layered(mesh, {2000.0, 0.0, 1000.0, 0, 0}, {.youngs_modulus = 60000.0, .density = 1900.0});
  const std::vector<int> clamped = nodes_in(mesh, kFoot, "bar");
  const ElasticStatics statics(assemble_stiffness(mesh, material), mesh.nodes,
                               lumped_mass(mesh, material), clamped);
  // An even traction on the end: of a linear face a third to each corner, of a quadratic one to
  // each middle of an edge.
  Eigen::VectorXd force = Eigen::VectorXd::Zero(3 * mesh.node_count());
  const Surface surface = extract_surface(order == 1 ? mesh : bar_mesh(kLength, kSide, 6), "bar");
  for (Eigen::Index t = 0; t < surface.triangles.rows(); ++t) {
    std::array<Vector3, 3> x;
    for (std::size_t i = 0; i < 3; ++i) {
      x[i] = mesh.position(
          surface
              .nodes[static_cast<std::size_t>(surface.triangles(t, static_cast<Eigen::Index>(i)))]);
    }
    if (std::min({x[0].x(), x[1].x(), x[2].x()}) < kLength - 1e-9) continue;
    const double third = (x[1] - x[0]).cross(x[2] - x[0]).norm() / 6.0 / (kSide * kSide);
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3 at = order == 1 ? x[i] : Vector3(0.5 * (x[i] + x[(i + 1) % 3]));
      force(3 * test::node_at(mesh, at)) += third;
    }
  }
  REQUIRE(force.sum() == Approx(1.0).epsilon(1e-12));
  const Eigen::VectorXd u = statics.displacement(force);
  const double area = kSide * kSide;
  const double near = kInterface / (2000.0 * area);
  const double whole = near + (kLength - kInterface) / (60000.0 * area);
  for (int i = 0; i < mesh.node_count(); ++i) {
    if (mesh.nodes(i, 0) > kLength - 1e-9) CHECK(u(3 * i) == Approx(whole).epsilon(1e-9));
    if (std::abs(mesh.nodes(i, 0) - kInterface) < 1e-9) {
      CHECK(u(3 * i) == Approx(near).epsilon(1e-9));
    }
  }
}

namespace {

// tan(k1 L1) tan(k2 L2) = Z1 / Z2, Z = sqrt(E rho): displacement sin(k1 x), then cos(k2 (L - x)),
// displacement and force the same on both sides of the interface. Lowest omega [rad/s].
double lowest_axial_frequency(double E1, double rho1, double E2, double rho2) {
  const double c1 = std::sqrt(E1 / rho1);
  const double c2 = std::sqrt(E2 / rho2);
  const double ratio = std::sqrt(E1 * rho1 / (E2 * rho2));
  const double L1 = kInterface;
  const double L2 = kLength - kInterface;
  double low = 0.0;  // up to the first pole of either tangent the left side grows
  double high = 0.5 * std::numbers::pi / std::max(L1 / c1, L2 / c2);
  for (int i = 0; i < 100; ++i) {
    const double omega = 0.5 * (low + high);
    (std::tan(omega * L1 / c1) * std::tan(omega * L2 / c2) < ratio ? low : high) = omega;
  }
  return low;
}

// Of the mode of the clamped bar that carries most of a motion along x.
double axial_frequency(const Discrete& bar) {
  const ElasticModes modes = fixed_modes(bar.stiffness, bar.mass, nodes_in(bar.mesh, kFoot, "bar"));
  Eigen::VectorXd along = Eigen::VectorXd::Zero(bar.mass3.size());
  for (int i = 0; i < bar.mesh.node_count(); ++i) along(3 * i) = bar.mass(i);
  Eigen::Index axial = 0;
  (modes.shapes.transpose() * along).cwiseAbs().maxCoeff(&axial);
  return modes.angular_frequency(axial);
}

}  // namespace

TEST_CASE("a bar of two materials rings at the frequency of the closed form") {
  const double expected = lowest_axial_frequency(2000.0, 1000.0, 9000.0, 1900.0);
  std::vector<double> errors;
  for (const int cells : {6, 12, 24}) {
    const TetMesh mesh = bar_mesh(kLength, kSide, cells);
    const Discrete bar(mesh, layered(mesh, {2000.0, 0.0, 1000.0, 0, 0},
                                     {.youngs_modulus = 9000.0, .density = 1900.0}));
    errors.push_back(std::abs(axial_frequency(bar) / expected - 1.0));
  }
  CAPTURE(errors);
  CHECK(errors[2] < 1e-3);
  CHECK(errors[0] / errors[1] == Approx(4.0).epsilon(0.1));
  CHECK(errors[1] / errors[2] == Approx(4.0).epsilon(0.1));
}

TEST_CASE("mass, centre of mass and inertia of a layered box are those of two boxes") {
  const TetMesh mesh = bar_mesh(kLength, kSide, 6);
  const Material material = layered(mesh, {2000.0, 0.3, 1000.0, 0, 0}, {.density = 4000.0});
  const double area = kSide * kSide;
  const Eigen::Vector2d m(1000.0 * area * kInterface, 4000.0 * area * (kLength - kInterface));
  const Eigen::Vector2d length(kInterface, kLength - kInterface);
  const Eigen::Vector2d at(0.5 * kInterface, 0.5 * (kInterface + kLength));
  const double centre = m.dot(at) / m.sum();
  const double about_x = m.sum() * kSide * kSide / 6.0;
  double about_y = m.sum() * kSide * kSide / 12.0;
  for (int i = 0; i < 2; ++i) {
    about_y += m(i) * (length(i) * length(i) / 12.0 + std::pow(at(i) - centre, 2));
  }
  const MassProperties solid = solid_mass_properties(mesh, material);
  CHECK(solid.mass == Approx(m.sum()).epsilon(1e-12));
  CHECK((solid.centre_of_mass - Vector3(centre, 0.5 * kSide, 0.5 * kSide)).norm() < 1e-12);
  CHECK((solid.inertia - Vector3(about_x, about_y, about_y).asDiagonal().toDenseMatrix()).norm() <
        1e-12 * about_y);
  const MassProperties nodal = nodal_mass_properties(mesh.nodes, lumped_mass(mesh, material));
  CHECK(nodal.mass == Approx(m.sum()).epsilon(1e-12));
  CHECK((nodal.centre_of_mass - solid.centre_of_mass).norm() < 1e-12);
}

namespace {

std::string box_config(const std::string& more, const std::string& mesh = "cells = [6, 6, 4] }") {
  return "[mesh]\nbox = { size = [0.09, 0.09, 0.06], " + mesh +
         "\norder = 1\n[material]\nyoungs_modulus = 3000\npoisson_ratio = 0.3\ndensity = 1000\n" +
         more;
}

struct Made : irdm::test::TemporaryFolder {
  Summary make(const std::string& text, const std::string& name) const {
    std::ostringstream out;
    std::ofstream(path() / (name + ".toml")) << text;
    return precompute_model(load_config(path() / (name + ".toml")), file(name), {out, false});
  }
  std::filesystem::path file(const std::string& name) const { return path() / (name + ".h5"); }
  Model model(const std::string& name) const {
    return read_model(file(name), ResponseKind::kModal);
  }
  std::string checksum(const std::string& name) const {
    return *stored_content_checksum(hdf5::File::open(file(name)));
  }
};

const std::string kPrecise = "[response]\nprecision = \"double\"\n";

}  // namespace

TEST_CASE("regions of the body's own values leave every bit of R as it is", "[unsanitized]") {
  const Made made;
  const std::string cells = "cells = [3, 3, 2] }";
  made.make(box_config(kPrecise, cells), "one");
  made.make(
      box_config(kPrecise + "[[region]]\nbox = { min = [0, 0, 0], max = [0.09, 0.05, 0.04] }\n"
                            "youngs_modulus = 3000\ndensity = 1000\n"
                            "[[region]]\nball = { centre = [0.05, 0.05, 0.05], radius = 0.03 }\n"
                            "poisson_ratio = 0.3\n",
                 cells),
      "same");
  const Model one = made.model("one");
  const Model same = made.model("same");
  CHECK(one.material.elements.empty());
  CHECK_FALSE(same.material.elements.empty());
  const auto& a = std::get<ModalResponse>(one.response);
  const auto& b = std::get<ModalResponse>(same.response);
  CHECK(a.angular_frequency == b.angular_frequency);
  CHECK(std::get<RowMatrix<double>>(a.shapes) == std::get<RowMatrix<double>>(b.shapes));
  CHECK(a.centrifugal == b.centrifugal);
  CHECK(one.body.inertia == same.body.inertia);
  CHECK(made.checksum("one") != made.checksum("same"));  // of what is known of it
}

namespace {

const std::string kFixed =
    "[response]\nsupport = \"fixed\"\n"
    "[support]\nhalf_space = { point = [0, 0, 0], normal = [0, 0, 1] }\n";
const Vector3 kBall(0.03, 0.03, 0.045);
const std::string kStiffBall =
    "[[region]]\nball = { centre = [0.03, 0.03, 0.045], radius = 0.012 }\nyoungs_modulus = 6e4\n";

// Of each surface node along the box's height [m/N].
Eigen::VectorXd compliance(const Model& model) {
  const auto nodes = static_cast<std::size_t>(model.mesh.surface_node_count());
  return static_compliance(model, test::point_loads({nodes, Vector3::UnitZ()}));
}

}  // namespace

TEST_CASE("a stiff ball under the surface is felt above it, and not far from it", "[slow]") {
  const Made made;
  made.make(box_config(kFixed), "plain");
  const Summary summary = made.make(box_config(kFixed + kStiffBall), "ball");
  REQUIRE(summary.regions.size() == 2);
  CHECK(summary.regions[1].volume ==
        Approx(4.0 / 3.0 * std::numbers::pi * std::pow(0.012, 3)).epsilon(0.25));
  const Model plain = made.model("plain");
  const Model ball = made.model("ball");
  const Eigen::VectorXd before = compliance(plain);
  const Eigen::VectorXd after = compliance(ball);
  double above = 1.0;
  double far = 1.0;
  for (int i = 0; i < plain.mesh.surface_node_count(); ++i) {
    const Vector3 x = plain.mesh.rest_position(i) + plain.mesh.com_offset;
    if (x.z() < 1e-9) continue;  // clamped
    const double ratio = after(i) / before(i);
    // What is made stiffer somewhere yields nowhere more.
    CHECK(ratio < 1.0 + 1e-5);
    if (x.z() < 0.06 - 1e-9) continue;
    const double distance = (x - kBall).head<2>().norm();
    if (distance < 1e-6) above = ratio;
    if (distance > 0.08) far = std::min(far, ratio);
  }
  CAPTURE(above, far);
  CHECK(above < 0.85);
  CHECK(far > 0.995);
}

TEST_CASE("a model file with wrong values of its elements is refused") {
  const Made made;
  made.make(box_config(kStiffBall, "cells = [3, 3, 2] }"), "ball");
  Model model = made.model("ball");
  CHECK_FALSE(description_fault(model).has_value());
  const auto fault = [&](const auto& change) {
    Model changed = model;
    change(changed.material.elements);
    return description_fault(changed).value_or("");
  };
  CHECK_THAT(fault([](auto& e) { e.youngs_modulus[3] = -1.0; }),
             ContainsSubstring("youngs_modulus"));
  CHECK_THAT(fault([](auto& e) { e.poisson_ratio[3] = 0.5; }), ContainsSubstring("poisson_ratio"));
  CHECK_THAT(fault([](auto& e) { e.density[0] = std::nan(""); }), ContainsSubstring("density"));
  CHECK_THAT(fault([](auto& e) { e.density.pop_back(); }),
             ContainsSubstring("one number for each"));
  CHECK_THAT(fault([](auto& e) { e.youngs_modulus.clear(); }),
             ContainsSubstring("one number for each"));
  CHECK_THAT(fault([](auto& e) { e.region.back() = -1; }), ContainsSubstring("region"));
}

TEST_CASE("check shows the regions of a model and solves it anew with them", "[slow]") {
  const Made made;
  made.make(box_config(kStiffBall), "ball");
  std::ostringstream out;
  const Report report = check_model(made.file("ball"), {}, {out, false});
  const std::string table = format_report(report);
  CAPTURE(table);
  CHECK(failed_lines(report).empty());
  CHECK_THAT(table,
             ContainsSubstring("region 1") && ContainsSubstring("E 60000 Pa, nu 0.3, 1000 kg/m^3"));
  CHECK_THAT(table, ContainsSubstring("outside the regions") && ContainsSubstring("E 3000 Pa"));
  CHECK_THAT(table, ContainsSubstring("several materials"));
  for (const Line& line : report) {
    if (line.name == "static compliance") CHECK(line.verdict == Verdict::kOk);
    if (line.name == "region 1") CHECK(line.verdict == Verdict::kWarn);  // 1.6 cells wide
  }
}

TEST_CASE("check passes some modes of a fixed body with regions", "[slow]") {
  const Made made;
  made.make(box_config(kFixed + kStiffBall + "[modes]\ncount = 30\n"), "few");
  std::ostringstream out;
  CHECK(failed_lines(check_model(made.file("few"), {}, {out, false})).empty());
}

TEST_CASE("few modes of a body of two materials are the lowest of all", "[slow]") {
  const Made made;
  made.make(box_config(kStiffBall), "all");
  made.make(box_config(kStiffBall + "[modes]\ncount = 20\n"), "few");
  const Model all = made.model("all");
  const Model few = made.model("few");
  const auto& a = std::get<ModalResponse>(all.response).angular_frequency;
  const auto& b = std::get<ModalResponse>(few.response).angular_frequency;
  REQUIRE(b.size() == 20);
  CHECK((a.head(20) - b).cwiseAbs().maxCoeff() < 1e-7 * b.maxCoeff());
}

TEST_CASE("a later region counts where two overlap, by what it gives alone") {
  const TetMesh mesh = bar_mesh(kLength, kSide, 6);
  const Material body{2000.0, 0.3, 1000.0, 0, 0};
  const BoxRegion all{Vector3(-1, -1, -1), Vector3(1, 1, 1)};
  const HalfSpace half{Vector3(0.15, 0, 0), Vector3::UnitX()};
  const ElementMaterials made = element_materials(
      mesh, body, {{Region(all), {.youngs_modulus = 5000.0}}, {Region(half), {.density = 2000.0}}},
      false, "bar");
  for (std::size_t e = 0; e < 36; ++e) {
    CHECK(made.youngs_modulus[e] == 5000.0);
    CHECK(made.poisson_ratio[e] == 0.3);
    CHECK(made.density[e] == (e < 18 ? 2000.0 : 1000.0));
    CHECK(made.region[e] == (e < 18 ? 2 : 1));
  }
}

TEST_CASE("a group is a region by its tetrahedra, of linear and quadratic meshes") {
  TetMesh mesh = bar_mesh(kLength, kSide, 6);
  mesh.groups["end"] = {{mesh.tets(34, 2), mesh.tets(34, 0), mesh.tets(34, 1), mesh.tets(34, 3)},
                        {mesh.tets(7, 0), mesh.tets(7, 1), mesh.tets(7, 2), mesh.tets(7, 3)}};
  mesh.groups["face"] = {{mesh.tets(0, 0), mesh.tets(0, 1), mesh.tets(0, 2)}};
  if (GENERATE(false, true)) mesh = quadratic_mesh(mesh);
  CHECK(elements_in(mesh, GroupRegion{"end"}, "m") == std::vector<int>{7, 34});
  CHECK(elements_in(mesh, GroupRegion{"face"}, "m").empty());
  CHECK(count_cut_elements(mesh, GroupRegion{"end"}) == 0);
}

TEST_CASE("a boundary along faces of the mesh has no steps, another one has") {
  const TetMesh mesh = bar_mesh(kLength, kSide, 6);
  CHECK(count_cut_elements(mesh, HalfSpace{Vector3(0.1, 0, 0), Vector3::UnitX()}) == 0);
  CHECK(count_cut_elements(mesh, HalfSpace{Vector3(0.11, 0, 0), Vector3::UnitX()}) == 6);
  CHECK(elements_in(mesh, HalfSpace{Vector3(0.1, 0, 0), Vector3::UnitX()}, "m").size() == 12);
  CHECK(elements_in(mesh, BallRegion{Vector3(0, 0, 0), 0.2}, "m").size() > 12);
}

TEST_CASE("a region without a node inside is too coarse") {
  const auto reports = [](const TetMesh& mesh) {
    Material material{2000.0, 0.3, 1000.0, 0, 0};
    const HalfSpace two_cells{Vector3(0.1, 0, 0), Vector3::UnitX()};
    material.elements = element_materials(
        mesh, material, {{Region(two_cells), {.youngs_modulus = 3e3}}}, false, "m");
    return report_regions(mesh, material);
  };
  const std::vector<RegionReport> linear = reports(bar_mesh(kLength, kSide, 6));
  REQUIRE(linear.size() == 2);
  CHECK(linear[1].elements == 12);
  CHECK(linear[1].volume == Approx(0.1 * kSide * kSide).epsilon(1e-12));
  CHECK(linear[1].inner_nodes == 0);
  CHECK_THAT(coarseness_hint(linear[1]).value_or(""), ContainsSubstring("region 1"));
  // The middles of the diagonals of the cells and of the square between two of them.
  const std::vector<RegionReport> quadratic = reports(quadratic_mesh(bar_mesh(kLength, kSide, 6)));
  CHECK(quadratic[1].inner_nodes == 2 + 1);
  CHECK(quadratic[0].inner_nodes == 4 + 3);
  CHECK_FALSE(coarseness_hint(quadratic[1]).has_value());
}

TEST_CASE("values of every element come from a file") {
  const Made made;
  const auto file = made.path() / "values.txt";
  const TetMesh mesh = bar_mesh(kLength, kSide, 1);
  const Material body{2000.0, 0.3, 1000.0, 0, 0};
  const auto read = [&](const std::string& text, bool rigid = false) {
    std::ofstream(file) << text;
    return element_materials(mesh, body, {{file}}, rigid, "bar");
  };
  const ElementMaterials elements = read(
      "# two columns\nyoungs_modulus density\n1e3 900\nnan 901\n3e3 nan\nnan nan\n5e3 904\n"
      "6e3 905\n");
  CHECK(elements.youngs_modulus == std::vector<double>{1e3, 2e3, 3e3, 2e3, 5e3, 6e3});
  CHECK(elements.density == std::vector<double>{900, 901, 1000, 1000, 904, 905});
  CHECK(elements.region == std::vector<std::int32_t>{1, 1, 1, 0, 1, 1});
  CHECK(read("density\n1 2 3 4 5 6\n", true).youngs_modulus.empty());

  const auto refused = [&](const std::string& text, const std::string& message) {
    CHECK_THROWS_WITH(read(text), ContainsSubstring(message) && ContainsSubstring("values.txt"));
  };
  refused("youngs_modulus\n1e3 1e3 1e3\n", "has 3 rows of values and the mesh 6 tetrahedra");
  refused("youngs_modulus\n1e3 1e3 1e3 1e3 1e3 1e3 1e3\n", "has 7 rows");
  refused("youngs_modulus\n1e3 1e3 1e3 -1 1e3 1e3\n", "youngs_modulus is -1");
  refused("poisson_ratio\n.3 .3 .3 .5 .3 .3\n", "poisson_ratio is 0.5");
  refused("stiffness\n1 1 1 1 1 1\n", "'stiffness' is not one");
  refused("density density\n1 1\n", "twice");
  refused("density\n1 soft\n", "soft");
  CHECK_THROWS_WITH(read("youngs_modulus\n1 1 1 1 1 1\n", true),
                    ContainsSubstring("density alone"));
  CHECK_THROWS_WITH(read("density\nnan nan nan nan nan nan\n"),
                    ContainsSubstring("no tetrahedron"));
  std::filesystem::remove(file);
  CHECK_THROWS_WITH(element_materials(mesh, body, {{file}}, false, "bar"),
                    ContainsSubstring("values.txt"));
}

TEST_CASE("wrong regions are refused, each by what is wrong with it") {
  const Made made;
  const auto refused = [&](const std::string& region, const std::string& message) {
    CAPTURE(region);
    CHECK_THROWS_WITH(made.make(box_config("[[region]]\n" + region), "wrong"),
                      ContainsSubstring(message) && ContainsSubstring("wrong.toml"));
    CHECK_FALSE(std::filesystem::exists(made.file("wrong")));
  };
  const std::string ball = "ball = { centre = [0.03, 0.03, 0.03], radius = 0.02 }\n";
  refused("group = \"bone\"\nyoungs_modulus = 1e4\n", "no group 'bone'");
  refused("ball = { centre = [3, 3, 3], radius = 0.02 }\ndensity = 1\n", "number 1 holds no tetra");
  refused(ball + "youngs_modulus = 0\n", "youngs_modulus");
  refused(ball + "youngs_modulus = -5\n", "youngs_modulus");
  refused(ball + "poisson_ratio = 0.5\n", "poisson_ratio");
  refused(ball + "density = 0\n", "density");
  refused(ball, "changes nothing");
  refused(ball + "density = 1\nrayleigh_beta = 1e-3\n", "rayleigh_beta");
  refused(ball + "box = { min = [0, 0, 0], max = [1, 1, 1] }\ndensity = 1\n", "not exactly one");
  refused("density = 1\n", "not exactly one");
  refused("ball = { centre = [0, 0, 0], radius = 0 }\ndensity = 1\n", "radius");
  refused(ball + "youngs_modulus = 4e9\n", "too far apart");
  refused("elements = \"values.txt\"\ndensity = 1\n", "density");
}

TEST_CASE("a rigid body has regions of another density") {
  const Made made;
  const std::string text =
      "[mesh]\nbox = { size = [0.09, 0.09, 0.06], cells = [2, 2, 2] }\n"
      "[material]\nrigid = true\ndensity = 1000\n[[region]]\n"
      "half_space = { point = [0.045, 0, 0], normal = [1, 0, 0] }\n";
  made.make(text + "density = 3000\n", "heavy");
  const Model heavy = read_model(made.file("heavy"), ResponseKind::kModal);
  const ElementMaterials& elements = heavy.material.elements;
  CHECK(elements.youngs_modulus.empty());
  double mass = 0.0;
  const TetMesh mesh{heavy.mesh.nodes, heavy.mesh.tets, {}};
  for (int e = 0; e < mesh.tet_count(); ++e) {
    mass += elements.density[static_cast<std::size_t>(e)] * signed_volume(mesh, e);
  }
  CHECK(heavy.body.mass == Approx(mass).epsilon(1e-12));
  CHECK(heavy.mesh.com_offset.x() < 0.043);
  CHECK_THROWS_WITH(made.make(text + "youngs_modulus = 3000\n", "soft"),
                    ContainsSubstring("is for soft bodies"));
}
