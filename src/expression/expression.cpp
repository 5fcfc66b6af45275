// muParser turns the text into postfix bytecode. Here the bytecode is run over rows of numbers, one operation for a
// whole row at a time. This is const and several times as fast as muParser itself, which takes one number at a time,
// changes the number of OpenMP threads of the program and writes to the parser.
#include "expression/expression.hpp"

#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <mutex>
#include <numbers>

#include "expression/functions.hpp"
#include "expression/program.hpp"
#include "expression/syntax.hpp"

namespace gaussdrift {
namespace {

using expression::Function;
using expression::Operation;
using expression::Program;
using expression::row_length;
using expression::Stack;
using expression::Step;

bool is_constant(const Step& step) { return step.operation == Operation::constant; }

/// Appends a step, computing at once what only depends on constants, and powers 2, 3, 4 by multiplication.
void append(Program& program, Step step) {
  if (step.operation == Operation::power && is_constant(program.back())) {
    const double exponent = program.back().value;
    if (exponent == 2 || exponent == 3 || exponent == 4) {
      program.pop_back();
      step.operation = exponent == 2 ? Operation::square : exponent == 3 ? Operation::cube : Operation::fourth;
      step.operands = 1;
    }
  }
  program.push_back(step);
  const std::size_t length = static_cast<std::size_t>(step.operands) + 1;
  if (length == 1 || length > program.size() ||
      !std::all_of(program.end() - static_cast<std::ptrdiff_t>(length), program.end() - 1, is_constant))
    return;
  std::vector<double> rows(length * row_length);
  Stack stack{rows.data(), std::vector<char>(length)};
  run(program.data() + (program.size() - length), length, nullptr, 0, 1, stack);
  program.resize(program.size() - length);
  program.push_back({Operation::constant, 0, rows[0]});
}

double never_called(void*, const double*, int) { return 0; }
double minus(double a) { return -a; }
double plus(double a) { return a; }

/// muParser without its own functions, constants and signs, which cannot be told apart in the bytecode.
void define_functions(mu::Parser& parser) {
  parser.EnableOptimizer(false);  // it rewrites x*1 and x+x, which costs the sign of zero; append() folds constants
  parser.ClearFun();
  parser.ClearConst();
  parser.ClearPostfixOprt();
  parser.ClearInfixOprt();
  for (const auto& function : expression::functions())
    parser.DefineFunUserData(std::string(function.info.name), never_called, const_cast<Function*>(&function));
  parser.DefineInfixOprt("-", minus);
  parser.DefineInfixOprt("+", plus);
}

/// muParser's bytecode for the text, as steps. `slots` holds the place of each variable.
Program translate(const mu::ParserByteCode& code, const std::vector<double>& slots) {
  Program program;
  const mu::SToken* token = code.GetBase();
  for (std::size_t k = 0; k < code.GetSize() && token[k].Cmd != mu::cmEND; ++k) {
    const auto binary = [&](Operation operation) { append(program, {operation, 2}); };
    switch (token[k].Cmd) {
      case mu::cmVAL:
        append(program, {Operation::constant, 0, token[k].Val.data2});
        break;
      case mu::cmVAR:
        append(program, {Operation::variable, 0, 0, static_cast<std::size_t>(token[k].Val.ptr - slots.data())});
        break;
      case mu::cmFUNC:
        if (token[k].Fun.cb._pUserData)
          append(program, {Operation::call, std::abs(token[k].Fun.argc), 0, 0,
                           static_cast<const Function*>(token[k].Fun.cb._pUserData)});
        else if (token[k].Fun.cb._pRawFun == reinterpret_cast<mu::erased_fun_type>(&minus))
          append(program, {Operation::negate, 1});
        break;
      case mu::cmADD:
        binary(Operation::add);
        break;
      case mu::cmSUB:
        binary(Operation::subtract);
        break;
      case mu::cmMUL:
        binary(Operation::multiply);
        break;
      case mu::cmDIV:
        binary(Operation::divide);
        break;
      case mu::cmPOW:
        binary(Operation::power);
        break;
      case mu::cmLT:
        binary(Operation::less);
        break;
      case mu::cmGT:
        binary(Operation::greater);
        break;
      case mu::cmLE:
        binary(Operation::less_equal);
        break;
      case mu::cmGE:
        binary(Operation::greater_equal);
        break;
      case mu::cmEQ:
        binary(Operation::equal);
        break;
      case mu::cmNEQ:
        binary(Operation::not_equal);
        break;
      case mu::cmLAND:
        binary(Operation::both);
        break;
      case mu::cmLOR:
        binary(Operation::either);
        break;
      case mu::cmIF:
      case mu::cmELSE:
        break;  // both branches are computed, then chosen from
      case mu::cmENDIF:
        append(program, {Operation::choose, 3});
        break;
      default:
        throw ExpressionError(fmt::format("muParser's instruction {} is not known", static_cast<int>(token[k].Cmd)), 0,
                              1);
    }
  }
  return program;
}

/// Most rows that are on the stack at once. Throws if the steps do not leave exactly one result.
std::size_t stack_depth(const Program& program) {
  std::ptrdiff_t depth = 0, deepest = 1;
  for (const Step& step : program) {
    depth -= step.operands;
    if (depth < 0) break;
    deepest = std::max(deepest, ++depth);
  }
  if (depth != 1) throw ExpressionError("the expression does not give one number", 0, 1);
  return static_cast<std::size_t>(deepest);
}

}  // namespace

struct Expression::Implementation {
  std::string text;
  std::vector<std::string> variables, used_names;
  Program program;
  std::size_t depth = 1;
};

Expression::Expression(std::string text, std::vector<std::string> variables,
                       const std::vector<std::pair<std::string, double>>& constants) {
  auto made = std::make_shared<Implementation>();
  std::vector<std::string> constant_names;
  constant_names.reserve(constants.size());
  for (const auto& constant : constants) constant_names.push_back(constant.first);
  made->used_names = expression::check_syntax(text, variables, constant_names);

  static std::mutex one_at_a_time;  // muParser sets a locale that all parsers share
  const std::lock_guard lock(one_at_a_time);
  try {
    std::vector<double> slots(variables.size() + 1, 0.0);
    mu::Parser parser;
    define_functions(parser);
    for (std::size_t k = 0; k < variables.size(); ++k) parser.DefineVar(variables[k], &slots[k]);
    for (const auto& [name, value] : constants) parser.DefineConst(name, value);
    for (const auto& [name, value] : {std::pair{"pi", std::numbers::pi}, std::pair{"e", std::numbers::e}})
      if (!parser.GetConst().count(name) && !parser.GetVar().count(name)) parser.DefineConst(name, value);
    std::string line = text;
    std::replace_if(
        line.begin(), line.end(), [](char c) { return c == '\t' || c == '\n' || c == '\r'; }, ' ');
    parser.SetExpr(line);
    parser.Eval();  // compiles
    made->program = translate(parser.GetByteCode(), slots);
  } catch (const mu::ParserError& error) {
    const auto position = static_cast<std::size_t>(std::max(0, error.GetPos()));
    throw ExpressionError(error.GetMsg(), std::min(position, text.size() - 1),
                          std::max<std::size_t>(1, error.GetToken().size()));
  }
  made->depth = stack_depth(made->program);
  made->text = std::move(text);
  made->variables = std::move(variables);
  implementation_ = std::move(made);
}

Expression::~Expression() = default;
Expression::Expression(const Expression&) = default;
Expression::Expression(Expression&&) noexcept = default;
Expression& Expression::operator=(Expression other) noexcept {
  implementation_.swap(other.implementation_);
  return *this;
}

void Expression::evaluate(const double* const* arguments, std::size_t count, double* values) const {
  constexpr std::size_t rows_at_hand = 8;
  const auto& [text, variables, used_names, program, depth] = *implementation_;
  std::array<double, rows_at_hand * row_length> at_hand;
  std::vector<double> more(depth > rows_at_hand ? depth * row_length : 0);
  Stack stack{more.empty() ? at_hand.data() : more.data(), std::vector<char>(depth)};
  for (std::size_t first = 0; first < count; first += row_length) {
    const std::size_t length = std::min(row_length, count - first);
    run(program.data(), program.size(), arguments, first, length, stack);
    stack.spread(0, length);
    std::copy_n(stack.row(0), length, values + first);
  }
}

void Expression::differentiate(const double* const* arguments, std::size_t count,
                               const std::vector<std::size_t>& variables, double* values,
                               double* const* derivatives) const {
  const auto& [text, names, used_names, program, depth] = *implementation_;
  std::vector<double> rows((1 + variables.size()) * depth * row_length);
  Stack stack{rows.data(), std::vector<char>(depth)};
  std::vector<double*> tangents;
  for (std::size_t d = 0; d < variables.size(); ++d) tangents.push_back(rows.data() + (d + 1) * depth * row_length);
  for (std::size_t first = 0; first < count; first += row_length) {
    const std::size_t length = std::min(row_length, count - first);
    expression::run_with_derivatives(program, arguments, first, length, variables, stack, tangents);
    if (values) std::copy_n(stack.row(0), length, values + first);
    for (std::size_t d = 0; d < variables.size(); ++d) std::copy_n(tangents[d], length, derivatives[d] + first);
  }
}

std::vector<RoughSpot> Expression::rough_spots() const {
  std::vector<RoughSpot> spots;
  const auto add = [&](std::string_view name, std::string_view taken) {
    const auto same = [&](const RoughSpot& spot) { return spot.taken == taken; };
    if (!taken.empty() && std::none_of(spots.begin(), spots.end(), same)) spots.push_back({name, taken});
  };
  for (const Step& step : implementation_->program) {
    if (step.operation == Operation::call) add(step.function->info.name, step.function->rough);
    if (step.operation == Operation::choose)
      add("?", "a choice may jump where its condition changes; the slope of the branch taken is used");
    else if (step.operation >= Operation::less)
      add("", "a comparison jumps between 0 and 1; its slope is taken as 0 everywhere");
  }
  return spots;
}

double Expression::cost() const {
  // Measured on rows: half a nanosecond for what is one instruction, 10 to 20 for a function or a power.
  double sum = 0;
  for (const Step& step : implementation_->program)
    sum += step.operation == Operation::call || step.operation == Operation::power ? 0.4 : 0.015;
  return sum;
}

bool Expression::uses(std::string_view name) const {
  const auto& names = implementation_->used_names;
  return std::find(names.begin(), names.end(), name) != names.end();
}

double Expression::evaluate(const std::vector<double>& arguments) const {
  if (arguments.size() != implementation_->variables.size())
    throw std::invalid_argument(fmt::format("the expression \"{}\" has {} variables, given {} values", text(),
                                            implementation_->variables.size(), arguments.size()));
  std::vector<const double*> rows;
  rows.reserve(arguments.size());
  for (const double& argument : arguments) rows.push_back(&argument);
  double value = 0;
  evaluate(rows.data(), 1, &value);
  return value;
}

const std::string& Expression::text() const { return implementation_->text; }
const std::vector<std::string>& Expression::used_names() const { return implementation_->used_names; }

const std::vector<FunctionInfo>& expression_functions() {
  static const std::vector<FunctionInfo> infos = [] {
    std::vector<FunctionInfo> list;
    for (const auto& function : expression::functions()) list.push_back(function.info);
    return list;
  }();
  return infos;
}

bool is_reserved_name(std::string_view name) {
  if (name == "pi" || name == "e") return true;
  const auto& all = expression_functions();
  return std::any_of(all.begin(), all.end(), [&](const FunctionInfo& function) { return function.name == name; });
}

bool is_name(std::string_view text) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  return !text.empty() && letter(text[0]) &&
         std::all_of(text.begin(), text.end(), [&](char c) { return letter(c) || digit(c); });
}

}  // namespace gaussdrift
