// A verb of the program: one object, made in a file of its own.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "cli/options.hpp"
#include "gaussdrift/error.hpp"

namespace gaussdrift::cli {

struct Verb {
  std::string name;
  std::string meaning;                       // one line of --help
  std::function<void(OptionList&)> declare;  // its options
  std::function<ExitCode()> run;             // with the options that were given; throws an Error
};

/// The verb of a struct of options: one function declares them, the other does what they say.
template <class Given>
Verb make_verb(const std::string& name, const std::string& meaning, void (*declare)(OptionList&, Given&),
               ExitCode (*run)(const Given&), Given at_first = {}) {
  const auto given = std::make_shared<Given>(std::move(at_first));
  return {name, meaning, [=](OptionList& options) { declare(options, *given); }, [=] { return run(*given); }};
}

}  // namespace gaussdrift::cli
