// One pass from left to right. At each place an operand or an operator is expected. Every open parenthesis remembers
// what it belongs to.
#include "expression/syntax.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <system_error>

#include "base/printable.hpp"
#include "base/suggest.hpp"
#include "expression/foreign_names.hpp"

namespace gaussdrift::expression {
namespace {

constexpr std::size_t longest_text = 4000;  // muParser's own limit is 5000 characters
constexpr std::size_t longest_name = 100;

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

struct Token {
  enum class Kind { number, name, symbol, end } kind = Kind::end;
  std::size_t position = 0;
  std::string text;

  bool is(std::string_view symbol) const { return kind == Kind::symbol && text == symbol; }
};

[[noreturn]] void fail(const Token& at, const std::string& message) {
  throw ExpressionError(message, at.position, std::max<std::size_t>(1, at.text.size()));
}

/// Length of the number that starts at `first`: digits with at most one point, then perhaps an exponent.
std::size_t number_length(const std::string& text, std::size_t first) {
  std::size_t i = first;
  while (i < text.size() && is_digit(text[i])) ++i;
  if (i < text.size() && text[i] == '.') ++i;
  while (i < text.size() && is_digit(text[i])) ++i;
  if (i < text.size() && (text[i] == 'e' || text[i] == 'E')) {
    std::size_t k = i + 1;
    if (k < text.size() && (text[k] == '+' || text[k] == '-')) ++k;
    if (k < text.size() && is_digit(text[k])) {
      while (k < text.size() && is_digit(text[k])) ++k;
      i = k;
    }
  }
  return i - first;
}

Token number_at(const std::string& text, std::size_t position) {
  Token token{Token::Kind::number, position, text.substr(position, number_length(text, position))};
  double value = 0;
  const auto read = std::from_chars(token.text.data(), token.text.data() + token.text.size(), value);
  if (read.ec == std::errc::result_out_of_range)
    fail(token, fmt::format("the number {} does not fit a double (about 1e-308 to 1e308)", token.text));
  const std::size_t after = position + token.text.size();
  if (after < text.size() && text[after] == '.')
    fail({Token::Kind::symbol, after, "."}, "a number has one decimal point");
  return token;
}

/// Symbols that people try, and what to write instead.
[[noreturn]] void refuse_foreign_symbol(const Token& token) {
  const std::string_view instead = instead_of_symbol(token.text);
  if (!instead.empty()) fail(token, fmt::format("there is no operator \"{}\"; {}", token.text, instead));
  if (token.text == "\"" || token.text == "'") fail(token, "an expression contains no strings");
  fail(token, fmt::format("{} does not belong in an expression", base::in_quotes(token.text)));
}

Token next_token(const std::string& text, std::size_t from) {
  while (from < text.size() && is_space(text[from])) ++from;
  if (from == text.size()) return {Token::Kind::end, from, ""};
  const char c = text[from];
  if (is_digit(c) || (c == '.' && from + 1 < text.size() && is_digit(text[from + 1]))) return number_at(text, from);
  if (is_letter(c)) {
    std::size_t end = from;
    while (end < text.size() && (is_letter(text[end]) || is_digit(text[end]))) ++end;
    return {Token::Kind::name, from, text.substr(from, end - from)};
  }
  static constexpr std::string_view symbols[] = {"<=", ">=", "==", "!=", "&&", "||", "**", "+", "-", "*",
                                                 "/",  "^",  "<",  ">",  "(",  ")",  ",",  "?", ":"};
  const std::string_view rest = std::string_view(text).substr(from);
  for (const auto symbol : symbols)
    if (rest.substr(0, symbol.size()) == symbol) {
      Token token{Token::Kind::symbol, from, std::string(symbol)};
      if (symbol == "**") refuse_foreign_symbol(token);
      return token;
    }
  std::size_t length = 1;  // a character beyond ASCII is several bytes 10xxxxxx long
  while (from + length < text.size() && (static_cast<unsigned char>(text[from + length]) & 0xC0) == 0x80) ++length;
  refuse_foreign_symbol({Token::Kind::symbol, from, text.substr(from, length)});
}

bool is_sign(const Token& token) { return token.is("+") || token.is("-"); }
bool is_comparison(const Token& token) {
  return token.is("<") || token.is(">") || token.is("<=") || token.is(">=") || token.is("==") || token.is("!=");
}

const FunctionInfo* find_function(std::string_view name) {
  for (const auto& function : expression_functions())
    if (function.name == name) return &function;
  return nullptr;
}

std::string needed_arguments(const FunctionInfo& function) {
  if (function.arguments < 0) return fmt::format("at least {} arguments", -function.arguments);
  return fmt::format("{} argument{}", function.arguments, function.arguments == 1 ? "" : "s");
}

/// An open parenthesis, or the whole text: what is inside so far.
struct Group {
  Token open{};
  const FunctionInfo* function = nullptr;  // whose arguments these are
  Token name{};
  int commas = 0;
  std::vector<Token> questions{};  // "?" that still lack their ":"
  bool compared = false;           // a comparison since the last && || ? : or comma
};

class Checker {
 public:
  Checker(const std::string& text, const std::vector<std::string>& variables, const std::vector<std::string>& constants)
      : text_(text), known_(variables) {
    known_.insert(known_.end(), constants.begin(), constants.end());
    for (const char* name : {"pi", "e"})
      if (std::find(known_.begin(), known_.end(), name) == known_.end()) known_.emplace_back(name);
  }

