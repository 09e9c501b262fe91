#include "simulation/contact/ball_samples.hpp"

#include <algorithm>
#include <cmath>

#include "simulation/contact/surface_faces.hpp"

namespace irdm {
namespace {

// Smallest number of spacings in the ball's radius. At a depth of a tenth of the radius, 4 instead
// of 5 makes the force up to 8 % too small, 3 up to 11 %.
constexpr double kMinSpacingsPerRadius = 5.0;
// Largest depth at which a ball may touch first [m]. The nearest sample is hardly ever farther away
// than kMaxSampleDistance spacings.
constexpr double kMaxFirstTouchDepth = 2e-4;
constexpr double kMaxSampleDistance = 0.75;
// A surface gets at least this many samples for a large ball, as long as the ball's radius has no
// more than kMaxSpacingsPerRadius spacings.
constexpr double kDesiredSamples = 2000.0;
constexpr double kMaxSpacingsPerRadius = 12.5;
// Smallest number of samples of a surface.
constexpr double kMinSamples = 600.0;
// Largest number of samples of a surface, and their smallest spacing [m]. Smaller balls meet fewer
// samples than accuracy asks for.
constexpr double kMaxSamples = 50000.0;
constexpr double kMinSpacing = 1e-3;
// Longest edge of a part, in spacings.
constexpr double kMaxPartEdge = 2.5;

// Returns the point of the surface triangles at which a point of a face lies, and its triangle.
SurfacePoint surface_point(const SurfaceFace& face, const std::array<double, 3>& at,
                           int& triangle) {
  const auto [a, b, c] = at;
  const auto& n = face.nodes;
  triangle = face.triangles[0];
  if (face.node_count == 3) return {{n[0], n[1], n[2]}, at};
  if (a > 0.5) {
    triangle = face.triangles[1];
    return {{n[0], n[3], n[5]}, {2.0 * a - 1.0, 2.0 * b, 2.0 * c}};
  }
  if (b > 0.5) {
    triangle = face.triangles[2];
    return {{n[1], n[4], n[3]}, {2.0 * b - 1.0, 2.0 * c, 2.0 * a}};
  }
  if (c > 0.5) {
    triangle = face.triangles[3];
    return {{n[2], n[5], n[4]}, {2.0 * c - 1.0, 2.0 * a, 2.0 * b}};
  }
  return {{n[3], n[4], n[5]}, {1.0 - 2.0 * c, 1.0 - 2.0 * a, 1.0 - 2.0 * b}};
}

// Returns the same point with the nodes in the order of the surface triangle.
SurfacePoint in_order(const SurfacePoint& point, const std::array<int, 3>& nodes) {
  SurfacePoint ordered{nodes, {0.0, 0.0, 0.0}};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      if (point.nodes[j] == nodes[i]) ordered.weights[i] = point.weights[j];
    }
  }
  return ordered;
}

struct FaceSize {
  double area = 0.0;          ///< [m^2]
  double mean_edge = 0.0;     ///< between its corners [m]
  double longest_edge = 0.0;  ///< [m]
};
FaceSize size_of(const SurfaceFace& face, const RestSurface& surface) {
  FaceSize size;
  for (std::size_t i = 0; i < (face.node_count == 3 ? 1u : 4u); ++i) {
    size.area += 0.5 * area_normal(surface.corners(face.triangles[i])).norm();
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const double edge =
        (surface.node(face.nodes[(i + 1) % 3]) - surface.node(face.nodes[i])).norm();
    size.mean_edge += edge / 3.0;
    size.longest_edge = std::max(size.longest_edge, edge);
  }
  return size;
}

// Returns the number of parts along each edge of a face.
int parts_of(const FaceSize& size, double spacing) {
  const double wide = std::round(std::sqrt(size.area) / spacing);
  const double slender = std::ceil(size.longest_edge / (kMaxPartEdge * spacing));
  return static_cast<int>(std::max({1.0, wide, slender}));
}

double count_of(const std::vector<SurfaceFace>& faces, const RestSurface& surface, double spacing) {
  double count = 0.0;
  for (const SurfaceFace& face : faces) {
    const int parts = parts_of(size_of(face, surface), spacing);
    count += static_cast<double>(parts) * parts;
  }
  return count;
}

}  // namespace

double ball_sample_spacing(double radius, double area) {
  const double for_count =
      std::clamp(radius / kMaxSpacingsPerRadius, std::sqrt(area / kDesiredSamples),
                 std::sqrt(area / kMinSamples));
  const double for_first_touch = std::sqrt(2.0 * radius * kMaxFirstTouchDepth) / kMaxSampleDistance;
  const double for_force = radius / kMinSpacingsPerRadius;
  return std::max({kMinSpacing, std::sqrt(area / kMaxSamples),
                   std::min({for_count, for_first_touch, for_force})});
}

std::vector<BallSample> ball_samples(const ModelMesh& mesh, const RestSurface& surface,
                                     double spacing) {
  std::vector<BallSample> samples;
  int number = 0;
  const std::vector<SurfaceFace> faces = surface_faces(mesh);
  while (count_of(faces, surface, spacing) > kMaxSamples + static_cast<double>(faces.size())) {
    spacing *= 1.2;  // slivers have more parts than their area asks for
  }
  for (const SurfaceFace& face : faces) {
    const FaceSize size = size_of(face, surface);
    const int parts = parts_of(size, spacing);
    const auto add = [&](double a, double b) {
      const std::array<double, 3> at{a, b, 1.0 - a - b};
      BallSample sample;
      sample.element = face.element;
      sample.face = number;
      sample.edge = size.mean_edge;
      sample.area = size.area / (parts * parts);
      sample.node_count = static_cast<std::size_t>(face.node_count);
      sample.nodes = face.nodes;
      sample.weights = face.weights(at);
      const SurfacePoint point = surface_point(face, at, sample.place.triangle);
      sample.place.point = in_order(point, surface.topology().corners(sample.place.triangle));
      for (std::size_t i = 0; i < sample.node_count; ++i) {
        sample.place.position += sample.weights[i] * surface.node(sample.nodes[i]);
      }
      sample.normal = surface.plane(sample.place.triangle).normal;
      samples.push_back(sample);
    };
    // Each row of parts has one more upright than inverted triangles.
    for (int i = 0; i < parts; ++i) {
      for (int j = 0; i + j < parts; ++j) {
        add((i + 1.0 / 3.0) / parts, (j + 1.0 / 3.0) / parts);
        if (i + j + 1 < parts) add((i + 2.0 / 3.0) / parts, (j + 2.0 / 3.0) / parts);
      }
    }
    ++number;
  }
  return samples;
}

}  // namespace irdm
