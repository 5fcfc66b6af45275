#include "time/tableau.hpp"

namespace gaussdrift::base {

template <>
std::vector<time::Tableau>& catalogue() {
  static std::vector<time::Tableau> all{
      {.name = "rk4",
       .stages = 4,
       .time_order = 4,
       .stage_weights = {1. / 2, 0, 1. / 2, 0, 0, 1},
       .weights = {1. / 6, 1. / 3, 1. / 3, 1. / 6},
       .nodes = {0, 1. / 2, 1. / 2, 1},
       .meaning = "is the classical method, of order 4"},  // [Sch06, 5.3.1]
      {.name = "euler",
       .stages = 1,
       .time_order = 1,
       .stage_weights = {},
       .weights = {1},
       .nodes = {0},
       .meaning = "is Euler's method, of order 1"},
      {.name = "heun",
       .stages = 2,
       .time_order = 2,
       .stage_weights = {1},
       .weights = {1. / 2, 1. / 2},
       .nodes = {0, 1},
       .meaning = "is Heun's method, of order 2"},  // the explicit trapezoidal rule
      {.name = "rk4-38",
       .stages = 4,
       .time_order = 4,
       .stage_weights = {1. / 3, -1. / 3, 1, 1, -1, 1},
       .weights = {1. / 8, 3. / 8, 3. / 8, 1. / 8},
       .nodes = {0, 1. / 3, 2. / 3, 1},
       .meaning = "is Kutta's 3/8 rule, of order 4"},  // [Kut01]
      {.name = "dopri5",
       .stages = 7,
       .time_order = 5,
       .stage_weights = {1. / 5,                   //
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
       .weights = {35. / 384, 0, 500. / 1113, 125. / 192, -2187. / 6784, 11. / 84, 0},
       .nodes = {0, 1. / 5, 3. / 10, 4. / 5, 8. / 9, 1, 1},
       .error_weights = {35. / 384 - 5179. / 57600, 0, 500. / 1113 - 7571. / 16695, 125. / 192 - 393. / 640,
                         -2187. / 6784 + 92097. / 339200, 11. / 84 - 187. / 2100, -1. / 40},
       // With an embedded method of order 4 [DP80, Table 2].
       .meaning = "is the method of Dormand and Prince, of order 5, and chooses its own steps"},
  };
  return all;
}

}  // namespace gaussdrift::base

namespace gaussdrift::time {

const std::vector<Tableau>& tableaux() { return base::catalogue<Tableau>(); }

std::string adaptive_names() {
  std::string names;
  for (const Tableau& tableau : tableaux())
    if (is_adaptive(tableau)) names += (names.empty() ? "\"" : " or \"") + tableau.name + "\"";
  return names;
}

const Tableau& find_tableau(std::string_view name) { return base::find_named(tableaux(), "Runge-Kutta method", name); }

}  // namespace gaussdrift::time
