#include "cli/options.hpp"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <vector>

namespace gaussdrift::cli {

Option& Option::required() {
  option_->required();
  return *this;
}

Option& Option::repeatable() {
  option_->allow_extra_args(false);
  return *this;
}

Option& Option::separated_by(char separator) {
  option_->delimiter(separator);
  return *this;
}

Option& Option::within(int least, int most) {
  option_->check(CLI::Range(least, most));
  return *this;
}

Option& Option::within(double least, double most) {
  option_->check(CLI::Range(least, most));
  return *this;
}

Option& Option::not_negative() {
  option_->check(CLI::NonNegativeNumber);
  return *this;
}

Option& Option::excludes(const Option& other) {
  option_->excludes(other.option_);
  return *this;
}

template <class Value>
Option OptionList::add(const std::string& name, Value& value, const std::string& type, const std::string& meaning) {
  return Option(*verb_.add_option(name, value, meaning)->type_name(type));
}
template Option OptionList::add(const std::string&, std::string&, const std::string&, const std::string&);
template Option OptionList::add(const std::string&, std::filesystem::path&, const std::string&, const std::string&);
template Option OptionList::add(const std::string&, int&, const std::string&, const std::string&);
template Option OptionList::add(const std::string&, double&, const std::string&, const std::string&);
template Option OptionList::add(const std::string&, std::optional<double>&, const std::string&, const std::string&);
template Option OptionList::add(const std::string&, std::optional<int>&, const std::string&, const std::string&);
template Option OptionList::add(const std::string&, std::vector<std::string>&, const std::string&, const std::string&);
template Option OptionList::add(const std::string&, std::vector<double>&, const std::string&, const std::string&);

Option OptionList::flag(const std::string& name, bool& value, const std::string& meaning) {
  return Option(*verb_.add_flag(name, value, meaning));
}

void OptionList::threads(int& value) {
  add("--threads", value, "N", "number of threads; all by default").within(1, 1024);
}

void OptionList::json(bool& value, const std::string& meaning) { flag("--json", value, meaning); }

}  // namespace gaussdrift::cli
