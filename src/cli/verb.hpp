// A verb of the program: one object, made in a file of its own.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "cli/options.hpp"
#include "gaussdrift/error.hpp"

namespace gaussdrift::cli {

/// What becomes of a verb where the program is started as several ranks.
enum class OnRanks {
  first,    // rank 0 does it, the others wait
  refused,  // it computes what ranks would share, and cannot share it yet
};

struct Verb {
  std::string name;
  std::string meaning;                       // one line of --help
  std::function<void(OptionList&)> declare;  // its options
  std::function<ExitCode()> run;             // with the options that were given; throws an Error
  OnRanks on_ranks = OnRanks::first;
};

/// The verb of a struct of options: one function declares them, the other does what they say.
template <class Given>
Verb make_verb(const std::string& name, const std::string& meaning, void (*declare)(OptionList&, Given&),
               ExitCode (*run)(const Given&), Given at_first = {}) {
  const auto given = std::make_shared<Given>(std::move(at_first));
  return {name, meaning, [=](OptionList& options) { declare(options, *given); }, [=] { return run(*given); },
          OnRanks::first};
}

}  // namespace gaussdrift::cli
