#include "common/config/toml_reader.hpp"

#include <toml++/toml.h>
#include <algorithm>

#include "common/config/input_file.hpp"
#include "common/config/near_word.hpp"
#include "common/config/range.hpp"
#include "common/error.hpp"

namespace irdm {
namespace {

const toml::table kEmptyTable;
constexpr std::size_t kMostOfParser = 160;  // its own words, and perhaps some of the file
constexpr std::size_t kLongestFileName = 255;

}  // namespace

struct TomlTable::Table {
  struct Document {
    toml::table root;
    std::string name;
    std::filesystem::path folder;
  };

  std::shared_ptr<const Document> document;
  const toml::table* nodes;

  static std::shared_ptr<const Table> root(toml::table nodes, std::string name,
                                           std::filesystem::path folder) {
    auto document =
        std::make_shared<Document>(Document{std::move(nodes), std::move(name), std::move(folder)});
    const toml::table* root = &document->root;
    return std::make_shared<Table>(Table{std::move(document), root});
  }

  std::shared_ptr<const Table> child(const toml::table* table) const {
    return std::make_shared<Table>(Table{document, table});
  }

  /// Returns the node of a key and marks the key as read; nullptr when it is absent.
  static const toml::node* find(TomlTable& table, const std::string& key) {
    table.read_.insert(key);
    return table.table_->nodes->get(key);
  }

  static const toml::node& need(TomlTable& table, const std::string& key) {
    const toml::node* node = find(table, key);
    if (node == nullptr) {
      const std::optional<std::string> meant = nearest_word(key, table.keys_not_read());
      table.fail(key, "is missing",
                 meant ? "add it, or is it " + in_quotes(*meant) + "?" : "add it");
    }
    return *node;
  }

  static int whole(const TomlTable& table, const std::string& key, const toml::node& node,
                   int lowest, int highest, const std::string& wanted) {
    if (!node.is_integer()) table.fail(key, "is not a whole number", wanted);
    const std::int64_t value = node.value<std::int64_t>().value_or(0);
    if (value < lowest || value > highest) table.fail(key, "is " + std::to_string(value), wanted);
    return static_cast<int>(value);
  }

