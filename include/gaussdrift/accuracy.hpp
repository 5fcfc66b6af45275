/// @file
/// Settings for an accuracy, and what to know about a run before and after it.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "gaussdrift/case.hpp"
#include "gaussdrift/summary.hpp"

namespace gaussdrift {

/// The case with the cheapest settings whose predicted error meets `accuracy.target`: particles, overlap, cutoff, step
/// and tolerance; docs/method.md, section 10. The same case if it has no target. threads: 0 for all. Throws InputError
/// where no budget covers the case, or where the target cannot be met, naming the error that can.
Case choose_settings(const Case& spec, int threads = 0);

/// Throws InputError if the run of this case would take more memory than there is, naming both: the memory of the
/// machine, limits of the process and of its control group, and most_memory, in bytes. It looks at a sample of the
/// particles, and at nothing where the lattices are small. threads: 0 for all.
void refuse_what_does_not_fit(const Case& spec, int threads = 0,
                              double most_memory = std::numeric_limits<double>::infinity());

/// Facts about a finished run that its numbers do not show by themselves: blobs that no longer overlap, mass that left
/// the domain, a tolerance that cannot be promised. Sentences for people; empty: none. quadrature: what gaps between
/// blobs add to the error of the last output, relative to the largest density, where that was measured.
std::vector<std::string> warnings_of(const Case& spec, const RunSummary& summary,
                                     std::optional<double> quadrature = std::nullopt);

}  // namespace gaussdrift
