// Expressions of case files: what they evaluate to, what they refuse and where.
#include "expression/expression.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "expression/foreign_names.hpp"

namespace gaussdrift {
namespace {

const std::vector<std::string> variables{"x", "y", "t"};
constexpr double x = 2, y = 3, t = 0.5;

double value(const std::string& text) { return Expression(text, variables, {{"R", 0.25}}).evaluate({x, y, t}); }

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

TEST(Expression, BindsPowersTighterThanSigns) {
  EXPECT_EQ(value("-x^2"), -4);
  EXPECT_EQ(value("-2^2"), -4);
  EXPECT_EQ(value("2*-x^2"), -8);
  EXPECT_EQ(value("(-x)^2"), 4);
  EXPECT_EQ(value("2^-x"), 0.25);
  EXPECT_EQ(value("2^-x^2"), 1.0 / 16);
}

TEST(Expression, GroupsPowersFromTheRightAndTheRestFromTheLeft) {
  EXPECT_EQ(value("2^3^2"), 512);
  EXPECT_EQ(value("x-y-t"), -1.5);
  EXPECT_EQ(value("x/y/t"), x / y / t);
  EXPECT_EQ(value("2--x"), 4);
  EXPECT_EQ(value("1+2*3^2"), 19);
}

TEST(Expression, ComparesAndChooses) {
  EXPECT_EQ(value("x < y && y < 4"), 1);
  EXPECT_EQ(value("x > y || x == 2"), 1);
  EXPECT_EQ(value("1 < 2 || 1 < 0 && 1 < 0"), 1);  // && before ||
  EXPECT_EQ(value("x <= 2 ? 10 : 20"), 10);
  EXPECT_EQ(value("x != 2 ? 10 : y >= 3 ? 20 : 30"), 20);
  EXPECT_EQ(value("x > 1 ? y > 5 ? 1 : 2 : 3"), 2);
  EXPECT_EQ(value("(x < 1 ? 10 : 20) * 2 + 1"), 41);
}

TEST(Expression, ReadsNumbersInEveryUsualForm) {
  EXPECT_EQ(value("1e3"), 1000);
  EXPECT_EQ(value("1.5E-3"), 1.5e-3);
  EXPECT_EQ(value(".5"), 0.5);
  EXPECT_EQ(value("5."), 5);
  EXPECT_EQ(value("0.1"), 0.1);
  EXPECT_EQ(value("6.283185307179586"), 6.283185307179586);
  EXPECT_EQ(value("1.7976931348623157e308"), std::numeric_limits<double>::max());
}

TEST(Expression, KnowsPiEAndTheGivenConstants) {
  EXPECT_EQ(value("pi"), std::numbers::pi);
  EXPECT_EQ(value("e"), std::numbers::e);
  EXPECT_EQ(value("4*R"), 1);
  EXPECT_EQ(Expression("e + 1", {"e"}, {}).evaluate({1.0}), 2) << "a variable comes before the constant of its name";
}

TEST(Expression, OffersTheFunctionsItLists) {
  const double a = 0.6, b = 0.35;
  const std::map<std::string, double> expected = {{"sin", std::sin(a)},
                                                  {"cos", std::cos(a)},
                                                  {"tan", std::tan(a)},
                                                  {"asin", std::asin(a)},
                                                  {"acos", std::acos(a)},
                                                  {"atan", std::atan(a)},
                                                  {"atan2", std::atan2(a, b)},
                                                  {"sinh", std::sinh(a)},
                                                  {"cosh", std::cosh(a)},
                                                  {"tanh", std::tanh(a)},
                                                  {"asinh", std::asinh(a)},
                                                  {"acosh", std::acosh(a)},
                                                  {"atanh", std::atanh(a)},
                                                  {"exp", std::exp(a)},
                                                  {"log", std::log(a)},
                                                  {"ln", std::log(a)},
                                                  {"log2", std::log2(a)},
                                                  {"log10", std::log10(a)},
                                                  {"sqrt", std::sqrt(a)},
                                                  {"cbrt", std::cbrt(a)},
                                                  {"pow", std::pow(a, b)},
                                                  {"hypot", std::hypot(a, b)},
                                                  {"abs", a},
                                                  {"sign", 1.0},
                                                  {"min", b},
                                                  {"max", a},
                                                  {"floor", 0.0},
                                                  {"ceil", 1.0},
                                                  {"round", 1.0},
                                                  {"mod", a - b},
                                                  {"erf", std::erf(a)}};
  for (const auto& function : expression_functions()) {
    const std::string name(function.name);
    ASSERT_TRUE(expected.count(name)) << name << " has no expected value in this test";
    const std::string call = name + (function.arguments == 1 ? "(a)" : "(a, b)");
    const double found = Expression(call, {"a", "b"}, {}).evaluate({a, b});
    if (std::isnan(expected.at(name)))
      EXPECT_TRUE(std::isnan(found)) << call;
    else
      EXPECT_DOUBLE_EQ(found, expected.at(name))
          << call;  // the compiler rounds constants correctly, the library nearly
    EXPECT_TRUE(is_reserved_name(name));
  }
  EXPECT_EQ(expected.size(), expression_functions().size());
}

TEST(Expression, TakesAnyNumberOfArgumentsForMinAndMax) {
  EXPECT_EQ(value("min(3, 1, 2)"), 1);
  EXPECT_EQ(value("max(x, y, t, 1)"), 3);
  EXPECT_EQ(value("mod(-1, 3)"), 2);
  EXPECT_EQ(value("sign(-x) + cbrt(-8)"), -3);
}

TEST(Expression, FollowsIeeeArithmetic) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  const auto at = [](const std::string& text, double a) { return Expression(text, {"a"}, {}).evaluate({a}); };
  EXPECT_EQ(value("1/0"), infinity);
  EXPECT_TRUE(std::isnan(value("0/0")));
  EXPECT_EQ(at("1/a", -0.0), -infinity);
  EXPECT_TRUE(same_bits(at("a*1", -0.0), -0.0));
  EXPECT_TRUE(same_bits(at("-a", 0.0), -0.0));
  EXPECT_TRUE(same_bits(at("sign(a)", -0.0), -0.0));
  for (const char* text :
       {"a - a", "0*a", "min(a, 1)", "min(1, a)", "max(a, 1)", "max(1, a)", "sign(a)", "a^2", "abs(a)"})
    EXPECT_TRUE(std::isnan(at(text, nan))) << text;
  EXPECT_EQ(at("a == a", nan), 0);
  EXPECT_EQ(at("a > 0 ? a : 0", nan), 0);
}

TEST(Expression, GivesTheSameBitsHoweverTheArrayIsCut) {
  constexpr std::size_t count = 1000;
  std::vector<double> xs(count), ys(count), ts(count, t);
  for (std::size_t i = 0; i < count; ++i) xs[i] = std::sin(0.37 * double(i)), ys[i] = std::cos(1.3 * double(i));
  const double* const arguments[] = {xs.data(), ys.data(), ts.data()};
  for (const char* text : {"-y", "sin(x)*cos(y)*exp(-t)", "x^2+y^2<R^2 ? 1-(x^2+y^2)/R^2 : 0", "min(x,y,t)+2*t", "3",
                           "t", "x^y", "1+(2+(3+(4+(5+(6+(7+(8+(9+(10+x)))))))))"}) {
    const Expression expression(text, variables, {{"R", 0.25}});
    std::vector<double> single(count);
    for (std::size_t i = 0; i < count; ++i) single[i] = expression.evaluate({xs[i], ys[i], ts[i]});
    for (const std::size_t length : {std::size_t{1}, std::size_t{255}, std::size_t{256}, std::size_t{257}, count}) {
      std::vector<double> found(count);
      for (std::size_t i = 0; i < count; i += length) {
        const double* const part[] = {arguments[0] + i, arguments[1] + i, arguments[2] + i};
        expression.evaluate(part, std::min(length, count - i), found.data() + i);
      }
      for (std::size_t i = 0; i < count; ++i)
        ASSERT_TRUE(same_bits(found[i], single[i])) << text << " " << length << " " << i;
    }
  }
}

TEST(Expression, WritesOverOneOfItsArgumentsAndIgnoresUnusedOnes) {
  std::vector<double> xs(600);
  for (std::size_t i = 0; i < xs.size(); ++i) xs[i] = double(i);
  const double* const arguments[] = {xs.data(), nullptr, nullptr};
  Expression("2*x + 1", variables, {}).evaluate(arguments, xs.size(), xs.data());
  for (std::size_t i = 0; i < xs.size(); ++i) ASSERT_EQ(xs[i], 2 * double(i) + 1);
  Expression("x", variables, {}).evaluate(nullptr, 0, nullptr);
}

TEST(Expression, EvaluatesInSeveralThreadsAtOnce) {
  const Expression expression("sin(x)*y^2 - (x < 0 ? t : exp(x))", variables, {});
  constexpr std::size_t count = 5000;
  std::vector<double> xs(count), ys(count), ts(count, t), expected(count);
  for (std::size_t i = 0; i < count; ++i) xs[i] = std::sin(double(i)), ys[i] = std::cos(double(i));
  const double* const arguments[] = {xs.data(), ys.data(), ts.data()};
  expression.evaluate(arguments, count, expected.data());
  std::vector<std::vector<double>> found(4, std::vector<double>(count));
  std::vector<std::thread> threads;
  for (auto& values : found)
    threads.emplace_back([&] {
      for (int k = 0; k < 20; ++k) expression.evaluate(arguments, count, values.data());
      Expression("cos(x)", variables, {}).evaluate({x, y, t});  // compiling meanwhile
    });
  for (auto& thread : threads) thread.join();
  for (const auto& values : found) EXPECT_EQ(values, expected);
}

TEST(Expression, SaysWhichNamesItUses) {
  const Expression expression("R*y + R*x + pi + sin(y)", variables, {{"R", 0.25}, {"Q", 1}});
  EXPECT_EQ(expression.used_names(), (std::vector<std::string>{"R", "y", "x", "pi"}));
  Expression copy = expression;
  copy = Expression("t", variables, {});
  EXPECT_EQ(copy.text(), "t");
  EXPECT_EQ(expression.text(), "R*y + R*x + pi + sin(y)");
  EXPECT_THROW(copy.evaluate({1.0}), std::invalid_argument);
}

TEST(Expression, ReservesFunctionsAndConstants) {
  for (const char* name : {"sin", "log", "max", "pi", "e"}) EXPECT_TRUE(is_reserved_name(name)) << name;
  for (const char* name : {"R", "x", "Sin", "E", "_pi", "rint"}) EXPECT_FALSE(is_reserved_name(name)) << name;
  for (const char* name : {"R", "_a", "radius_2"}) EXPECT_TRUE(is_name(name)) << name;
  for (const char* name : {"", "2a", "a-b", "a b", "é"}) EXPECT_FALSE(is_name(name)) << name;
}

struct Refusal {
  std::string text;
  std::size_t position, length;
  std::string message;
};

TEST(Expression, RefusesWithPlaceAndRemedy) {
  const Refusal refusals[] = {
      {"", 0, 1, "the expression is empty"},
      {"   ", 0, 1, "the expression is empty"},
      {"x*", 1, 1, "a value is missing after \"*\""},
      {"x * / y", 4, 1, "a value is missing between \"*\" and \"/\""},
      {"*x", 0, 1, "an expression cannot begin with \"*\""},
      {"siin(x)", 0, 4, "unknown function \"siin\"; did you mean \"sin\"?"},
      {"2*sqr(x)", 2, 3, "there is no function \"sqr\"; write a^2"},
      {"sgn(x)", 0, 3, "there is no function \"sgn\"; write sign(a)"},
      {"2*if(x<1, 1, 2)", 2, 2, "there is no function \"if\"; a choice is written condition ? a : b"},
      {"heaviside(x)", 0, 9, "there is no function \"heaviside\"; write a < 0 ? 0 : 1"},
      {"arctan(x)", 0, 6, "there is no function \"arctan\"; write atan(a)"},
      {"rand()", 0, 4,
       "there is no function \"rand\"; results must be the same every time, so there are no random numbers"},
      {"np.sin(x)", 2, 1, "there is no operator \".\"; functions have no prefix; write sin(a), not np.sin(a)"},
      {"x < 1 and y < 1", 6, 3, "there is no operator \"and\"; write && for \"and\""},
      {"not x", 0, 3, "there is no name \"not\"; write a == 0 instead of not a"},
      {"sin(time)", 4, 4, "there is no name \"time\"; the time is t"},
      {"x\xC2\xB2", 1, 2, "there is no operator \"\xC2\xB2\"; write ^2"},
      {"x \xE2\x88\x92 1", 2, 3, "there is no operator \"\xE2\x88\x92\"; write -, the sign of the keyboard"},
      {"cos(pii)", 4, 3, "unknown name \"pii\"; did you mean \"pi\"?"},
      {"R + z", 4, 1, "unknown name \"z\"; known here: x, y, t, R, pi, e"},
      {"_pi", 0, 3, "unknown name \"_pi\"; did you mean \"pi\"?"},
      {"rint(x)", 0, 4, "there is no function \"rint\"; write round(a)"},
      {"bessel(x)", 0, 6,
       "unknown function \"bessel\"; known here: sin, cos, tan, asin, acos, atan, atan2, sinh, cosh, tanh, asinh, "
       "acosh, "
       "atanh, exp, log, ln, log2, log10, sqrt, cbrt, pow, hypot, abs, sign, min, max, floor, ceil, round, mod, erf"},
      {"(x+1", 0, 1, "\"(\" is never closed"},
      {"sin(x*(y+1)", 3, 1, "\"(\" is never closed"},
      {"x+1)", 3, 1, "\")\" closes nothing: there is no \"(\" before it"},
      {"()", 0, 1, "nothing between the parentheses"},
      {"2x", 1, 1, "an operator is missing between \"2\" and \"x\"; write 2 * x to multiply"},
      {"x y", 2, 1, "an operator is missing between \"x\" and \"y\"; write x * y to multiply"},
      {"(x)(y)", 3, 1, "an operator is missing between \")\" and \"(...)\"; write ) * (...) to multiply"},
      {"x(2)", 0, 1, "\"x\" is not a function; write x * (...) to multiply"},
      {"sin x", 0, 3, "the function sin wants its arguments in parentheses: sin(...)"},
      {"sin()", 0, 3, "sin needs 1 argument, found none"},
      {"1 + atan2(x)", 4, 5, "atan2 needs 2 arguments, found 1"},
      {"sin(x, y)", 0, 3, "sin needs 1 argument, found 2"},
      {"min(x)", 0, 3, "min needs at least 2 arguments, found 1"},
      {"x = 3", 2, 1, "there is no operator \"=\"; an expression assigns nothing; write == to compare"},
      {"1,2", 1, 1, "a comma only separates the arguments of a function; decimals have a point"},
      {"0 < x < 1", 6, 1, "comparisons cannot be chained; write a < b && b < c"},
      {"x ? 1", 2, 1, "\"?\" without its \":\"; a choice is condition ? a : b"},
      {"x : 1", 2, 1, "\":\" without a \"?\" before it; a choice is condition ? a : b"},
      {"--x", 1, 1, "two signs in a row; write -(-...)"},
      {"x**2", 1, 2, "there is no operator \"**\"; powers are written a ^ b"},
      {"!x", 0, 1, "there is no operator \"!\"; write a == 0 instead of !a"},
      {"x & y", 2, 1, "there is no operator \"&\"; write && for \"and\""},
      {"x % 2", 2, 1, "there is no operator \"%\"; write mod(a, b) for the remainder"},
      {"\"a\"", 0, 1, "an expression contains no strings"},
      {"x + \xC3\xA9", 4, 2, "\"\xC3\xA9\" does not belong in an expression"},
      {"1.2.3", 3, 1, "a number has one decimal point"},
      {"1e999", 0, 5, "the number 1e999 does not fit a double (about 1e-308 to 1e308)"},
      {"0x10", 1, 3, "an operator is missing between \"0\" and \"x10\"; write 0 * x10 to multiply"},
      {"2e", 1, 1, "an operator is missing between \"2\" and \"e\"; write 2 * e to multiply"},
      {std::string("x\0y", 3), 1, 1, "\"\\x00\" does not belong in an expression"},
      {std::string(4001, 'x'), 0, 1, "the expression has 4001 characters; at most 4000 are read"},
  };
  for (const auto& refusal : refusals) {
    try {
      const double found = value(refusal.text);
      ADD_FAILURE() << refusal.text << " was taken and gives " << found;
    } catch (const ExpressionError& error) {
      EXPECT_STREQ(error.what(), refusal.message.c_str());
      EXPECT_EQ(error.position(), refusal.position) << refusal.text;
      EXPECT_EQ(error.length(), refusal.length) << refusal.text;
    }
  }
}

// What is offered in place of a foreign word is a formula that is taken.
TEST(Expression, OffersFormulasThatItTakes) {
  const std::vector<std::string> names{"a", "b", "low", "high", "condition"};
  int offered = 0;
  for (const char* word :
       {"sgn",     "signum",  "if",      "iif",    "ifelse",    "where",  "select",  "piecewise", "heaviside",
        "step",    "fabs",    "sqr",     "square", "power",     "arcsin", "arccos",  "arctan",    "arctan2",
        "arcsinh", "arccosh", "arctanh", "sec",    "csc",       "cot",    "lg",      "exp2",      "expm1",
        "log1p",   "erfc",    "fmod",    "rem",    "remainder", "fmin",   "minimum", "fmax",      "maximum",
        "clamp",   "clip",    "int",     "trunc",  "rint",      "norm",   "radians", "deg2rad",   "degrees",
        "rad2deg", "avg",     "sum",     "not"}) {
    std::string text(expression::instead_of_function(word));
    ASSERT_FALSE(text.empty()) << word;
    EXPECT_FALSE(is_reserved_name(word)) << word << " is a function here";
    const std::size_t write = text.find("write "), written = text.find("written ");
    text = write == 0 ? text.substr(6) : text.substr(written + 8);
    for (std::size_t end = 0; !text.empty(); text = end == std::string::npos ? "" : text.substr(end + 4)) {
      end = text.find(" or ");
      EXPECT_NO_THROW(Expression(text.substr(0, end), names, {})) << word << ": " << text;
      ++offered;
    }
  }
  EXPECT_GT(offered, 50);
}

// A parameter may have the name of a word that is refused where it is not known.
TEST(Expression, TakesForeignWordsThatAreDefined) {
  EXPECT_EQ(Expression("time + step", {"x"}, {{"time", 1}, {"step", 2}}).evaluate({0.0}), 3);
}

TEST(Expression, TakesDeepNesting) {
  EXPECT_EQ(value(std::string(1500, '(') + "x" + std::string(1500, ')')), 2);
  std::string sum = "x";
  for (int k = 0; k < 300; ++k) sum = "1+(" + sum + ")";
  EXPECT_EQ(value(sum), 302);
}

/// A random formula as text without needless parentheses, and its value by the rules of docs/cases.md.
struct Formula {
  std::string text;
  double value;
  int level;  // 0 ?:, 1 ||, 2 &&, 3 comparison, 4 sum, 5 product, 6 sign, 7 power, 8 operand
};

class Formulas {
 public:
  explicit Formulas(unsigned seed) : random_(seed) {}

