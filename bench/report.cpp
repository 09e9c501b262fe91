#include "bench/report.hpp"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "bench/machine.hpp"

namespace irdm::bench {
namespace {

std::string number_text(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.4g", value);
  return text.data();
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + '"';
}

std::string json(const Report::Value& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return quoted(*text);
  const double number = std::get<double>(value);
  return number == number ? number_text(number) : "null";
}

}  // namespace

Report::Report(std::string name) : name_(std::move(name)) {}

void Report::table(const std::string& name, const std::vector<std::string>& columns) {
  if (!tables_.empty()) std::printf("\n");
  tables_.push_back({name, columns, {}});
  std::printf("%s:\n\n|", name.c_str());
  for (const std::string& column : columns) std::printf(" %s |", column.c_str());
  std::printf("\n|");
  for (std::size_t i = 0; i < columns.size(); ++i) std::printf(" --- |");
  std::printf("\n");
  std::fflush(stdout);
}

void Report::row(const std::vector<Value>& values) {
  tables_.back().rows.push_back(values);
  std::printf("|");
  for (const Value& value : values) {
    const auto* text = std::get_if<std::string>(&value);
    std::printf(" %s |", text ? text->c_str() : number_text(std::get<double>(value)).c_str());
  }
  std::printf("\n");
  std::fflush(stdout);
}

Report::~Report() {
  const char* folder = std::getenv("IRDM_BENCH_JSON");
  if (folder == nullptr) return;
  std::ofstream file(std::filesystem::path(folder) / (name_ + ".json"));
  file << "{\"benchmark\": " << quoted(name_) << ",\n \"machine\": " << machine_json()
       << ",\n \"tables\": {";
  for (std::size_t t = 0; t < tables_.size(); ++t) {
    const Table& table = tables_[t];
    file << (t > 0 ? "," : "") << "\n  " << quoted(table.name) << ": [";
    for (std::size_t r = 0; r < table.rows.size(); ++r) {
      file << (r > 0 ? "," : "") << "\n   {";
      for (std::size_t c = 0; c < table.columns.size() && c < table.rows[r].size(); ++c) {
        file << (c > 0 ? ", " : "") << quoted(table.columns[c]) << ": " << json(table.rows[r][c]);
      }
      file << "}";
    }
    file << "]";
  }
  file << "}}\n";
}

}  // namespace irdm::bench
