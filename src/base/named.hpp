// A named formula of a case file, such as a velocity field or a shape of density: its name, its meaning and the numbers
// that it takes. The reader, its messages and docs/cases.md are made from these facts.
#pragma once

#include <array>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gaussdrift {

/// Numbers from `least` to `most`; an end that is `open` is not among them.
struct Range {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool least_open = false, most_open = false;

  bool contains(double value) const {
    return (least_open ? value > least : value >= least) && (most_open ? value < most : value <= most);
  }
};

constexpr Range positive{0, std::numeric_limits<double>::infinity(), true, false};

/// One of the words that a parameter may have, and what it means: a phrase that continues the word, "is a Gaussian".
struct NamedChoice {
  std::string_view name, meaning;
};

struct NamedParameter {
  enum class Kind {
    number,
    whole,              // a number without a fraction
    point,              // one number a dimension
    choice,             // one of `choices`
    expression,         // a formula in x, y, z and the params
    expression_in_time  // and in t
  };
  std::string_view name;
  Kind kind = Kind::number;
  /// The default: a number, "none" (an infinite number), or for points "origin", "domain.min", "domain.max",
  /// "domain.center", or one number for every axis. Empty: the parameter is required.
  std::string_view fallback = {};
  Range range = {};  // of every number
  std::string_view unit = {};
  std::string_view symbol = {};  // in the literature
  std::string_view meaning = {};
  bool optional = false;                            // it may be left out, without a default
  std::vector<NamedChoice> (*choices)() = nullptr;  // of a choice
  std::string_view with = {}, value = {};           // it goes with this value of that choice, and has none elsewhere
  std::string_view replaced_by = {};                // a parameter in whose presence it has no value
};

/// Something wrong with the value of a key, for people.
struct Complaint {
  std::string_view key;  // "cutoff", or "particles.cutoff" of another table
  std::string message, remedy;
};

/// Parameters by name: one number, or a point as one number a dimension.
using Arguments = std::vector<std::pair<std::string, std::vector<double>>>;

struct NamedFormula {
  std::string_view name;
  std::string_view meaning;  // one line, with its source
  std::string_view formula = {};
  int least_dimension = 2, most_dimension = 3;
  std::vector<NamedParameter> parameters = {};
  /// The problem with arguments that are complete and each in range, as text for the user; empty if there is none.
  std::string (*problem)(int dimension, const Arguments& arguments) = nullptr;
};

/// The box that defaults refer to.
struct Box {
  int dimension = 2;
  std::array<double, 3> min{}, max{};
};

/// The default of a parameter that has one. Throws std::logic_error if the text of the default means nothing.
std::vector<double> default_value(const NamedParameter& parameter, const Box& domain);

/// `given` in the order of the formula's parameters, with defaults where nothing is given.
/// Throws std::invalid_argument for an unknown, missing or misshapen parameter: readers have checked before.
Arguments complete(const NamedFormula& formula, const Arguments& given, const Box& domain);
/// The same for the numbers and points of any `thing` that has parameters.
Arguments complete(std::string_view thing, const std::vector<NamedParameter>& parameters, const Arguments& given,
                   const Box& domain);

/// A parameter among complete arguments; std::out_of_range if there is none.
double number(const Arguments& arguments, std::string_view name);
std::array<double, 3> point(const Arguments& arguments, std::string_view name);

}  // namespace gaussdrift
