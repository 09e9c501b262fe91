#include "device_bridge/stylus_script.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string_view>

#include "common/config/input_file.hpp"
#include "common/error.hpp"

namespace irdm {
namespace {

constexpr double kSmallestNorm = 0.5;
constexpr double kLargestNorm = 2.0;
constexpr double kLargestButtons = 4294967295.0;
constexpr double kLargestCoordinate = 1000.0;  // what the protocol takes [m]
constexpr double kLargestTime = 1e9;           // [s]

std::string trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return "";
  return std::string(text.substr(first, text.find_last_not_of(" \t\r") - first + 1));
}

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields;
  std::size_t begin = 0;
  for (std::size_t end = 0; end != std::string::npos; begin = end + 1) {
    end = line.find(',', begin);
    fields.push_back(trimmed(std::string_view(line).substr(
        begin, end == std::string::npos ? std::string::npos : end - begin)));
  }
  return fields;
}

}  // namespace

class StylusScript::Parser {
 public:
  Parser(const std::string& name, StylusScript& script) : name_(name), script_(script) {}

  void line(const std::string& text) {
    ++line_;
    const std::string content = trimmed(std::string_view(text).substr(0, text.find('#')));
    if (content.empty()) return;
    if (columns_ == 0) {
      header(content);
    } else {
      row(split(content));
    }
  }

  void finish() const {
    if (columns_ == 0) throw Error(name_, "is empty", std::string("begin with a ") + kRemedy);
    if (script_.rows_.empty()) throw Error(name_, "has no rows", "give at least one position");
  }

 private:
  static constexpr const char* kRemedy = "header line time,x,y,z[,qw,qx,qy,qz][,button]";

  [[noreturn]] void fail(const std::string& what, const std::string& remedy) const {
    throw Error(name_ + ":" + std::to_string(line_), what, remedy);
  }

  void header(const std::string& content) {
    std::string names;
    for (const std::string& field : split(content)) names += (names.empty() ? "" : ",") + field;
    const std::string base = "time,x,y,z";
    const std::string turned = base + ",qw,qx,qy,qz";
    has_orientation_ = names.starts_with(turned);
    const std::string rest =
        names.substr(std::min(names.size(), has_orientation_ ? turned.size() : base.size()));
    has_button_ = rest == ",button";
    if (!names.starts_with(base) || !(rest.empty() || has_button_)) {
      fail(in_quotes(content) + " is not a header", std::string("begin with a ") + kRemedy);
    }
    columns_ = 4u + (has_orientation_ ? 4u : 0u) + (has_button_ ? 1u : 0u);
  }

  double number(const std::string& field) const {
    char* end = nullptr;
    const double value = std::strtod(field.c_str(), &end);
    if (field.empty() || end != field.c_str() + field.size())
      fail(in_quotes(field) + " is not a number", "correct it");
    if (!std::isfinite(value)) fail(in_quotes(field) + " is not finite", "give a finite number");
    return value;
  }

  void row(const std::vector<std::string>& fields) {
    if (fields.size() != columns_) {
      fail("has " + std::to_string(fields.size()) + " values",
           "give " + std::to_string(columns_) + " as the header says");
    }
    std::vector<double> values;
    for (const std::string& field : fields) values.push_back(number(field));
    Row row;
    row.time = values[0];
    if (!script_.rows_.empty() && row.time <= script_.rows_.back().time) {
      fail("time " + shortened(fields[0]) + " does not come after the row before",
           "sort the rows by time");
    }
    row.pose.tip = Vector3(values[1], values[2], values[3]);
    if (std::abs(row.time) > kLargestTime ||
        row.pose.tip.cwiseAbs().maxCoeff() > kLargestCoordinate) {
      fail("is out of reach", "give a time within 1e9 s and a tip within 1000 m");
    }
    if (has_orientation_) {
      const Quaternion given(values[4], values[5], values[6], values[7]);
      if (given.norm() < kSmallestNorm || given.norm() > kLargestNorm) {
        fail("the orientation is not of norm 1", "give a unit quaternion w,x,y,z");
      }
      row.pose.orientation = given.normalized();
    }
    if (has_button_) row.pose.buttons = buttons(values.back(), fields.back());
    script_.rows_.push_back(row);
  }

  std::uint32_t buttons(double value, const std::string& field) const {
    if (value < 0.0 || value > kLargestButtons || value != std::floor(value)) {
      fail("button " + in_quotes(field) + " is not a whole number",
           "give 0, or 1 for the grab button");
    }
    return static_cast<std::uint32_t>(value);
  }

  const std::string& name_;
  StylusScript& script_;
  int line_ = 0;
  std::size_t columns_ = 0;
  bool has_orientation_ = false;
  bool has_button_ = false;
};

StylusScript StylusScript::parse(std::istream& text, const std::string& name) {
  StylusScript script;
  Parser parser(name, script);
  std::string line;
  while (std::getline(text, line)) parser.line(line);
  parser.finish();
  return script;
}

StylusScript StylusScript::load(const std::filesystem::path& path) {
  constexpr std::uintmax_t kMostBytes = 256 << 20;  // some hours of rows
  if (std::filesystem::is_regular_file(path)) require_file(path, kMostBytes);
  std::ifstream file(path);
  if (!std::filesystem::is_regular_file(path) || !file) {
    throw Error(path.string(), "no such stylus script", "check the path");
  }
  return parse(file, path.string());
}

StylusPose StylusScript::at(double time) const noexcept {
  if (time <= start()) return rows_.front().pose;
  if (time >= end()) return rows_.back().pose;
  const auto after =
      std::upper_bound(rows_.begin(), rows_.end(), time,
                       [](double value, const Row& row) { return value < row.time; });
  const Row& b = *after;
  const Row& a = *(after - 1);
  const double share = (time - a.time) / (b.time - a.time);
  StylusPose pose = a.pose;
  pose.tip += share * (b.pose.tip - a.pose.tip);
  pose.orientation = a.pose.orientation.slerp(share, b.pose.orientation).normalized();
  return pose;
}

}  // namespace irdm
