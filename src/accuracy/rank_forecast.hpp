// What N ranks would make of a case, computed without having them.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "accuracy/footprint.hpp"
#include "gaussdrift/case.hpp"

namespace gaussdrift::accuracy {

struct RankForecast {
  int ranks = 1;
  std::string refused;         // why they cannot share it; empty: they can
  std::size_t tiles = 1;       // at the start
  std::size_t most_ranks = 1;  // with more than these some have nothing to do
  std::size_t idle = 0;        // ranks without a tile
  double balance = 1;          // predicted work of the busiest rank over the mean
  double halo_bytes = 0;       // that the rank which receives most gets of others' particles, for one density
  double gathered_bytes = 0;   // of one density, to rank 0
  /// Of places, weights and velocities of particles that move each other, for one velocity, to the rank that gets most;
  /// without what belongs to the border of its part.
  double pair_bytes = 0;
  double first_memory = 0, other_memory = 0;  // of rank 0, and of the largest of the others, with the program
  std::vector<RunMemory> memory;              // of each rank, without the program
  bool whole = true;                          // from all particles; else from a sample
};

/// particles_at_most: of all ranks. program: bytes that the program takes itself. Takes as much memory as a trial does,
/// and a second at most.
RankForecast forecast_ranks(const Case& spec, double particles_at_most, double program, int ranks);

/// The largest number of ranks up to which every rank gets a tile of this work.
std::size_t most_useful_ranks(const std::vector<double>& work);

/// The lines that `gaussdrift check --ranks` adds, and the member "ranks" of its JSON.
std::string to_text(const RankForecast& forecast);
std::string to_json(const RankForecast& forecast);

}  // namespace gaussdrift::accuracy
