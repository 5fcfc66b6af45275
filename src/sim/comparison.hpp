// Which points of an output are compared with the exact density, and how their paths are followed.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "gaussdrift/case.hpp"
#include "reference/reference.hpp"
#include "sim/scene.hpp"

namespace gaussdrift {

/// How paths are followed back where their work is bounded.
struct Following {
  std::size_t most_steps = 0;       // of a path; 0: far more than any usual one takes
  bool by_half_steps = false;       // by the method of the case with steps half as long, for paths through kinks
  std::size_t rank = 0, ranks = 1;  // the share of the paths, see CharacteristicsOptions
};

/// The exact density that the case asks for, on the evaluation lattice; null for none. The scene must outlive it.
std::unique_ptr<Reference> make_reference(const Case& spec, const Scene& scene, int threads,
                                          const Following& following = {});

/// Paths that can be followed within some work, and how.
struct Affordable {
  std::size_t points = 0;  // 0: not even few
  Following following{};
  double work = 0;     // of one path from the last output to the start
  std::string word{};  // what is not exact about them; empty: nothing
};

/// How many exact paths can be followed from grid points to the start with the work `allowed`, for `outputs` outputs
/// (in units of the last one): at least 16, or none. Paths with kinks that are too expensive are followed by steps half
/// as long as those of the case. The answer comes from following some paths, which takes at most a quarter of the work.
Affordable affordable_paths(const Case& spec, const Scene& scene, double allowed, double outputs, int threads);

/// The part of an output that is compared with the reference.
struct Comparison {
  std::size_t points = 0;  // of the grid; 0: none, for the reason `left_out`
  Following following{};
  std::string word{};  // what is not exact about the exact density; empty: nothing
  std::string left_out{};
};

/// reference.points if the case has it. All if a picture shows the error, or if the reference is a formula. Otherwise
/// as many as 15 % of the work of the run allow (or a tenth of a second): all if density files are written, else at
/// most 4096, and at most 256 where paths have kinks. None if fewer than 16 are allowed, unless a check or a target
/// needs them.
Comparison plan_comparison(const Case& spec, const Scene& scene, std::size_t particles, int threads);

}  // namespace gaussdrift
