// What of a case decides where its particles are, and what may change while a run is under way.
#pragma once

#include <string>
#include <vector>

#include "gaussdrift/case.hpp"

namespace gaussdrift::input {

/// All that particles, grid and exact density depend on, as text: the case without its title, outputs, checks, targets
/// and end, and data files without their folders.
std::string text_of_past(const Case& spec);

/// Keys whose values differ, as "time.step"; those of text_of_past(), and the others.
struct ChangedKeys {
  std::vector<std::string> past, future;
};
ChangedKeys changed_keys(const Case& before, const Case& after);

}  // namespace gaussdrift::input
