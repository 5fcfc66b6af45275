// A build without MPI.
#include <unistd.h>

#include <stdexcept>

#include "mpi/ranks.hpp"

namespace gaussdrift::mpi {

std::string library() { return ""; }

std::unique_ptr<base::Communicator> start(const Exchange&) {
  throw std::logic_error("MPI is asked for in a build without it");
}

void end_all(int code) { ::_exit(code); }

}  // namespace gaussdrift::mpi
