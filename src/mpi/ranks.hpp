// Ranks over MPI. This module alone knows MPI; where the program is built without it, no_ranks.cpp stands in.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "base/communicator.hpp"

namespace gaussdrift::mpi {

/// "Open MPI 4.1.4"; empty in a build without MPI. Calls nothing of it.
std::string library();

/// How bytes are moved. The results are the same with any numbers here; tests take small ones.
struct Exchange {
  std::size_t round = std::size_t{64} << 20;  // bytes that a rank sends, and receives, at a time
  int told_by_all =
      1024;  // ranks up to which each tells each how much will come; beyond, only those that send something
};

/// Starts MPI. The ranks are those of this communicator until it goes; its end is the end of MPI, and waits for all
/// ranks. Once in a program, on its first thread. Throws std::logic_error in a build without MPI.
std::unique_ptr<base::Communicator> start(const Exchange& how = {});

/// Ends all ranks at once, this one with `code`. Also where MPI was never started, or is over.
[[noreturn]] void end_all(int code);

}  // namespace gaussdrift::mpi