  static double checked(const TomlTable& table, const std::string& key, const toml::node& node,
                        const Range& range) {
    const std::optional<double> value = node.value<double>();
    if (!node.is_number() || !value) {
      table.fail(key, "is not a number", "give " + describe(range));
    }
    if (!range.contains(*value)) {
      table.fail(key, "is " + exact_text(range, *value), "give " + describe(range));
    }
    return *value;
  }
};

TomlTable TomlTable::parse_file(const std::filesystem::path& path) {
  require_file(path, kMostConfigBytes);
  try {
    return {Table::root(toml::parse_file(path.string()), path.string(),
                        std::filesystem::absolute(path).parent_path()),
            ""};
  } catch (const toml::parse_error& error) {
    throw Error(path.string() + ":" + std::to_string(error.source().begin.line),
                shortened(error.description(), kMostOfParser), "correct the TOML syntax");
  }
}

TomlTable TomlTable::parse_text(const std::string& text, const std::string& name) {
  return parse_text(text, name, std::filesystem::current_path());
}

TomlTable TomlTable::parse_text(const std::string& text, const std::string& name,
                                const std::filesystem::path& folder) {
  try {
    return {Table::root(toml::parse(text), name, folder), ""};
  } catch (const toml::parse_error& error) {
    throw Error(name + ":" + std::to_string(error.source().begin.line),
                shortened(error.description(), kMostOfParser), "correct the TOML syntax");
  }
}

std::string TomlTable::full_name(const std::string& key) const {
  return shortened(name_.empty() ? key : name_ + "." + key);
}

void TomlTable::fail(const std::string& key, const std::string& what,
                     const std::string& remedy) const {
  const toml::table& nodes = *table_->nodes;
  const toml::node* node = key.empty() ? nullptr : nodes.get(key);
  const auto line = node != nullptr ? node->source().begin.line : nodes.source().begin.line;
  std::string where = table_->document->name;
  if (line > 0) where += ":" + std::to_string(line);
  throw Error(where, (key.empty() ? "[" + name_ + "]" : full_name(key)) + " " + what, remedy);
}

bool TomlTable::has(const std::string& key) const {
  return table_->nodes->contains(key);
}

double TomlTable::number(const std::string& key, const Range& range) {
  return Table::checked(*this, key, Table::need(*this, key), range);
}

double TomlTable::number(const std::string& key, const Range& range, double fallback) {
  const toml::node* node = Table::find(*this, key);
  return node == nullptr ? fallback : Table::checked(*this, key, *node, range);
}

int TomlTable::integer(const std::string& key, int lowest, int highest) {
  const toml::node& node = Table::need(*this, key);
  const std::string wanted =
      "give a whole number from " + std::to_string(lowest) + " to " + std::to_string(highest);
  return Table::whole(*this, key, node, lowest, highest, wanted);
}

std::vector<int> TomlTable::integers(const std::string& key, std::size_t count, int lowest,
                                     int highest) {
  const toml::array* array = Table::need(*this, key).as_array();
  const std::string wanted = "give a list of " + std::to_string(count) + " whole numbers from " +
                             std::to_string(lowest) + " to " + std::to_string(highest);
  if (array == nullptr) fail(key, "is not a list", wanted);
  if (array->size() != count) {
    fail(key, "has " + std::to_string(array->size()) + " entries", wanted);
  }
  std::vector<int> values;
  for (const toml::node& node : *array) {
    values.push_back(Table::whole(*this, key, node, lowest, highest, wanted));
  }
  return values;
}

int TomlTable::integer(const std::string& key, int lowest, int highest, int fallback) {
  return has(key) ? integer(key, lowest, highest) : (Table::find(*this, key), fallback);
}

bool TomlTable::boolean(const std::string& key, bool fallback) {
  const toml::node* node = Table::find(*this, key);
  if (node == nullptr) return fallback;
  if (!node->is_boolean()) fail(key, "is not true or false", "give true or false");
  return node->value<bool>().value_or(fallback);
}

std::string TomlTable::text(const std::string& key) {
  const toml::node& node = Table::need(*this, key);
  if (!node.is_string()) fail(key, "is not text", "give text in quotes");
  std::string text = node.value<std::string>().value_or("");
  if (text.size() > lab::kLongestText) {
    fail(key, "has " + std::to_string(text.size()) + " bytes",
         "give at most " + std::to_string(lab::kLongestText));
  }
  return text;
}

std::string TomlTable::text(const std::string& key, const std::string& fallback) {
  return has(key) ? text(key) : (Table::find(*this, key), fallback);
}

std::string TomlTable::choice(const std::string& key, const std::vector<std::string>& words,
                              const std::string& fallback) {
  const std::string word = text(key, fallback);
  if (std::find(words.begin(), words.end(), word) == words.end()) {
    std::string list;
    for (const std::string& each : words) list += (list.empty() ? "" : " | ") + each;
    fail(key, "is " + in_quotes(word), "give one of: " + list);
  }
  return word;
}

std::filesystem::path TomlTable::path(const std::string& key) {
  const std::string name = text(key);
  if (name.empty()) fail(key, "is empty", "give a path");
  for (const auto& part : std::filesystem::path(name)) {
    if (part.string().size() <= kLongestFileName) continue;
    fail(key, "has the file name " + in_quotes(part.string()),
         "give names of at most " + std::to_string(kLongestFileName) + " bytes");
  }
  return (table_->document->folder / name).lexically_normal();
}

std::vector<double> TomlTable::numbers(const std::string& key, std::size_t count,
                                       const Range& range) {
  const toml::array* array = Table::need(*this, key).as_array();
  const std::string wanted = "give a list of " + std::to_string(count) + " numbers";
  if (array == nullptr) fail(key, "is not a list", wanted);
  if (array->size() != count) {
    fail(key, "has " + std::to_string(array->size()) + " entries", wanted);
  }
  std::vector<double> values;
  for (const toml::node& node : *array) {
    values.push_back(Table::checked(*this, key, node, range));
  }
  return values;
}

std::vector<double> TomlTable::numbers(const std::string& key, std::size_t count,
                                       const Range& range, const std::vector<double>& fallback) {
  return has(key) ? numbers(key, count, range) : (Table::find(*this, key), fallback);
}

TomlTable TomlTable::table(const std::string& key, bool required) {
  const toml::node* node = required ? &Table::need(*this, key) : Table::find(*this, key);
  if (node == nullptr) return {table_->child(&kEmptyTable), full_name(key)};
  if (!node->is_table()) fail(key, "is not a table", "write it as [" + full_name(key) + "]");
  return {table_->child(node->as_table()), full_name(key)};
}

std::vector<TomlTable> TomlTable::tables(const std::string& key) {
  std::vector<TomlTable> found;
  const toml::node* node = Table::find(*this, key);
  if (node == nullptr) return found;
  const toml::array* array = node->as_array();
  if (array == nullptr || !std::all_of(array->begin(), array->end(),
                                       [](const toml::node& each) { return each.is_table(); })) {
    fail(key, "is not a list of tables", "write it as [[" + full_name(key) + "]]");
  }
  for (const toml::node& each : *array) {
    found.push_back({table_->child(each.as_table()),
                     full_name(key) + "[" + std::to_string(found.size()) + "]"});
  }
  return found;
}

void TomlTable::finish() const {
  const std::vector<std::string> unknown = keys_not_read();
  if (unknown.empty()) return;
  const std::optional<std::string> meant =
      nearest_word(unknown.front(), {read_.begin(), read_.end()});
  fail(unknown.front(), "is not a known key",
       meant ? "did you mean " + in_quotes(*meant) + "?" : "remove it or correct its name");
}

std::vector<std::string> TomlTable::keys_not_read() const {
  std::vector<std::string> keys;
  for (const auto& [key, node] : *table_->nodes) {
    if (!read_.contains(std::string(key.str()))) keys.emplace_back(key.str());
  }
  return keys;
}

}  // namespace irdm
