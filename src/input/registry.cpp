#include "input/registry.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "expression/expression.hpp"

namespace gaussdrift::input {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::string quoted(std::string_view text) { return fmt::format("\"{}\"", text); }

std::string joined(const std::vector<std::string_view>& words) {
  std::vector<std::string> shown;
  shown.reserve(words.size());
  for (const auto word : words) shown.push_back(quoted(word));
  return fmt::format("{}", fmt::join(shown, ", "));
}

}  // namespace

const std::vector<Table>& tables() {
  static const std::vector<Table> list = {
      {"case", false, "what the case is called and where it comes from"},
      {"params", false, "names for numbers: `R = 0.25`; later ones may use earlier ones"},
      {"domain", true, "the box on which density is evaluated and particles start"},
      {"velocity", true, "the prescribed velocity u: either `u` or `field`"},
      {"density", true, "the density rho_0 at t = 0: either `expression` or `shape`"},
      {"particles", true, "the lattice on which particles start, and the blob each carries"},
      {"time", true, "how long, and in which steps"},
      {"evaluate", false, "the lattice on which density is summed for output"},
      {"output", false, "when to write, and what: either `times` or `frames`"},
  };
  return list;
}

const std::vector<Key>& keys() {
  static const std::vector<Key> list = {
      {.table = "",
       .name = "gaussdrift",
       .type = Type::whole,
       .required = true,
       .range = {1, 1},
       .meaning = "version of the case format; this program reads version 1"},

      {.table = "case", .name = "title", .meaning = "one line for pictures and reports"},
      {.table = "case", .name = "cite", .meaning = "the source of the case"},

      {.table = "domain",
       .name = "min",
       .type = Type::numbers,
       .required = true,
       .unit = "length",
       .meaning = "lower corner: 2 numbers in 2D, 3 in 3D"},
      {.table = "domain",
       .name = "max",
       .type = Type::numbers,
       .required = true,
       .unit = "length",
       .meaning = "upper corner, above `min` on every axis"},

      {.table = "velocity",
       .name = "u",
       .type = Type::expressions,
       .unit = "length / time",
       .symbol = "u",
       .meaning = "velocity, one expression a dimension"},
      {.table = "velocity",
       .name = "field",
       .type = Type::choice,
       .choices = {"rotation"},
       .meaning = "a named field: rigid rotation, in 3D about the z axis"},
      {.table = "velocity",
       .name = "center",
       .type = Type::point,
       .fallback = "origin",
       .unit = "length",
       .meaning = "centre of the rotation; only with `field`"},
      {.table = "velocity",
       .name = "rate",
       .type = Type::number,
       .fallback = "1",
       .unit = "radians / time",
       .meaning = "angular velocity, counter-clockwise; only with `field`"},

      {.table = "density",
       .name = "expression",
       .type = Type::expression,
       .symbol = "rho_0",
       .meaning = "density at t = 0"},
      {.table = "density",
       .name = "shape",
       .type = Type::choice,
       .choices = {"wendland", "cone", "gaussian", "disk"},
       .meaning = "a radial shape"},
      {.table = "density",
       .name = "center",
       .type = Type::point,
       .unit = "length",
       .meaning = "centre of the shape; needed with `shape`"},
      {.table = "density",
       .name = "radius",
       .type = Type::number,
       .range = {0, infinity, true},
       .unit = "length",
       .meaning = "radius of the shape; needed with `shape`"},
      {.table = "density",
       .name = "height",
       .type = Type::number,
       .fallback = "1",
       .meaning = "density at the centre; only with `shape`"},

      {.table = "particles",
       .name = "per_axis",
       .type = Type::whole,
       .required = true,
       .range = {2, infinity},
       .symbol = "n_g",
       .meaning = "lattice points on the longest axis; the spacing h is the same on all axes"},
      {.table = "particles",
       .name = "overlap",
       .type = Type::number,
       .fallback = "2",
       .range = {0, infinity, true},
       .symbol = "c",
       .meaning = "core radius of a blob divided by h: eps = c h"},
      {.table = "particles",
       .name = "cutoff",
       .type = Type::choice,
       .fallback = "gauss2",
       .choices = {"gauss2", "gauss4"},
       .symbol = "zeta",
       .meaning = "the blob: a Gaussian of order 2, or its combination with derivatives of order 4"},

      {.table = "time",
       .name = "end",
       .type = Type::number,
       .required = true,
       .range = {0, infinity},
       .unit = "time",
       .symbol = "T",
       .meaning = "the run ends here; it begins at 0"},
      {.table = "time",
       .name = "step",
       .type = Type::number,
       .required = true,
       .range = {0, infinity, true},
       .unit = "time",
       .symbol = "tau",
       .meaning = "time step; the last one before an output is shortened to land on it"},
      {.table = "time",
       .name = "method",
       .type = Type::choice,
       .fallback = "rk4",
       .choices = {"rk4"},
       .meaning = "time integrator: the classical Runge-Kutta method of order 4"},

      {.table = "evaluate",
       .name = "per_axis",
       .type = Type::whole,
       .fallback = "200",
       .range = {2, infinity},
       .symbol = "n_ge",
       .meaning = "evaluation points on the longest axis"},
      {.table = "evaluate",
       .name = "tolerance",
       .type = Type::number,
       .fallback = "1e-08",
       .range = {1e-14, 1, false, true},
       .meaning = "error allowed in the Gauss transform, relative to the largest density at that output"},
      {.table = "evaluate",
       .name = "method",
       .type = Type::choice,
       .fallback = "auto",
       .choices = {"auto", "direct", "hermite", "cells", "outer", "chebyshev", "spread"},
       .meaning = "how the Gauss transform is summed; auto takes the cheapest"},

      {.table = "output",
       .name = "times",
       .type = Type::numbers,
       .range = {0, infinity},
       .unit = "time",
       .meaning = "ascending times between 0 and `time.end`"},
      {.table = "output",
       .name = "frames",
       .type = Type::whole,
       .fallback = "5",
       .range = {1, 1e6},
       .meaning = "so many times instead, evenly spaced from 0 to `time.end`; 1 means the end alone"},
      {.table = "output",
       .name = "vtk",
       .type = Type::choices,
       .fallback = "density, particles",
       .choices = {"density", "particles"},
       .meaning = "files for ParaView"},
      {.table = "output",
       .name = "images",
       .type = Type::choices,
       .fallback = "surface",
       .choices = {"surface", "contour", "heatmap"},
       .meaning = "pictures; in 3D none yet, and `[]` is the default there"},
  };
  return list;
}

