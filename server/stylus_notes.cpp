#include "server/stylus_notes.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>

#include "common/error.hpp"
#include "common/stability/coupling_limit.hpp"
#include "simulation/step/default_fingertip.hpp"

namespace irdm {
namespace {

std::string rounded(double value, int digits) {
  std::ostringstream text;
  text << std::setprecision(digits) << value;
  return text.str();
}

std::string millimetres(double length) {
  return rounded(1000.0 * length, 3) + " mm";
}

std::size_t viewer_number(const SceneConfig& scene, bool viewer_stylus) {
  return viewer_stylus ? scene.styluses.size() : scene.styluses.size() + 1;
}

// Over the objects that deform; NaN: not known.
double mesh_dependence(const SimulationConfig& config, double radius) {
  double factor = std::nan("");
  for (const SimulationObject& object : config.objects) {
    if (is_rigid(*object.model)) continue;
    factor = std::fmax(factor, mesh_dependence_of_points(*object.model, radius));
  }
  return factor;
}

}  // namespace

std::string list_of_styluses(const std::vector<std::size_t>& numbers, std::size_t viewer_stylus) {
  const bool viewers = numbers.back() == viewer_stylus;
  const std::size_t named = numbers.size() - (viewers ? 1 : 0);
  std::string text = named == 0 ? "" : named == 1 ? "stylus " : "styluses ";
  for (std::size_t i = 0; i < named; ++i) {
    text += (i == 0 ? "" : ", ") + std::to_string(numbers[i] + 1);
  }
  if (viewers) text += std::string(named == 0 ? "" : " and ") + "the viewers' stylus";
  return text;
}

std::string default_radius_note(const SceneConfig& scene, const SimulationConfig& config,
                                bool viewer_stylus) {
  std::vector<std::size_t> numbers = scene.default_radius;
  if (viewer_stylus && scene.viewer.default_radius) numbers.push_back(scene.styluses.size());
  std::string text;
  for (const bool balls : {false, true}) {
    std::vector<std::size_t> these;
    for (const std::size_t s : numbers) {
      if (config.styluses[s].ball == balls && config.styluses[s].radius > 0) these.push_back(s);
    }
    if (these.empty()) continue;
    text += (text.empty() ? "" : "; ") +
            list_of_styluses(these, viewer_number(scene, viewer_stylus)) + ": " +
            (balls ? "ball" : "fingertip") + " of radius " +
            millimetres(config.styluses[these.front()].radius) + " by default, from the objects' " +
            (balls ? "mesh and size" : "size");
  }
  return text.empty() ? "" : text + "; `radius` sets another";
}

std::string point_warning(const SceneConfig& scene, const SimulationConfig& config,
                          bool viewer_stylus) {
  std::vector<std::size_t> points;
  for (std::size_t s = 0; s < config.styluses.size(); ++s) {
    const SimulationStylus& stylus = config.styluses[s];
    if (!stylus.tool && !stylus.has_ball() && stylus.radius <= 0) points.push_back(s);
  }
  const double radius = default_fingertip(config);
  if (points.empty() || radius <= 0) return "";
  const double factor = mesh_dependence(config, radius);
  const std::string list = list_of_styluses(points, viewer_number(scene, viewer_stylus));
  return list + (points.size() == 1 ? " is a point" : " are points") +
         " (radius = 0), and what a point feels depends on the mesh: " +
         (std::isnan(factor)
              ? ""
              : "neighbouring nodes differ by a factor of " + rounded(factor, 2) + ", and ") +
         "half the edge length is up to twice as soft; leave `radius` out for a fingertip of " +
         millimetres(radius);
}

std::string coupling_warning(const SceneConfig& scene, const SimulationConfig& config) {
  constexpr int kNodes = 4;
  double stiffest = 0.0;
  for (const SimulationStylus& stylus : config.styluses) {
    if (!stylus.tool) stiffest = std::max(stiffest, stylus.coupling_stiffness);
  }
  double least = std::numeric_limits<double>::infinity();
  std::size_t worst = 0;
  for (std::size_t i = 0; stiffest > 0 && i < config.objects.size(); ++i) {
    const double limit = sampled_coupling(*config.objects[i].model, kNodes);
    if (limit < least) worst = i;
    least = std::min(least, limit);
  }
  if (stiffest <= least) return "";
  return "coupling_stiffness " + rounded(stiffest, 3) + " N/m is too stiff for object " +
         in_quotes(scene.objects[worst].name) + " at its dt of " +
         rounded(config.objects[worst].model->dt, 3) +
         " s where a bridge holds forces (mode = \"hold\") over a link of one step each way: "
         "stable up to " +
         rounded(least, 2) + " N/m; lower it, or see irdm-precompute check";
}

}  // namespace irdm
