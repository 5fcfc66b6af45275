// The parts of what Simulation::state() says. The numbers of an output do not change any more, so they need not be
// written anew with every checkpoint.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace gaussdrift {

/// Of the bytes.
constexpr unsigned newest_format = 3;

struct RunState {
  std::uint64_t format = newest_format;  // 1: `run` has the outputs; 2: it has the steps that follow from them
  std::string run;                       // how far it is, and what effects and observers have gathered
  std::vector<std::string> outputs;      // the numbers of each
};

/// Throws std::out_of_range if these are not the bytes of a state.
RunState parted(std::string_view state);

/// The bytes of Simulation::state().
std::string joined(RunState& parts);

}  // namespace gaussdrift
