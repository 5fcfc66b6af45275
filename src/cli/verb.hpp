// A verb of the program: one object, made in a file of its own.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "base/communicator.hpp"
#include "cli/options.hpp"
#include "gaussdrift/error.hpp"

namespace gaussdrift::cli {

/// What becomes of a verb where the program is started as several ranks.
enum class OnRanks {
  first,   // rank 0 does it, the others wait
  shared,  // all do it together
};

struct Verb {
  std::string name;
  std::string meaning;                       // one line of --help
  std::function<void(OptionList&)> declare;  // its options
  /// With the options that were given; throws an Error. On rank 0 alone, or on all of them.
  std::function<ExitCode(base::Communicator& ranks)> run;
  OnRanks on_ranks = OnRanks::first;
};

/// The verb of a struct of options: one function declares them, the other does what they say.
template <class Given>
Verb make_verb(const std::string& name, const std::string& meaning, void (*declare)(OptionList&, Given&),
               ExitCode (*run)(const Given&), Given at_first = {}) {
  const auto given = std::make_shared<Given>(std::move(at_first));
  return {name, meaning, [=](OptionList& options) { declare(options, *given); },
          [=](base::Communicator&) { return run(*given); }, OnRanks::first};
}
template <class Given>
Verb make_shared_verb(const std::string& name, const std::string& meaning, void (*declare)(OptionList&, Given&),
                      ExitCode (*run)(const Given&, base::Communicator&), Given at_first = {}) {
  const auto given = std::make_shared<Given>(std::move(at_first));
  return {name, meaning, [=](OptionList& options) { declare(options, *given); },
          [=](base::Communicator& ranks) { return run(*given, ranks); }, OnRanks::shared};
}

}  // namespace gaussdrift::cli
