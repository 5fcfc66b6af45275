#include "time/tableau.hpp"

#include <stdexcept>

namespace gaussdrift::time {

const std::vector<Tableau>& tableaux() {
  static const std::vector<Tableau> all{
      // The classical method of order 4 [Sch06, 5.3.1].
      {"rk4", 4, 4, {1. / 2, 0, 1. / 2, 0, 0, 1}, {1. / 6, 1. / 3, 1. / 3, 1. / 6}, {0, 1. / 2, 1. / 2, 1}},
      {"euler", 1, 1, {}, {1}, {0}},
      // Heun's method of order 2: the explicit trapezoidal rule.
      {"heun", 2, 2, {1}, {1. / 2, 1. / 2}, {0, 1}},
      // Kutta's 3/8 rule [Kut01].
      {"rk4-38", 4, 4, {1. / 3, -1. / 3, 1, 1, -1, 1}, {1. / 8, 3. / 8, 3. / 8, 1. / 8}, {0, 1. / 3, 2. / 3, 1}},
      // Dormand and Prince, order 5 with an embedded method of order 4 [DP80, Table 2].
      {"dopri5",
       7,
       5,
       {1. / 5,                   //
        3. / 40,        9. / 40,  //
        44. / 45,       -56. / 15,
        32. / 9,  //
        19372. / 6561,  -25360. / 2187,
        64448. / 6561,  -212. / 729,  //
        9017. / 3168,   -355. / 33,
        46732. / 5247,  49. / 176,
        -5103. / 18656,  //
        35. / 384,      0,
        500. / 1113,    125. / 192,
        -2187. / 6784,  11. / 84},
       {35. / 384, 0, 500. / 1113, 125. / 192, -2187. / 6784, 11. / 84, 0},
       {0, 1. / 5, 3. / 10, 4. / 5, 8. / 9, 1, 1},
       {35. / 384 - 5179. / 57600, 0, 500. / 1113 - 7571. / 16695, 125. / 192 - 393. / 640,
        -2187. / 6784 + 92097. / 339200, 11. / 84 - 187. / 2100, -1. / 40}},
  };
  return all;
}

const Tableau& find_tableau(std::string_view name) {
  for (const auto& tableau : tableaux())
    if (tableau.name == name) return tableau;
  throw std::out_of_range("no Runge-Kutta method is called " + std::string(name));
}

}  // namespace gaussdrift::time
