// What is loaded when ranks start: the part that calls MPI (mpi_ranks.cpp), a shared library of its own. A program on one rank
// then has nothing of MPI in it.
#pragma once

#include <memory>

#include "base/communicator.hpp"
#include "mpi/ranks.hpp"

namespace gaussdrift::mpi {

struct MpiModule {
  std::unique_ptr<base::Communicator> (*start)(const Exchange& how);
  /// Returns where MPI does not run.
  void (*end_all)(int code);
};

}  // namespace gaussdrift::mpi
