#include "precompute/mesh/material_regions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <sstream>

#include "common/config/range.hpp"
#include "common/error.hpp"
#include "precompute/fem/material.hpp"
#include "precompute/mesh/format/token_reader.hpp"

namespace irdm::precompute {

std::array<MaterialKey, 3> material_keys(MaterialValues& values) {
  return {{{"youngs_modulus", &values.youngs_modulus, lab::kYoungsModulus},
           {"poisson_ratio", &values.poisson_ratio, kPoissonRatio},
           {"density", &values.density, lab::kDensity}}};
}

namespace {

class Assignment {
 public:
  Assignment(const TetMesh& mesh, const Material& material, bool rigid)
      : rigid_(rigid), count_(static_cast<std::size_t>(mesh.tet_count())) {
    elements_.density.assign(count_, material.density);
    elements_.region.assign(count_, 0);
    if (rigid) return;
    elements_.youngs_modulus.assign(count_, material.youngs_modulus);
    elements_.poisson_ratio.assign(count_, material.poisson_ratio);
  }

  void give(int element, int number, const MaterialValues& values) {
    const auto e = static_cast<std::size_t>(element);
    elements_.region[e] = number;
    if (values.density) elements_.density[e] = *values.density;
    if (values.youngs_modulus) elements_.youngs_modulus[e] = *values.youngs_modulus;
    if (values.poisson_ratio) elements_.poisson_ratio[e] = *values.poisson_ratio;
  }

  /// Returns how many elements it has values for.
  int give_file(const std::filesystem::path& path, int number) {
    TokenReader reader(path, '#');
    MaterialValues values;
    const std::vector<MaterialKey> columns = read_header(reader, values);
    std::size_t rows = 0;
    int given = 0;
    for (; !reader.at_end(); ++rows) {
      bool any = false;
      for (const MaterialKey& column : columns) any = read_value(reader, column) || any;
      if (!any || rows >= count_) continue;
      give(static_cast<int>(rows), number, values);
      ++given;
    }
    if (rows == count_) return given;
    throw Error(path.string(),
                "has " + std::to_string(rows) + " rows of values and the mesh " +
                    std::to_string(count_) + " tetrahedra",
                "give one for each, in the order of the mesh");
  }

  ElementMaterials take() { return std::move(elements_); }

 private:
  std::vector<MaterialKey> read_header(TokenReader& reader, MaterialValues& values) const {
    std::vector<MaterialKey> columns;
    const std::string first(reader.word());
    std::istringstream line(first + ' ' + std::string(reader.rest_of_line()));
    for (std::string word; line >> word;) {
      const auto known = material_keys(values);
      const auto key =
          std::ranges::find_if(known, [&](const MaterialKey& one) { return one.key == word; });
      const bool twice =
          std::ranges::any_of(columns, [&](const MaterialKey& one) { return one.key == word; });
      if (key == known.end() || twice || (rigid_ && word != "density")) {
        reader.fail("column " + in_quotes(word) +
                        (twice ? " is there twice" : " is not one that this body has"),
                    rigid_ ? "a rigid body has density alone"
                           : "name youngs_modulus, poisson_ratio, density in the first line");
      }
      columns.push_back(*key);
    }
    return columns;
  }

  static bool read_value(TokenReader& reader, const MaterialKey& column) {
    const double value = reader.number();
    column.value->reset();
    if (std::isnan(value)) return false;
    if (!column.range.contains(value)) {
      reader.fail(std::string(column.key) + " is " + number_text(value),
                  "give " + describe(column.range) + ", or nan for none");
    }
    *column.value = value;
    return true;
  }

