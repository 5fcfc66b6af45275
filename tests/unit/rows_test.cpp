// Functions of rows: right to a unit in the last place, and the same bits for every instruction set and every length.
#include "rows/rows.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace gaussdrift::rows {
namespace {

using Wide = long double;

// Rounding of one product is half a unit; that of a square squared is at most two.
double most_units(const std::string& name) { return name == "cube" || name == "fourth" ? 2 : 1.1; }

struct UnaryCase {
  const char* name;
  Unary Kernels::*kernel;
  Wide (*exact)(Wide);
  double least, most;
};

const std::vector<UnaryCase>& unary_cases() {
  static const std::vector<UnaryCase> all{
      {"negate", &Kernels::negate, [](Wide x) { return -x; }, -9, 9},
      {"square", &Kernels::square, [](Wide x) { return x * x; }, -9, 9},
      {"cube", &Kernels::cube, [](Wide x) { return x * x * x; }, -9, 9},
      {"fourth", &Kernels::fourth, [](Wide x) { return x * x * x * x; }, -9, 9},
      {"abs", &Kernels::abs, std::fabs, -9, 9},
      {"sqrt", &Kernels::sqrt, std::sqrt, 0, 9},
      {"sin", &Kernels::sin, std::sin, -1e4, 1e4},
      {"cos", &Kernels::cos, std::cos, -1e4, 1e4},
      {"tan", &Kernels::tan, std::tan, -1e4, 1e4},
      {"asin", &Kernels::asin, std::asin, -1, 1},
      {"acos", &Kernels::acos, std::acos, -1, 1},
      {"atan", &Kernels::atan, std::atan, -50, 50},
      {"tanh", &Kernels::tanh, std::tanh, -20, 20},
      {"atanh", &Kernels::atanh, std::atanh, -1, 1},
      {"exp", &Kernels::exp, std::exp, -700, 700},
      {"log", &Kernels::log, std::log, 0, 1e3},
      {"log2", &Kernels::log2, std::log2, 0, 1e3},
      {"log10", &Kernels::log10, std::log10, 0, 1e3},
      {"cbrt", &Kernels::cbrt, std::cbrt, -50, 50},
      {"erf", &Kernels::erf, std::erf, -5, 5},
  };
  return all;
}

struct BinaryCase {
  const char* name;
  Binary Kernels::*kernel;
  Wide (*exact)(Wide, Wide);
  double least, most;
};

const std::vector<BinaryCase>& binary_cases() {
  static const std::vector<BinaryCase> all{
      {"add", &Kernels::add, [](Wide x, Wide y) { return x + y; }, -9, 9},
      {"subtract", &Kernels::subtract, [](Wide x, Wide y) { return x - y; }, -9, 9},
      {"multiply", &Kernels::multiply, [](Wide x, Wide y) { return x * y; }, -9, 9},
      {"divide", &Kernels::divide, [](Wide x, Wide y) { return x / y; }, -9, 9},
      {"pow", &Kernels::pow, std::pow, 0, 9},
      {"atan2", &Kernels::atan2, std::atan2, -9, 9},
      {"hypot", &Kernels::hypot, std::hypot, -9, 9},
      {"less", &Kernels::less, [](Wide x, Wide y) { return Wide(x < y); }, -9, 9},
      {"greater", &Kernels::greater, [](Wide x, Wide y) { return Wide(x > y); }, -9, 9},
      {"less_equal", &Kernels::less_equal, [](Wide x, Wide y) { return Wide(x <= y); }, -9, 9},
      {"greater_equal", &Kernels::greater_equal, [](Wide x, Wide y) { return Wide(x >= y); }, -9, 9},
      {"equal", &Kernels::equal, [](Wide x, Wide y) { return Wide(x == y); }, -9, 9},
      {"not_equal", &Kernels::not_equal, [](Wide x, Wide y) { return Wide(x != y); }, -9, 9},
      {"both", &Kernels::both, [](Wide x, Wide y) { return Wide(x != 0 && y != 0); }, -9, 9},
      {"either", &Kernels::either, [](Wide x, Wide y) { return Wide(x != 0 || y != 0); }, -9, 9},
  };
  return all;
}

/// Numbers from a range, and those where functions like to be wrong.
std::vector<double> arguments(double least, double most, unsigned seed) {
  constexpr double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> x{0.0,    -0.0,    1,      -1,    0.5,  -2,    infinity, -infinity, nan,
                        1e-300, -1e-310, 1e-310, 1e300, 1e22, 709.7, -744.9,   1.5e154};
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(least, most);
  while (x.size() < 403) x.push_back(uniform(random));  // no multiple of a vector
  return x;
}

/// |found - exact| in units of the last place of exact; infinite if one of them is not a number and the other is.
double units(double found, Wide exact) {
  if (std::isnan(exact) || std::isnan(found))
    return std::isnan(exact) && std::isnan(found) ? 0 : std::numeric_limits<double>::infinity();
  const auto rounded = static_cast<double>(exact);
  if (std::isinf(rounded) || std::isinf(found)) return rounded == found ? 0 : std::numeric_limits<double>::infinity();
  const double unit =
      std::max(std::nextafter(std::fabs(rounded), std::numeric_limits<double>::infinity()) - std::fabs(rounded),
               std::numeric_limits<double>::min() * 0x1p-52);
  return static_cast<double>(std::fabs(found - exact) / unit);
}

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) || (std::isnan(a) && std::isnan(b));
}