bool Range::contains(double value) const {
  return (least_open ? value > least : value >= least) && (most_open ? value < most : value <= most);
}

std::string Range::text() const {
  const bool below = std::isfinite(least), above = std::isfinite(most);
  const std::string lower = fmt::format("{} {}", least_open ? "greater than" : "at least", least);
  const std::string upper = fmt::format("{} {}", most_open ? "less than" : "at most", most);
  if (below && above && least == most) return fmt::format("{}", least);
  if (below && above) return lower + " and " + upper;
  return below ? lower : above ? upper : "";
}

const Key& find_key(std::string_view table, std::string_view name) {
  for (const Key& key : keys())
    if (key.table == table && key.name == name) return key;
  throw std::logic_error(fmt::format("no key {}.{} in the registry", table, name));
}

std::vector<std::string> key_names(std::string_view table) {
  std::vector<std::string> names;
  for (const Key& key : keys())
    if (key.table == table) names.emplace_back(key.name);
  return names;
}

std::vector<std::string> table_names() {
  std::vector<std::string> names;
  for (const Table& table : tables()) names.emplace_back(table.name);
  return names;
}

std::string type_text(const Key& key) {
  switch (key.type) {
    case Type::text:
      return "a string";
    case Type::number:
      return "a number or an expression";
    case Type::whole:
      return "a whole number";
    case Type::numbers:
      return "a list of numbers";
    case Type::point:
      return "a list of numbers, one a dimension";
    case Type::expression:
      return "an expression in a string";
    case Type::expressions:
      return "a list of expressions in strings, one a dimension";
    case Type::choice:
      return key.choices.size() == 1 ? quoted(key.choices[0]) : "one of " + joined(key.choices);
    case Type::choices:
      return "a list of some of " + joined(key.choices);
  }
  return "";
}

std::string registry_markdown() {
  const Key& version = find_key("", "gaussdrift");
  std::string text = fmt::format("`{}` at the top of the file, required: {}.\n", version.name, version.meaning);
  for (const Table& table : tables()) {
    text += fmt::format("\n### `[{}]`\n\n{}{}.\n", table.name, static_cast<char>(std::toupper(table.meaning[0])),
                        table.meaning.substr(1));
    if (key_names(table.name).empty()) continue;
    text += "\n| key | what | type and range | default | unit | symbol |\n| --- | --- | --- | --- | --- | --- |\n";
    for (const Key& key : keys()) {
      if (key.table != table.name) continue;
      const std::string range = key.range.text();
      std::string fallback = key.required ? "required" : std::string(key.fallback);
      if (key.type == Type::choice && !fallback.empty()) fallback = quoted(fallback);
      if (key.type == Type::choices) fallback = fmt::format("[{}]", fallback);
      text += fmt::format("| `{}` | {} | {}{}{} | {} | {} | {} |\n", key.name, key.meaning, type_text(key),
                          range.empty() ? "" : ", ", range, fallback, key.unit, key.symbol);
    }
  }
  return text;
}

std::string functions_markdown() {
  std::string text = "| function | value |\n| --- | --- |\n";
  for (const FunctionInfo& function : expression_functions()) {
    const char* arguments = function.arguments == 1 ? "a" : function.arguments < 0 ? "a, b, ..." : "a, b";
    text += fmt::format("| `{}({})` | {} |\n", function.name, arguments, function.meaning);
  }
  return text;
}

}  // namespace gaussdrift::input
