// Whether `run` would accept a case that a study, a hint or --accuracy is about to recommend. The run's own code
// decides.
#pragma once

#include <string>

#include "gaussdrift/case.hpp"

namespace gaussdrift::accuracy {

/// Why reading the case as a file would refuse it, in one line; empty: it would not. Data that it names are not read
/// again.
std::string why_not_read(const Case& spec);

/// Why `run` would refuse the case before its first step: what why_not_read() says, then what Simulation::prepare()
/// does. Empty: it would not.
std::string why_refused(const Case& spec, int threads);

/// "[effects.remesh]", the table of an effect that makes blobs overlap again, if reading the case with it would accept
/// it; else empty.
std::string table_against_gaps(Case spec);

/// Lattices with more points than this are not recommended, because judging them means seeding them.
constexpr double most_judged = 4e6;

}  // namespace gaussdrift::accuracy