  Formula make(int depth) {
    if (depth == 0) return leaf();
    switch (pick(9)) {
      case 0: {
        const Formula a = make(depth - 1), b = make(depth - 1), c = make(depth - 1);
        return {wrap(a, 1) + "?" + wrap(b, 0) + ":" + wrap(c, 0), a.value != 0 ? b.value : c.value, 0};
      }
      case 1:
        return binary(depth, "||", 1, 1, 2, [](double a, double b) { return double(a != 0 || b != 0); });
      case 2:
        return binary(depth, "&&", 2, 2, 3, [](double a, double b) { return double(a != 0 && b != 0); });
      case 3:
        return binary(depth, "<", 3, 4, 4, [](double a, double b) { return double(a < b); });
      case 4:
        return binary(depth, "+", 4, 4, 5, [](double a, double b) { return a + b; });
      case 5:
        return binary(depth, "-", 4, 4, 5, [](double a, double b) { return a - b; });
      case 6:
        return binary(depth, "*", 5, 5, 6, [](double a, double b) { return a * b; });
      case 7: {
        const Formula a = make(depth - 1);
        return {"-" + wrap(a, 7), -a.value, 6};
      }
      default: {  // powers of abs(a), so that real powers exist
        const Formula a = make(depth - 1), b = make(depth - 1);
        const std::string exponent = b.level == 6 || b.level >= 7 ? b.text : "(" + b.text + ")";
        return {"abs(" + a.text + ")^" + exponent, power(std::abs(a.value), b.value), 7};
      }
    }
  }

