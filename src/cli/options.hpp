// The options of a verb, as the verb declares them. They are defined in command_line.cpp.
#pragma once

#include <string>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace gaussdrift::cli {

/// An option that has been declared, for what else is to be said about it.
class Option {
 public:
  explicit Option(CLI::Option& option) : option_(&option) {}
  Option& required();
  /// Each time with one value: --set a=1 --set b=2.
  Option& repeatable();
  /// Several values in one word: --times 0,1,2.
  Option& separated_by(char separator);
  /// The value may be left out, and is then "true".
  Option& value_optional();
  Option& within(int least, int most);
  Option& within(double least, double most);
  Option& not_negative();
  Option& excludes(const Option& other);

 private:
  CLI::Option* option_;
};

class OptionList {
 public:
  explicit OptionList(CLI::App& verb) : verb_(verb) {}
  /// `name` is "--out", or "folder" for a word without dashes. The value is put into `value`, a text, a path, a number
  /// or a list of them (command_line.cpp names the types). `type` is what --help calls the value: DIR.
  template <class Value>
  Option add(const std::string& name, Value& value, const std::string& type, const std::string& meaning);
  Option flag(const std::string& name, bool& value, const std::string& meaning);

  /// --threads and --json, which most verbs have.
  void threads(int& value);
  void json(bool& value, const std::string& meaning = "results as JSON on standard output");

 private:
  CLI::App& verb_;
};

}  // namespace gaussdrift::cli