  std::vector<std::string> run() {
    if (text_.size() > longest_text)
      throw ExpressionError(
          fmt::format("the expression has {} characters; at most {} are read", text_.size(), longest_text), 0, 1);
    groups_.push_back({});
    for (Token token = next(); token.kind != Token::Kind::end; token = next()) {
      if (operand_wanted_)
        operand(token);
      else
        operation(token);
      last_ = token;
    }
    finish();
    return used_;
  }

 private:
  Token next() { return next_token(text_, last_.position + last_.text.size()); }

  void operand(const Token& token) {
    if (token.kind == Token::Kind::number) {
      operand_wanted_ = false;
    } else if (token.kind == Token::Kind::name) {
      name(token);
    } else if (token.is("(")) {
      groups_.push_back({token, called_, last_});
      called_ = nullptr;
    } else if (is_sign(token)) {
      if (sign_) fail(token, fmt::format("two signs in a row; write {}({}...)", last_.text, token.text));
      sign_ = true;
      return;
    } else if (last_.kind == Token::Kind::end) {
      fail(token, fmt::format("an expression cannot begin with \"{}\"", token.text));
    } else if (last_.is("(") && token.is(")")) {
      const Group& group = groups_.back();
      if (group.function)
        fail(group.name,
             fmt::format("{} needs {}, found none", group.function->name, needed_arguments(*group.function)));
      fail(last_, "nothing between the parentheses");
    } else {
      fail(token, fmt::format("a value is missing between \"{}\" and \"{}\"", last_.text, token.text));
    }
    sign_ = false;
  }

  void name(const Token& token) {
    const Token following = next_token(text_, token.position + token.text.size());
    if (token.text.size() > longest_name) fail(token, fmt::format("a name has at most {} characters", longest_name));
    if (const FunctionInfo* function = find_function(token.text)) {
      if (!following.is("("))
        fail(token, fmt::format("the function {} wants its arguments in parentheses: {}({})", token.text, token.text,
                                function->arguments == 1 ? "..." : "..., ..."));
      called_ = function;  // the parenthesis comes next
      return;
    }
    if (std::find(known_.begin(), known_.end(), token.text) == known_.end()) unknown(token, following.is("("));
    if (following.is("("))
      fail(token, fmt::format("\"{0}\" is not a function; write {0} * (...) to multiply", token.text));
    if (std::find(used_.begin(), used_.end(), token.text) == used_.end()) used_.push_back(token.text);
    operand_wanted_ = false;
  }

  static std::vector<std::string> function_names() {
    std::vector<std::string> names;
    for (const auto& function : expression_functions()) names.emplace_back(function.name);
    return names;
  }

