// A table of a case as the registry tells about it: what it is for, and its keys. Each stands beside what reads the
// table, in tables/; those of parameters are made from the things that have them.
#pragma once

#include <fmt/format.h>

#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "base/catalogue.hpp"
#include "input/registry.hpp"

namespace gaussdrift::input {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Section {
  Table table;
  std::vector<Key> keys;  // in the order of a well-written case file; the registry adds the name of the table
};

/// The key of a parameter. `with`, `value`: what it goes with in a table of several kinds.
Key key_of(const NamedParameter& parameter, std::string_view with = {}, std::string_view value = {});

/// The parameters of the named formulas that the key `with` chooses from.
template <class Named>
void add_parameters(std::vector<Key>& list, std::string_view with, const std::vector<Named>& all) {
  for (const Named& one : all)
    for (const NamedParameter& parameter : one.about.parameters)
      list.push_back(key_of(parameter, with, one.about.name));
}

/// "how weights are shared. `gauss8` is smooth. ...".
template <class Thing>
std::string with_choices(std::string_view meaning, const std::vector<Thing>& things) {
  std::string text(meaning);
  for (const Thing& thing : things) text += fmt::format(". `{}` {}", thing.name, thing.meaning);
  return text;
}

/// A text that is made, kept as long as the program runs.
std::string_view kept(std::string text);

}  // namespace gaussdrift::input
