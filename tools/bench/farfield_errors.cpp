// Measures what the degrees of farfield's interpolation are worth, and prints src/farfield/interpolation/error_table.inc: for every
// offset k of two clusters (k_1 >= k_2 >= ...; the last row: one of them alone, the other point anywhere at a distance of
// a side or more) and every degree the largest error of potential and field of one charge at one target, both anywhere
// in their clusters, relative to what the promise is relative to.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "farfield/interpolation/measured_error.hpp"

namespace {

template <int d>
void print() {
  using namespace farfield::detail;
  std::printf("template <>\nconstexpr double measured<%d>[][table_degrees<%d>] = {\n", d, d);
  const auto offsets = offset_classes<d>();
  std::vector<std::vector<double>> table(offsets.size() + 1);
  for (int degree = 1; degree <= table_degrees<d>; ++degree) {
    const Interpolation<d> interpolation(degree);
    for (std::size_t c = 0; c < offsets.size(); ++c)
      table[c].push_back(measure_pair_error<d>(interpolation, offsets[c].data(), 250, 1, true));
    table.back().push_back(measure_one_sided_error<d>(interpolation, 250, 1, true));
  }
  for (std::size_t c = 0; c < table.size(); ++c) {
    std::printf("    {");
    for (std::size_t n = 0; n < table[c].size(); ++n) std::printf("%s%.1e", n == 0 ? "" : ", ", table[c][n]);
    std::printf("},\n");
  }
  std::printf("};\n");
}

}  // namespace

int main() {
  std::puts("// Written by tools/bench/farfield_errors.cpp; included by operators.cpp.\n// clang-format off");
  print<2>();
  print<3>();
}