  bool rigid_;
  std::size_t count_;
  ElementMaterials elements_;
};

std::string numbered(int number) {
  return "[[region]] number " + std::to_string(number);
}

void check_contrast(const ElementMaterials& elements, const std::string& name) {
  if (elements.youngs_modulus.empty()) return;
  const auto [softest, stiffest] = std::ranges::minmax(elements.youngs_modulus);
  if (stiffest <= kLargestContrast * softest) return;
  throw Error(name,
              "Young's moduli from " + number_text(softest) + " to " + number_text(stiffest) +
                  " Pa are too far apart for the lowest modes to be found",
              "let the stiffest be a million times the softest at most: it moves as good as "
              "rigidly in it anyway");
}

}  // namespace

ElementMaterials element_materials(const TetMesh& mesh, const Material& material,
                                   const std::vector<MaterialRegion>& regions, bool rigid,
                                   const std::string& name) {
  if (regions.empty()) return {};
  Assignment assignment(mesh, material, rigid);
  int number = 0;
  for (const MaterialRegion& region : regions) {
    ++number;
    std::size_t held = 0;
    if (const auto* file = std::get_if<std::filesystem::path>(&region.where)) {
      held = static_cast<std::size_t>(assignment.give_file(*file, number));
    } else {
      const auto elements = elements_in(mesh, std::get<Region>(region.where), name);
      for (const int e : elements) assignment.give(e, number, region.values);
      held = elements.size();
    }
    if (held > 0) continue;
    throw Error(name, numbered(number) + " holds no tetrahedron of the mesh",
                "a tetrahedron is where its centroid is, in metres and the mesh's coordinates, or "
                "in a group of tetrahedra; use a larger region or a finer mesh");
  }
  ElementMaterials elements = assignment.take();
  check_contrast(elements, name);
  return elements;
}

namespace {

// A face of a tetrahedron: the one opposite to its corner `left_out`.
struct Face {
  std::array<int, 3> corners;  // increasing
  int element;
  int left_out;
};

std::vector<Face> faces_of(const TetMesh& mesh, const std::vector<int>& elements) {
  std::vector<Face> faces;
  for (const int e : elements) {
    for (int left_out = 0; left_out < 4; ++left_out) {
      Face face{{}, e, left_out};
      for (int i = 1; i < 4; ++i) {
        face.corners[static_cast<std::size_t>(i - 1)] = mesh.tets(e, (left_out + i) % 4);
      }
      std::ranges::sort(face.corners);
      faces.push_back(face);
    }
  }
  std::ranges::sort(faces, {}, &Face::corners);
  return faces;
}

// Nodes of the elements that lie on none of the faces that only one of them has.
int count_inner_nodes(const TetMesh& mesh, const std::vector<int>& elements) {
  std::set<int> inner;
  for (const int e : elements) {
    for (Eigen::Index i = 0; i < mesh.tets.cols(); ++i) inner.insert(mesh.tets(e, i));
  }
  const std::vector<Face> faces = faces_of(mesh, elements);
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const Face& face = faces[i];
    if (i > 0 && faces[i - 1].corners == face.corners) continue;
    if (i + 1 < faces.size() && faces[i + 1].corners == face.corners) continue;
    for (const int corner : face.corners) inner.erase(corner);
    if (mesh.order() == 1) continue;
    int middle = 4;
    for (const auto& [j, k] : kTetEdges) {
      if (j != face.left_out && k != face.left_out) inner.erase(mesh.tets(face.element, middle));
      ++middle;
    }
  }
  return static_cast<int>(inner.size());
}

Interval interval_of(const std::vector<double>& values, const std::vector<int>& elements) {
  if (values.empty()) return {};
  Interval interval{std::numeric_limits<double>::max(), std::numeric_limits<double>::lowest()};
  for (const int e : elements) {
    interval.lowest = std::min(interval.lowest, values[static_cast<std::size_t>(e)]);
    interval.highest = std::max(interval.highest, values[static_cast<std::size_t>(e)]);
  }
  return interval;
}

RegionReport report_region(const TetMesh& mesh, const ElementMaterials& materials, int number,
                           const std::vector<int>& elements) {
  RegionReport report;
  report.number = number;
  report.elements = static_cast<int>(elements.size());
  for (const int e : elements) report.volume += signed_volume(mesh, e);
  report.youngs_modulus = interval_of(materials.youngs_modulus, elements);
  report.poisson_ratio = interval_of(materials.poisson_ratio, elements);
  report.density = interval_of(materials.density, elements);
  report.inner_nodes = count_inner_nodes(mesh, elements);
  return report;
}

std::string text_of(const Interval& interval) {
  const std::string lowest = number_text(interval.lowest);
  return interval.lowest == interval.highest ? lowest
                                             : lowest + " to " + number_text(interval.highest);
}

}  // namespace

std::vector<RegionReport> report_regions(const TetMesh& mesh, const Material& material) {
  std::map<int, std::vector<int>> elements_of;
  for (std::size_t e = 0; e < material.elements.region.size(); ++e) {
    elements_of[material.elements.region[e]].push_back(static_cast<int>(e));
  }
  std::vector<RegionReport> reports;
  for (const auto& [number, elements] : elements_of) {
    reports.push_back(report_region(mesh, material.elements, number, elements));
  }
  return reports;
}

std::string name_of(const RegionReport& region) {
  return region.number == 0 ? "outside the regions" : "region " + std::to_string(region.number);
}

std::string format_region(const RegionReport& region) {
  const std::string elasticity =
      region.youngs_modulus.highest > 0.0
          ? ", E " + text_of(region.youngs_modulus) + " Pa, nu " + text_of(region.poisson_ratio)
          : "";
  return std::to_string(region.elements) + " elements, " + std::to_string(region.inner_nodes) +
         " nodes inside, " + number_text(region.volume) + " m^3" + elasticity + ", " +
         text_of(region.density) + " kg/m^3";
}

std::optional<std::string> coarseness_hint(const RegionReport& region) {
  if (region.youngs_modulus.highest == 0.0 || region.inner_nodes > 0) return std::nullopt;
  return name_of(region) +
         ": has no node inside, so that it comes out too stiff; use a finer mesh or mesh.order = 2";
}

std::optional<std::string> step_hint(const TetMesh& mesh, const MaterialRegion& region,
                                     int number) {
  const auto* shape = std::get_if<Region>(&region.where);
  const int cut = shape == nullptr ? 0 : count_cut_elements(mesh, *shape);
  if (cut == 0) return std::nullopt;
  return "region " + std::to_string(number) + ": its boundary cuts " + std::to_string(cut) +
         " elements, each of which is of one material, so that it has steps of an element; a mesh "
         "with the region as a group has none";
}

}  // namespace irdm::precompute
