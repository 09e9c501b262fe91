#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "common/config/range.hpp"
#include "common/model/model.hpp"
#include "precompute/mesh/region.hpp"

namespace irdm::precompute {

/// What a part of a body is made of; what is not given stays what it is there without that.
struct MaterialValues {
  std::optional<double> youngs_modulus{};  ///< [Pa]
  std::optional<double> poisson_ratio{};
  std::optional<double> density{};  ///< [kg/m^3]
};

/// A key of [material] and [[region]], what it sets and its range.
struct MaterialKey {
  const char* key;
  std::optional<double>* value;
  Range range;
};
std::array<MaterialKey, 3> material_keys(MaterialValues& values);

/// One [[region]] of a configuration.
struct MaterialRegion {
  /// Or a text file: in its first line one or more of the keys of MaterialValues, then a row for
  /// each tetrahedron with that many numbers, between blanks, `nan` where nothing is given. The
  /// elements with a number make the region. `#` begins a comment.
  std::variant<Region, std::filesystem::path> where;
  MaterialValues values{};  ///< none with a file
};

/// The stiffest element may be so many times as stiff as the softest: beyond it rounding of
/// the stiffest takes the digits of the lowest modes.
inline constexpr double kLargestContrast = 1e6;

/// What each tetrahedron is made of; empty without regions. Throws Error (about `name`) for a
/// region that holds no tetrahedron, a group that the mesh does not have, a larger contrast; about
/// the file of values that cannot be read or has not a row for each tetrahedron.
/// @param material of what is in no region
/// @param rigid the body has densities alone
ElementMaterials element_materials(const TetMesh& mesh, const Material& material,
                                   const std::vector<MaterialRegion>& regions, bool rigid,
                                   const std::string& name);

struct Interval {
  double lowest = 0.0;
  double highest = 0.0;
};

/// What the elements of a region, less those that a later one has, add up to.
struct RegionReport {
  int number = 0;       ///< from 1, in the order of the configuration; 0: what is in no region
  int elements = 0;     ///< > 0
  double volume = 0.0;  ///< [m^3]
  Interval youngs_modulus{};  ///< [Pa]; 0: the body is rigid
  Interval poisson_ratio{};
  Interval density{};  ///< [kg/m^3]
  /// Nodes that lie neither on its boundary nor on the body's surface; 0: it is less than two
  /// linear elements across.
  int inner_nodes = 0;
};

/// Of every region that has elements, by number; none of a body of one material.
std::vector<RegionReport> report_regions(const TetMesh& mesh, const Material& material);

/// "region 2" or "outside the regions".
std::string name_of(const RegionReport& region);
/// "54 elements, 31 nodes inside, 3.2e-06 m^3, E 60000 Pa, nu 0.49, 1100 kg/m^3".
std::string format_region(const RegionReport& region);

/// What to say of a region that is too few elements across for its stiffness to come out.
std::optional<std::string> coarseness_hint(const RegionReport& region);

/// What to say of a region's boundary that does not run along faces of the mesh.
std::optional<std::string> step_hint(const TetMesh& mesh, const MaterialRegion& region, int number);

}  // namespace irdm::precompute