TEST(Rows, AreRightToAUnitInTheLastPlaceOnEveryMachine) {
  for (const Kernels* kernels : all_kernels()) {
    for (const UnaryCase& f : unary_cases()) {
      const std::vector<double> x = arguments(f.least, f.most, 1);
      std::vector<double> y = x;
      (kernels->*f.kernel)(y.data(), y.size());
      for (std::size_t i = 0; i < x.size(); ++i)
        EXPECT_LE(units(y[i], f.exact(x[i])), most_units(f.name)) << f.name << ' ' << x[i];
    }
    for (const BinaryCase& f : binary_cases()) {
      const std::vector<double> x = arguments(f.least, f.most, 2), b = arguments(f.least, f.most, 3);
      std::vector<double> y = x;
      (kernels->*f.kernel)(y.data(), b.data(), false, y.size());
      for (std::size_t i = 0; i < x.size(); ++i)
        EXPECT_LE(units(y[i], f.exact(x[i], b[i])), 1.1) << f.name << ' ' << x[i] << ' ' << b[i];
    }
  }
}

TEST(Rows, AreTheSameBitsForEveryInstructionSetAndLength) {
  const Kernels& slowest = *all_kernels().front();
  for (const Kernels* kernels : all_kernels()) {
    for (const UnaryCase& f : unary_cases()) {
      std::vector<double> whole = arguments(f.least, f.most, 4), pieces = whole;
      (slowest.*f.kernel)(whole.data(), whole.size());
      for (std::size_t first = 0, length = 1; first < pieces.size(); first += length, ++length)
        (kernels->*f.kernel)(pieces.data() + first, std::min(length, pieces.size() - first));
      for (std::size_t i = 0; i < whole.size(); ++i) ASSERT_TRUE(same_bits(pieces[i], whole[i])) << f.name << ' ' << i;
    }
    for (const BinaryCase& f : binary_cases()) {
      std::vector<double> whole = arguments(f.least, f.most, 5), pieces = whole;
      const std::vector<double> b = arguments(f.least, f.most, 6);
      (slowest.*f.kernel)(whole.data(), b.data(), false, whole.size());
      for (std::size_t first = 0, length = 1; first < pieces.size(); first += length, ++length)
        (kernels->*f.kernel)(pieces.data() + first, b.data() + first, false, std::min(length, pieces.size() - first));
      for (std::size_t i = 0; i < whole.size(); ++i) ASSERT_TRUE(same_bits(pieces[i], whole[i])) << f.name << ' ' << i;
    }
  }
}

TEST(Rows, TakeOneNumberForAWholeRow) {
  for (const Kernels* kernels : all_kernels())
    for (const BinaryCase& f : binary_cases())
      for (const double b : {1.75, -0.0}) {
        std::vector<double> spread = arguments(f.least, f.most, 7), once = spread;
        const std::vector<double> row(spread.size(), b);
        (kernels->*f.kernel)(spread.data(), row.data(), false, spread.size());
        (kernels->*f.kernel)(once.data(), &b, true, once.size());
        for (std::size_t i = 0; i < once.size(); ++i) ASSERT_TRUE(same_bits(once[i], spread[i])) << f.name << ' ' << i;
      }
}

TEST(Rows, CombineTermsInTheirOrder) {
  const std::vector<double> base = arguments(-9, 9, 8), a = arguments(-9, 9, 9), b = arguments(-9, 9, 10);
  const double* const terms[] = {a.data(), b.data()};
  const double factors[] = {0.1, -3e5};
  for (const Kernels* kernels : all_kernels()) {
    std::vector<double> out = base;
    kernels->combine(out.data(), out.data(), terms, factors, 2, out.size());
    for (std::size_t i = 0; i < out.size(); ++i)
      ASSERT_TRUE(same_bits(out[i], (base[i] + factors[0] * a[i]) + factors[1] * b[i])) << i;
  }
}

}  // namespace
}  // namespace gaussdrift::rows
