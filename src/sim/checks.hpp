// Compares every [[check]] of a case with the numbers of the outputs.
#pragma once

#include <string>
#include <vector>

#include "gaussdrift/case.hpp"
#include "gaussdrift/summary.hpp"

namespace gaussdrift {

/// "Linf", "L1", "L2", "mass", "inside", "left", "stopped", "largest", ...
std::string to_string(CheckSpec::Quantity quantity);

/// The same with the reason that the check names: "left by x_max".
std::string words_for(const CheckSpec& check);

/// Does one of them ask for a field of the particles?
bool checks_fields(const std::vector<CheckSpec>& checks);
/// The fields that they ask for, each once, out of those of the particles.
std::vector<FieldNumbers> count_fields(const std::vector<CheckSpec>& checks, const std::vector<FieldOnGrid>& fields);

/// The output whose L1 is largest; the last one would mislead in a flow that turns back. Null if no norm is a number.
const std::pair<double, FrameNumbers>* worst_output(const std::vector<std::pair<double, FrameNumbers>>& frames);

/// One result for each check, over all outputs or the one that it names. A norm fails if it is not known, or if it
/// leaves out points whose exact density is not known. Outputs at which no particle has a value of a field are left out. `frames`: elapsed time and numbers of each output; what is told are
/// the times of the clock. Mass, inside, left and stopped are relative to the mass at the start.
std::vector<CheckResult> judge(const std::vector<CheckSpec>& checks, double mass_at_start,
                               const std::vector<std::pair<double, FrameNumbers>>& frames, const TimeSpec& clock);

}  // namespace gaussdrift
