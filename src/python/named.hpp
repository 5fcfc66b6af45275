// Kernels, methods and solvers by the names that they have in files.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace gaussdrift::python {

/// The one of that name. Throws std::invalid_argument that lists all. `what` they are: "method".
template <class Enum>
Enum one_named(const std::string& what, const std::vector<Enum>& all, const std::string& name) {
  std::string known;
  for (const Enum one : all) {
    if (to_string(one) == name) return one;
    known += (known.empty() ? "" : ", ") + to_string(one);
  }
  throw std::invalid_argument("there is no " + what + " \"" + name + "\". There are: " + known);
}

}  // namespace gaussdrift::python
