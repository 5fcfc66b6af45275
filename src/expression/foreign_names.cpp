#include "expression/foreign_names.hpp"

#include <algorithm>
#include <iterator>

namespace gaussdrift::expression {
namespace {

struct Word {
  std::string_view word, instead;
};

constexpr std::string_view choice = "a choice is written condition ? a : b";
constexpr std::string_view no_random = "results must be the same every time, so there are no random numbers";

constexpr Word foreign_functions[] = {
    {"sgn", "write sign(a)"},
    {"signum", "write sign(a)"},
    {"if", choice},
    {"iif", choice},
    {"ifelse", choice},
    {"where", choice},
    {"select", choice},
    {"piecewise", choice},
    {"heaviside", "write a < 0 ? 0 : 1"},
    {"step", "write a < 0 ? 0 : 1"},
    {"fabs", "write abs(a)"},
    {"sqr", "write a^2"},
    {"square", "write a^2"},
    {"power", "write a^b or pow(a, b)"},
    {"arcsin", "write asin(a)"},
    {"arccos", "write acos(a)"},
    {"arctan", "write atan(a)"},
    {"arctan2", "write atan2(a, b)"},
    {"arcsinh", "write asinh(a)"},
    {"arccosh", "write acosh(a)"},
    {"arctanh", "write atanh(a)"},
    {"sec", "write 1 / cos(a)"},
    {"csc", "write 1 / sin(a)"},
    {"cot", "write 1 / tan(a)"},
    {"lg", "write log10(a)"},
    {"exp2", "write 2^a"},
    {"expm1", "write exp(a) - 1"},
    {"log1p", "write log(1 + a)"},
    {"erfc", "write 1 - erf(a)"},
    {"fmod", "write mod(a, b)"},
    {"rem", "write mod(a, b)"},
    {"remainder", "write mod(a, b)"},
    {"fmin", "write min(a, b)"},
    {"minimum", "write min(a, b)"},
    {"fmax", "write max(a, b)"},
    {"maximum", "write max(a, b)"},
    {"clamp", "write min(max(a, low), high)"},
    {"clip", "write min(max(a, low), high)"},
    {"int", "write floor(a) or ceil(a) or round(a)"},
    {"trunc", "write floor(a) or ceil(a) or round(a)"},
    {"rint", "write round(a)"},
    {"norm", "write hypot(a, b)"},
    {"radians", "write a * pi / 180"},
    {"deg2rad", "write a * pi / 180"},
    {"degrees", "write a * 180 / pi"},
    {"rad2deg", "write a * 180 / pi"},
    {"avg", "write (a + b) / 2"},
    {"sum", "write a + b"},
    {"not", "write a == 0"},
    {"rand", no_random},
    {"random", no_random},
    {"rnd", no_random},
    {"noise", no_random},
};

constexpr Word names[] = {
    {"true", "write 1"},
    {"false", "write 0"},
    {"and", "write && for \"and\""},
    {"or", "write || for \"or\""},
    {"xor", "write a != b for \"either\""},
    {"not", "write a == 0 instead of not a"},
    {"mod", "write mod(a, b) for the remainder"},
    {"div", "write floor(a / b)"},
    {"if", choice},
    {"then", choice},
    {"else", choice},
    {"time", "the time is t"},
    {"inf", "numbers are finite"},
    {"infinity", "numbers are finite"},
    {"nan", "numbers are finite"},
};

constexpr Word symbols[] = {
    {"**", "powers are written a ^ b"},
    {"=", "an expression assigns nothing; write == to compare"},
    {"!", "write a == 0 instead of !a"},
    {"&", "write && for \"and\""},
    {"|", "write || for \"or\""},
    {"%", "write mod(a, b) for the remainder"},
    {".", "functions have no prefix; write sin(a), not np.sin(a)"},
    {"²", "write ^2"},
    {"³", "write ^3"},
    {"·", "write *"},
    {"×", "write *"},
    {"÷", "write /"},
    {"−", "write -, the sign of the keyboard"},
    {"–", "write -, the sign of the keyboard"},
    {"≤", "write <="},
    {"≥", "write >="},
    {"≠", "write !="},
    {"√", "write sqrt(a)"},
    {"π", "write pi"},
};

template <class Words>
std::string_view found(const Words& words, std::string_view word) {
  const auto entry =
      std::find_if(std::begin(words), std::end(words), [&](const Word& known) { return known.word == word; });
  return entry == std::end(words) ? std::string_view() : entry->instead;
}

}  // namespace

std::string_view instead_of_function(std::string_view name) { return found(foreign_functions, name); }
std::string_view instead_of_name(std::string_view name) { return found(names, name); }
std::string_view instead_of_symbol(std::string_view symbol) { return found(symbols, symbol); }

}  // namespace gaussdrift::expression
