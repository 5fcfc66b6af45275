// The constants of src/fgtd/cost.hpp as variables that can be found by name: tools/bench/CMakeLists.txt rewrites that
// header for calibrate so that every constant registers itself here.
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
