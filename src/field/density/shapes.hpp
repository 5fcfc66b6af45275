// Shapes of the initial density by name, `shape = "..."` of a case file.
#pragma once

#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "base/catalogue.hpp"
#include "base/named.hpp"
#include "field/density/density.hpp"

namespace gaussdrift {

struct NamedShape {
  NamedFormula about;
  /// From complete arguments.
  std::function<std::unique_ptr<InitialDensity>(int dimension, const Arguments& arguments)> make;
};

/// In the order of docs/cases.md.
const std::vector<NamedShape>& named_shapes();

/// Throws std::out_of_range for an unknown name.
const NamedShape& find_named_shape(std::string_view name);

}  // namespace gaussdrift

namespace gaussdrift::base {
template <>
std::vector<NamedShape>& catalogue();
}
