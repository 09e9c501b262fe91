#include "common/config/toml_reader.hpp"

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

TomlTable TomlTable::adopt(toml::table root, std::string name, std::filesystem::path folder) {
  auto document =
      std::make_shared<Document>(Document{std::move(root), std::move(name), std::move(folder)});
  const toml::table* table = &document->root;
  return {std::move(document), table, ""};
}

TomlTable TomlTable::parse_file(const std::filesystem::path& path) {
  require_file(path);
  try {
    return adopt(toml::parse_file(path.string()), path.string(),
                 std::filesystem::absolute(path).parent_path());
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
    return adopt(toml::parse(text), name, folder);
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
  const toml::node* node = key.empty() ? nullptr : table_->get(key);
  const auto line = node != nullptr ? node->source().begin.line : table_->source().begin.line;
  std::string where = document_->name;
  if (line > 0) where += ":" + std::to_string(line);
  throw Error(where, (key.empty() ? "[" + name_ + "]" : full_name(key)) + " " + what, remedy);
}

bool TomlTable::has(const std::string& key) const {
  return table_->contains(key);
}

const toml::node* TomlTable::find(const std::string& key) {
  read_.insert(key);
  return table_->get(key);
}

const toml::node& TomlTable::need(const std::string& key) {
  const toml::node* node = find(key);
  if (node == nullptr) {
    const std::optional<std::string> meant = nearest_word(key, keys_not_read());
    fail(key, "is missing", meant ? "add it, or is it " + in_quotes(*meant) + "?" : "add it");
  }
  return *node;
}

double TomlTable::checked(const std::string& key, const toml::node& node,
                          const Range& range) const {
  const std::optional<double> value = node.value<double>();
  if (!node.is_number() || !value) fail(key, "is not a number", "give " + describe(range));
  if (!range.contains(*value)) fail(key, "is " + number_text(*value), "give " + describe(range));
  return *value;
}

double TomlTable::number(const std::string& key, const Range& range) {
  return checked(key, need(key), range);
}

double TomlTable::number(const std::string& key, const Range& range, double fallback) {
  const toml::node* node = find(key);
  return node == nullptr ? fallback : checked(key, *node, range);
}

int TomlTable::integer(const std::string& key, int lowest, int highest) {
  const toml::node& node = need(key);
  const std::string wanted =
      "give a whole number from " + std::to_string(lowest) + " to " + std::to_string(highest);
  if (!node.is_integer()) fail(key, "is not a whole number", wanted);
  const std::int64_t value = node.value<std::int64_t>().value_or(0);
  if (value < lowest || value > highest) fail(key, "is " + std::to_string(value), wanted);
  return static_cast<int>(value);
}

int TomlTable::integer(const std::string& key, int lowest, int highest, int fallback) {
  return has(key) ? integer(key, lowest, highest) : (find(key), fallback);
}

bool TomlTable::boolean(const std::string& key, bool fallback) {
  const toml::node* node = find(key);
  if (node == nullptr) return fallback;
  if (!node->is_boolean()) fail(key, "is not true or false", "give true or false");
  return node->value<bool>().value_or(fallback);
}

std::string TomlTable::text(const std::string& key) {
  const toml::node& node = need(key);
  if (!node.is_string()) fail(key, "is not text", "give text in quotes");
  std::string text = node.value<std::string>().value_or("");
  if (text.size() > lab::kLongestText) {
    fail(key, "has " + std::to_string(text.size()) + " bytes",
         "give at most " + std::to_string(lab::kLongestText));
  }
  return text;
}

std::string TomlTable::text(const std::string& key, const std::string& fallback) {
  return has(key) ? text(key) : (find(key), fallback);
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
  return (document_->folder / name).lexically_normal();
}

std::vector<double> TomlTable::numbers(const std::string& key, std::size_t count,
                                       const Range& range) {
  const toml::array* array = need(key).as_array();
  const std::string wanted = "give a list of " + std::to_string(count) + " numbers";
  if (array == nullptr) fail(key, "is not a list", wanted);
  if (array->size() != count) {
    fail(key, "has " + std::to_string(array->size()) + " entries", wanted);
  }
  std::vector<double> values;
  for (const toml::node& node : *array) values.push_back(checked(key, node, range));
  return values;
}

std::vector<double> TomlTable::numbers(const std::string& key, std::size_t count,
                                       const Range& range, const std::vector<double>& fallback) {
  return has(key) ? numbers(key, count, range) : (find(key), fallback);
}

TomlTable TomlTable::table(const std::string& key, bool required) {
  const toml::node* node = required ? &need(key) : find(key);
  if (node == nullptr) return {document_, &kEmptyTable, full_name(key)};
  if (!node->is_table()) fail(key, "is not a table", "write it as [" + full_name(key) + "]");
  return {document_, node->as_table(), full_name(key)};
}

std::vector<TomlTable> TomlTable::tables(const std::string& key) {
  std::vector<TomlTable> found;
  const toml::node* node = find(key);
  if (node == nullptr) return found;
  const toml::array* array = node->as_array();
  if (array == nullptr || !std::all_of(array->begin(), array->end(),
                                       [](const toml::node& each) { return each.is_table(); })) {
    fail(key, "is not a list of tables", "write it as [[" + full_name(key) + "]]");
  }
  for (const toml::node& each : *array) {
    found.push_back(
        {document_, each.as_table(), full_name(key) + "[" + std::to_string(found.size()) + "]"});
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
  for (const auto& [key, node] : *table_) {
    if (!read_.contains(std::string(key.str()))) keys.emplace_back(key.str());
  }
  return keys;
}

}  // namespace irdm
