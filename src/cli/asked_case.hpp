// The case that a verb was asked for.
#pragma once

#include "cli/verbs.hpp"
#include "gaussdrift/case.hpp"

namespace gaussdrift::cli {

/// The file with its overrides. Its warnings are told.
Case read(const CaseOptions& options);

/// The case as it is, or with the settings that its accuracy.target asks for. The choice is told.
Case settled(Case spec, const CaseOptions& options);

}  // namespace gaussdrift::cli
