#include "replay/compare/comparison_text.hpp"

#include <charconv>
#include <cmath>
#include <cstdio>

namespace irdm::replay {
namespace {

std::string line(const std::string& what, const Apart& apart, const char* unit,
                 const std::vector<double>& times) {
  char text[256];
  std::snprintf(text, sizeof text, "  %-18s rms %10.3g %-3s  largest %10.3g %-3s at %.6g s",
                what.c_str(), apart.rms_over_time(), unit, apart.maximum(), unit,
                times[apart.worst_frame()]);
  std::string all = text;
  if (apart.reference > 0) {
    std::snprintf(text, sizeof text, ", %.3g %% of %.3g %s",
                  100.0 * apart.maximum() / apart.reference, apart.reference, unit);
    all += text;
  }
  return all + "\n";
}

// What is not finite is null: JSON knows no other word for it.
std::string number(double value) {
  if (!std::isfinite(value)) return "null";
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string quoted(const std::string& text) {
  std::string all = "\"";
  for (const char letter : text) {
    const auto code = static_cast<unsigned char>(letter);
    if (letter == '"' || letter == '\\') all += '\\';
    if (code < 0x20) {
      char escape[8];
      std::snprintf(escape, sizeof escape, "\\u%04x", code);
      all += escape;
    } else {
      all += letter;
    }
  }
  return all + "\"";
}

std::string list(const std::vector<double>& values) {
  std::string all;
  for (const double value : values) all += (all.empty() ? "" : ", ") + number(value);
  return "[" + all + "]";
}

std::string json(const Apart& apart, const char* unit) {
  return std::string("{\"unit\": \"") + unit + "\", \"rms\": " + number(apart.rms_over_time()) +
         ", \"max\": " + number(apart.maximum()) + ", \"reference\": " + number(apart.reference) +
         ",\n     \"rms_over_time\": " + list(apart.rms) +
         ",\n     \"max_over_time\": " + list(apart.largest) + "}";
}

std::string json(const ObjectComparison& object) {
  std::string text = "  {\"name\": " + quoted(object.name);
  if (object.same_nodes) {
    text += ",\n   \"displacement\": " + json(object.displacement, "m") +
            ",\n   \"place\": " + json(object.place, "m");
  }
  return text + ",\n   \"centre_of_mass\": " + json(object.centre_of_mass, "m") +
         ",\n   \"orientation\": " + json(object.orientation, "rad") + "}";
}

}  // namespace

std::string comparison_table(const Comparison& comparison) {
  std::string text = comparison.a + " and " + comparison.b + ": " +
                     std::to_string(comparison.times.size()) + " frames in common, " +
                     std::to_string(comparison.alone) + " of one alone\n";
  for (const ObjectComparison& object : comparison.objects) {
    text += "object " + object.name + "\n";
    if (object.same_nodes) {
      text += line("node displacement", object.displacement, "m", comparison.times) +
              line("node place", object.place, "m", comparison.times);
    } else {
      text += "  nodes              not compared: the meshes differ\n";
    }
    text += line("centre of mass", object.centre_of_mass, "m", comparison.times) +
            line("orientation", object.orientation, "rad", comparison.times);
  }
  for (std::size_t s = 0; s < comparison.forces.size(); ++s) {
    text += "stylus " + std::to_string(s) + "\n" +
            line("force", comparison.forces[s], "N", comparison.times);
  }
  return text;
}

std::string comparison_json(const Comparison& comparison) {
  std::string text = "{\"a\": " + quoted(comparison.a) + ", \"b\": " + quoted(comparison.b) +
                     ",\n \"frames\": " + std::to_string(comparison.times.size()) +
                     ", \"frames_alone\": " + std::to_string(comparison.alone) +
                     ",\n \"time\": " + list(comparison.times) + ",\n \"objects\": [\n";
  for (std::size_t i = 0; i < comparison.objects.size(); ++i) {
    text += (i > 0 ? ",\n" : "") + json(comparison.objects[i]);
  }
  text += "],\n \"styluses\": [\n";
  for (std::size_t s = 0; s < comparison.forces.size(); ++s) {
    text += (s > 0 ? ",\n" : "") + std::string("  {\"force\": ") +
            json(comparison.forces[s], "N") + "}";
  }
  return text + "]}\n";
}

}  // namespace irdm::replay