  void unknown(const Token& token, bool called) const {
    const std::string_view instead = called ? instead_of_function(token.text) : instead_of_name(token.text);
    if (!instead.empty())
      fail(token, fmt::format("there is no {} \"{}\"; {}", called ? "function" : "name", token.text, instead));
    std::vector<std::string> candidates = called ? std::vector<std::string>() : known_;
    const std::vector<std::string> functions = function_names();
    candidates.insert(candidates.end(), functions.begin(), functions.end());
    // A single letter is one replacement away from every other: the list of names says more.
    const auto near = token.text.size() > 1 ? base::suggest(token.text, candidates) : std::nullopt;
    std::string remedy;
    if (near) remedy = fmt::format("; did you mean \"{}\"?", *near);
    if (!near) remedy = fmt::format("; known here: {}", fmt::join(called ? functions : known_, ", "));
    fail(token, fmt::format("unknown {} \"{}\"{}", called ? "function" : "name", token.text, remedy));
  }

  void operation(const Token& token) {
    if (token.kind == Token::Kind::name && std::find(known_.begin(), known_.end(), token.text) == known_.end() &&
        !instead_of_name(token.text).empty())
      fail(token, fmt::format("there is no operator \"{}\"; {}", token.text, instead_of_name(token.text)));
    if (token.kind != Token::Kind::symbol || token.is("("))
      fail(token, fmt::format("an operator is missing between \"{0}\" and \"{1}\"; write {0} * {1} to multiply",
                              last_.text, token.is("(") ? "(...)" : token.text));
    Group& group = groups_.back();
    if (token.is(")")) {
      if (groups_.size() == 1) fail(token, "\")\" closes nothing: there is no \"(\" before it");
      close(group);
      groups_.pop_back();
      return;  // the parenthesis as a whole was an operand
    }
    if (token.is(",")) {
      if (!group.function) fail(token, "a comma only separates the arguments of a function; decimals have a point");
      check_questions(group);
      ++group.commas;
      group.compared = false;
    } else if (token.is("?")) {
      group.questions.push_back(token);
      group.compared = false;
    } else if (token.is(":")) {
      if (group.questions.empty()) fail(token, "\":\" without a \"?\" before it; a choice is condition ? a : b");
      group.questions.pop_back();
      group.compared = false;
    } else if (token.is("&&") || token.is("||")) {
      group.compared = false;
    } else if (is_comparison(token)) {
      if (group.compared) fail(token, "comparisons cannot be chained; write a < b && b < c");
      group.compared = true;
    }
    operand_wanted_ = true;
  }

  static void check_questions(const Group& group) {
    if (!group.questions.empty())
      fail(group.questions.back(), "\"?\" without its \":\"; a choice is condition ? a : b");
  }

  static void close(const Group& group) {
    check_questions(group);
    if (!group.function) return;
    const int found = group.commas + 1, wanted = group.function->arguments;
    if (wanted < 0 ? found < -wanted : found != wanted)
      fail(group.name,
           fmt::format("{} needs {}, found {}", group.function->name, needed_arguments(*group.function), found));
  }

  void finish() const {
    if (last_.kind == Token::Kind::end) throw ExpressionError("the expression is empty", 0, 1);
    if (operand_wanted_) fail(last_, fmt::format("a value is missing after \"{}\"", last_.text));
    if (groups_.size() > 1) fail(groups_.back().open, "\"(\" is never closed");
    check_questions(groups_.back());
  }

  const std::string& text_;
  std::vector<std::string> known_, used_;
  std::vector<Group> groups_;
  Token last_;                            // kind end: nothing read yet
  const FunctionInfo* called_ = nullptr;  // its name was the last token
  bool operand_wanted_ = true;
  bool sign_ = false;  // the last token was a sign before an operand
};

}  // namespace

std::vector<std::string> check_syntax(const std::string& text, const std::vector<std::string>& variables,
                                      const std::vector<std::string>& constants) {
  return Checker(text, variables, constants).run();
}

}  // namespace gaussdrift::expression
