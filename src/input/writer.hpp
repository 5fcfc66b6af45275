// The text of a case while it is written. Numbers have as many digits as it takes to read the same bits.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gaussdrift/case.hpp"
#include "input/registry.hpp"

namespace gaussdrift::input {

std::string written(double value);
std::string written(const std::string& text);

template <class Item>
std::string written(const std::vector<Item>& list) {
  std::vector<std::string> items;
  items.reserve(list.size());
  for (const auto& item : list) items.push_back(written(item));
  return fmt::format("[{}]", fmt::join(items, ", "));
}

/// The names of enumerators are the choices of the key, in the same order.
template <class Enum>
std::string written_choice(const Key& key, Enum value) {
  return written(std::string(key.choices.at(static_cast<std::size_t>(value))));
}

class Writer {
 public:
  /// Data files are named as seen from the folder; empty: by the names that they have.
  explicit Writer(std::filesystem::path folder) : folder_(std::move(folder)) {}
  void table(std::string_view name);
  /// One of `count` parts of a table that may be repeated.
  void part(std::string_view name, std::size_t count);
  void entry(std::string_view name, const std::string& value);
  /// Parameters of a named formula; an infinite one is the default "none".
  void arguments(std::string_view table, const std::string& named, const Arguments& list);
  std::string data_file(const std::filesystem::path& file) const;
  const std::string& text() const { return text_; }

 private:
  std::filesystem::path folder_;
  std::string text_;
};

}  // namespace gaussdrift::input
