// Explicit Runge-Kutta methods as data (Butcher tableaux).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/catalogue.hpp"

namespace gaussdrift::time {

struct Tableau {
  std::string name;
  int stages = 0;
  int time_order = 0;
  std::vector<double> stage_weights;       // a_il, row i has i entries: strictly lower triangle, row by row
  std::vector<double> weights;             // b_i
  std::vector<double> nodes;               // c_i
  std::vector<double> error_weights = {};  // b_i minus those of an embedded method of lower order; empty: none
  std::string meaning = {};                // as of a NamedChoice (base/named.hpp)

  double a(int i, int l) const { return stage_weights[static_cast<std::size_t>(i * (i - 1) / 2 + l)]; }
  double b(int i) const { return weights[static_cast<std::size_t>(i)]; }
  double c(int i) const { return nodes[static_cast<std::size_t>(i)]; }
};

/// All methods, by the names of `time.method`; the first is the default, with fixed steps.
const std::vector<Tableau>& tableaux();

/// True if the error of a step can be estimated, and with it the step chosen.
inline bool is_adaptive(const Tableau& tableau) { return !tableau.error_weights.empty(); }

/// Those of which is_adaptive() holds, for messages: "\"dopri5\"".
std::string adaptive_names();

/// Throws std::out_of_range for an unknown name.
const Tableau& find_tableau(std::string_view name);

}  // namespace gaussdrift::time

namespace gaussdrift::base {
template <>
std::vector<time::Tableau>& catalogue();
}
