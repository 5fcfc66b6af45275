#include "time/tableau.hpp"

#include <stdexcept>

namespace gaussdrift::time {

const std::vector<Tableau>& tableaux() {
  static const std::vector<Tableau> all{
      // The classical method of order 4 [Sch06, 5.3.1].
      {"rk4", 4, 4, {1. / 2, 0, 1. / 2, 0, 0, 1}, {1. / 6, 1. / 3, 1. / 3, 1. / 6}, {0, 1. / 2, 1. / 2, 1}},
  };
  return all;
}

const Tableau& find_tableau(std::string_view name) {
  for (const auto& tableau : tableaux())
    if (tableau.name == name) return tableau;
  throw std::out_of_range("no Runge-Kutta method is called " + std::string(name));
}

}  // namespace gaussdrift::time
