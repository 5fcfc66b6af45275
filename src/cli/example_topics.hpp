// The built-in cases by what they show.
#pragma once

#include <string>
#include <vector>

#include "input/examples.hpp"

namespace gaussdrift::cli {

struct Example {
  std::string name;   // "rotating_cone"
  std::string title;  // of [case]
  std::string topic;  // of its comment "# Shows: flows in the plane"
};

/// In alphabetical order.
std::vector<Example> examples();

/// Those whose name, title or topic has the word, by topics; with an empty word all. Throws CommandLineError where there are none.
std::vector<Example> examples_about(const std::string& word);

/// The case, and what it reads: files of the same name, and of that name and a number.
std::vector<const input::ExampleFile*> files_of(const std::string& name);

}  // namespace gaussdrift::cli
