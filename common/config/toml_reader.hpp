#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/config/range.hpp"

/// Strict reading of configuration files: every key that is read is checked for type and range, and
/// every key that nobody read is an error. All errors are irdm::Error with file and line.
namespace irdm {

/// One table of a TOML file. Reading consumes keys; finish() rejects what is left over.
class TomlTable {
 public:
  /// Parses a file. Throws Error when it is missing or not TOML.
  static TomlTable parse_file(const std::filesystem::path& path);
  /// Parses text; `name` stands for the file in messages.
  /// @param folder that relative paths begin at; the shorter form: the present one
  static TomlTable parse_text(const std::string& text, const std::string& name,
                              const std::filesystem::path& folder);
  static TomlTable parse_text(const std::string& text, const std::string& name);

  bool has(const std::string& key) const;

  double number(const std::string& key, const Range& range);  ///< required
  double number(const std::string& key, const Range& range, double fallback);
  int integer(const std::string& key, int lowest, int highest);  ///< required
  int integer(const std::string& key, int lowest, int highest, int fallback);
  std::vector<int> integers(const std::string& key, std::size_t count, int lowest, int highest);
  bool boolean(const std::string& key, bool fallback);
  std::string text(const std::string& key);  ///< required; at most lab::kLongestText bytes
  std::string text(const std::string& key, const std::string& fallback);
  /// One of a list of words.
  std::string choice(const std::string& key, const std::vector<std::string>& words,
                     const std::string& fallback);
  /// A path; a relative one is relative to the configuration file's folder. Required.
  std::filesystem::path path(const std::string& key);
  std::vector<double> numbers(const std::string& key, std::size_t count, const Range& range);
  std::vector<double> numbers(const std::string& key, std::size_t count, const Range& range,
                              const std::vector<double>& fallback);

  /// A table inside this one; absent and not required: an empty one.
  TomlTable table(const std::string& key, bool required = false);
  /// An array of tables ([[key]]); empty when absent.
  std::vector<TomlTable> tables(const std::string& key);

  /// Throws Error on the first key of this table that was never read.
  void finish() const;

  /// Throws Error about a key (or about the table when the key is empty), with file and line.
  [[noreturn]] void fail(const std::string& key, const std::string& what,
                         const std::string& remedy) const;

 private:
  struct Table;  ///< a table of toml++ and the document that owns it; defined in the source alone
  TomlTable(std::shared_ptr<const Table> table, std::string name)
      : table_(std::move(table)), name_(std::move(name)) {}
  std::vector<std::string> keys_not_read() const;
  std::string full_name(const std::string& key) const;

  std::shared_ptr<const Table> table_;
  std::string name_;
  std::set<std::string> read_;
};

}  // namespace irdm
