// The options of a verb, as the verb declares them. They are defined in command_line.cpp.
#pragma once

#include <deque>
#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace gaussdrift::cli {

/// What was said about an option. The manual page, completions and answers to wrong words are made of it.
struct OptionWords {
  std::string name;  // "--out", or "folder" for a word without dashes; "table,--table": either
  std::string type;  // what its value is called, "DIR"; empty: a flag
  std::string meaning;
  bool required = false;
  bool repeatable = false;
  bool value_optional = false;
  std::string range = {};                                // of numbers: "1 to 1024"
  std::function<std::vector<std::string>()> offer = {};  // words that shells complete its value with

  /// "--out"; empty for a word without dashes.
  std::string dashed() const { return name.find('-') == std::string::npos ? "" : name.substr(name.find('-')); }
  bool is_word() const { return name.front() != '-'; }
};

/// An option that has been declared, for what else is to be said about it.
class Option {
 public:
  Option(CLI::Option& option, OptionWords& words) : option_(&option), words_(&words) {}
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
  /// Words that shells complete the value with. They are asked for when completions are written.
  Option& offers(std::function<std::vector<std::string>()> words);

 private:
  CLI::Option* option_;
  OptionWords* words_;
};

class OptionList {
 public:
  /// Declares them to the parser, and puts down in `words` what is said about them.
  OptionList(CLI::App& verb, std::deque<OptionWords>& words) : verb_(verb), words_(words) {}
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
  std::deque<OptionWords>& words_;  // whose elements stay where they are
};

}  // namespace gaussdrift::cli
