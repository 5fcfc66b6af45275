// All verbs of the program, a file each.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cli/verb.hpp"

namespace gaussdrift::cli {

Verb new_verb();
/// `typed`: the command line, for provenance.json.
Verb run_verb(const std::string& typed);
Verb resume_verb(const std::string& typed);
Verb check_verb();
Verb study_verb();
Verb report_verb();
Verb render_verb();
Verb compare_verb();
Verb doctor_verb();
Verb field_verb();
Verb fit_verb();
Verb sum_verb();
Verb reproduce_verb();
Verb explain_verb();
/// `all_verbs`: of the program, itself among them.
Verb manual_verb(std::function<std::vector<Verb>()> all_verbs);

/// Parses the command line, does what it says, prints errors on stderr; returns the exit code.
int main_verbs(int argc, char** argv);

}  // namespace gaussdrift::cli
