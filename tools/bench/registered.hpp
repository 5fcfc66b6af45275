// The constants of cost (src/fgtd/cost.hpp and those of the methods) as variables that can be found by name:
// tools/bench/CMakeLists.txt rewrites these headers for calibrate so that every constant registers itself here.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace bench {

struct Registered {
  std::string name;
  double* value;
  std::size_t count;  // of an array

  Registered(const char* called, double* first, std::size_t numbers) : name(called), value(first), count(numbers) {
    all().push_back(*this);
  }
  static std::vector<Registered>& all() {
    static std::vector<Registered> list;
    return list;
  }
};

}  // namespace bench
