#include "replay/report/svg_chart.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "replay/report/axis.hpp"

namespace irdm::replay {
namespace {

// In px of the drawing.
constexpr double kWidth = 720.0;
constexpr double kHeight = 300.0;
constexpr double kLeft = 78.0;
constexpr double kRight = 704.0;
constexpr double kTop = 34.0;
constexpr double kBottom = 248.0;
constexpr std::size_t kGroups = 900;  // that a curve is drawn by

struct Axes {
  Axis x, y;
};

double across(const Axis& x, double value) {
  return kLeft + (kRight - kLeft) * x.place(value);
}
double down(const Axis& y, double value) {
  return kBottom + (kTop - kBottom) * std::clamp(y.place(value), 0.0, 1.0);
}

std::string px(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", value);
  return text;
}

std::string line(double x1, double y1, double x2, double y2, const std::string& kind) {
  return "<line class=\"" + kind + "\" x1=\"" + px(x1) + "\" y1=\"" + px(y1) + "\" x2=\"" + px(x2) +
         "\" y2=\"" + px(y2) + "\"/>\n";
}

std::string label(double x, double y, const std::string& anchor, const std::string& text) {
  return "<text x=\"" + px(x) + "\" y=\"" + px(y) + "\" text-anchor=\"" + anchor + "\">" +
         escaped(text) + "</text>\n";
}

const char* kind_of(Stroke stroke) {
  switch (stroke) {
    case Stroke::kA:
      return "a";
    case Stroke::kB:
      return "b";
    case Stroke::kDifference:
      return "difference";
    case Stroke::kLimit:
      return "limit";
  }
  return "";
}

Axes axes_of(const Chart& chart) {
  std::vector<double> x;
  std::vector<double> y;
  for (const Curve& curve : chart.curves) {
    x.insert(x.end(), curve.x.begin(), curve.x.end());
    y.insert(y.end(), curve.y.begin(), curve.y.end());
  }
  Axes axes{axis_for(x, chart.logarithmic_x), axis_for(y, chart.logarithmic_y)};
  const auto shown = [&](double value) {
    return std::isfinite(value) && (!chart.logarithmic_x || value > 0.0);
  };
  std::erase_if(x, [&](double value) { return !shown(value); });
  if (x.size() > 1) {  // curves fill the figure from side to side
    const auto [low, high] = std::minmax_element(x.begin(), x.end());
    if (*low < *high) axes.x = {*low, *high, chart.logarithmic_x};
  }
  return axes;
}

std::string grid(const Axes& axes) {
  std::string text;
  for (const double tick : axes.x.ticks()) {
    const double x = across(axes.x, tick);
    text += line(x, kTop, x, kBottom, "grid") + label(x, kBottom + 17, "middle", number_text(tick));
  }
  for (const double tick : axes.y.ticks()) {
    const double y = down(axes.y, tick);
    text += line(kLeft, y, kRight, y, "grid") + label(kLeft - 7, y + 4, "end", number_text(tick));
  }
  return text + line(kLeft, kBottom, kRight, kBottom, "axis") +
         line(kLeft, kTop, kLeft, kBottom, "axis");
}

std::string point(const Axes& axes, double x, double y) {
  return px(across(axes.x, x)) + "," + px(down(axes.y, y)) + " ";
}

// Which points of a curve are drawn: all, or of each group the smallest and the largest.
std::vector<std::size_t> drawn(const Curve& curve) {
  std::vector<std::size_t> kept;
  const std::size_t size = curve.x.size() / kGroups + 1;
  for (std::size_t first = 0; first < curve.x.size(); first += size) {
    const auto begin = curve.y.begin() + static_cast<std::ptrdiff_t>(first);
    const auto end =
        curve.y.begin() + static_cast<std::ptrdiff_t>(std::min(first + size, curve.y.size()));
    const auto [low, high] = std::minmax_element(begin, end);
    const auto i = static_cast<std::size_t>(low - curve.y.begin());
    const auto j = static_cast<std::size_t>(high - curve.y.begin());
    kept.push_back(std::min(i, j));
    if (i != j) kept.push_back(std::max(i, j));
  }
  return kept;
}

std::string path(const Curve& curve, const Axes& axes) {
  std::string points;
  for (const std::size_t i : drawn(curve)) {
    const bool shown = std::isfinite(curve.y[i]) && (!axes.y.logarithmic || curve.y[i] > 0.0) &&
                       (!axes.x.logarithmic || curve.x[i] > 0.0);
    if (shown) points += point(axes, curve.x[i], curve.y[i]);
  }
  return std::string("<polyline class=\"") + kind_of(curve.stroke) + "\" points=\"" + points +
         "\"/>\n";
}

std::string legend(const Chart& chart) {
  constexpr double kSample = 26.0;
  constexpr double kLetter = 7.2;
  std::string text;
  double x = kLeft;
  for (const Curve& curve : chart.curves) {
    text += line(x, kTop - 16, x + kSample, kTop - 16, kind_of(curve.stroke)) +
            label(x + kSample + 6, kTop - 12, "start", curve.name);
    x += kSample + 26 + kLetter * static_cast<double>(curve.name.size());
  }
  return text;
}

}  // namespace

std::string svg_of(const Chart& chart) {
  const Axes axes = axes_of(chart);
  std::string text = "<svg viewBox=\"0 0 " + px(kWidth) + " " + px(kHeight) +
                     "\" role=\"img\" aria-label=\"" + escaped(chart.y_label) + " over " +
                     escaped(chart.x_label) + "\">\n" + grid(axes) + legend(chart);
  for (const Curve& curve : chart.curves) text += path(curve, axes);
  const double middle = 0.5 * (kTop + kBottom);
  return text + label(0.5 * (kLeft + kRight), kBottom + 40, "middle", chart.x_label) +
         "<text transform=\"translate(16 " + px(middle) +
         ") rotate(-90)\" text-anchor=\"middle\">" + escaped(chart.y_label) + "</text>\n</svg>\n";
}

std::string escaped(const std::string& text) {
  std::string all;
  for (const char letter : text) {
    switch (letter) {
      case '&':
        all += "&amp;";
        break;
      case '<':
        all += "&lt;";
        break;
      case '>':
        all += "&gt;";
        break;
      case '"':
        all += "&quot;";
        break;
      default:
        all += letter;
    }
  }
  return all;
}

}  // namespace irdm::replay
