#pragma once

#include <string>
#include <vector>

namespace irdm::replay {

/// How a curve is drawn: what is of A, of B (dashed, so that it does not hide A), or of both.
enum class Stroke { kA, kB, kDifference, kLimit };

struct Curve {
  std::string name;  ///< for the legend
  Stroke stroke = Stroke::kA;
  std::vector<double> x, y;
};

/// A figure of curves on one pair of axes. Labels say quantity and unit.
struct Chart {
  std::string x_label, y_label;
  bool logarithmic_x = false;
  bool logarithmic_y = false;
  std::vector<Curve> curves;
};

/// As an <svg> element that needs nothing else. Curves of very many points are drawn by the
/// smallest and the largest of each group of neighbours.
std::string svg_of(const Chart& chart);

/// Text for HTML and SVG: the characters that mean something there are written as entities.
std::string escaped(const std::string& text);

}  // namespace irdm::replay
