#pragma once

#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace irdm::bench {

/// The tables of one benchmark: each row is printed as Markdown when it is there, and all of them
/// are written at the end, with what the machine is, to NAME.json in the folder that the
/// environment variable IRDM_BENCH_JSON names; without it, nowhere.
class Report {
 public:
  using Value = std::variant<double, std::string>;

  /// @param name of the benchmark, as of its program without "bench_"
  explicit Report(std::string name);
  Report(const Report&) = delete;
  Report& operator=(const Report&) = delete;
  ~Report();

  /// Begins a table. @param columns with their units, as "time [us]"
  void table(const std::string& name, const std::vector<std::string>& columns);
  /// One value a column.
  void row(const std::vector<Value>& values);

 private:
  struct Table {
    std::string name;
    std::vector<std::string> columns;
    std::vector<std::vector<Value>> rows;
  };

  std::string name_;
  std::vector<Table> tables_;
};

}  // namespace irdm::bench