 private:
  int pick(int n) { return int(random_() % unsigned(n)); }
  static double power(double a, double b) {
    return b == 2 ? a * a : b == 3 ? a * a * a : b == 4 ? (a * a) * (a * a) : std::pow(a, b);
  }
  Formula leaf() {
    const Formula leaves[] = {{"x", x, 8}, {"y", y, 8},     {"t", t, 8}, {"R", 0.25, 8},
                              {"2", 2, 8}, {"0.5", 0.5, 8}, {"0", 0, 8}};
    return leaves[pick(7)];
  }
  static std::string wrap(const Formula& a, int level) { return a.level >= level ? a.text : "(" + a.text + ")"; }
  template <class F>
  Formula binary(int depth, const char* symbol, int level, int left, int right, F f) {
    const Formula a = make(depth - 1), b = make(depth - 1);
    return {wrap(a, left) + symbol + wrap(b, right), f(a.value, b.value), level};
  }
  std::mt19937 random_;
};

TEST(Expression, AgreesWithTheRulesOfPrecedenceOnRandomFormulas) {
  Formulas formulas(2006);
  for (int k = 0; k < 3000; ++k) {
    const Formula formula = formulas.make(1 + k % 5);
    if (formula.text.size() > 4000) continue;
    const double found = value(formula.text);
    if (std::isnan(formula.value))
      EXPECT_TRUE(std::isnan(found)) << formula.text;
    else if (std::isinf(formula.value))
      EXPECT_EQ(found, formula.value) << formula.text;
    else  // pow(a, 2) from a computed exponent may differ from a*a in the last bits, and grow under further powers
      EXPECT_NEAR(found, formula.value, 1e-13 * std::abs(formula.value)) << formula.text;
  }
}

}  // namespace
}  // namespace gaussdrift
