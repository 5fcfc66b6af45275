#include "mpi/ranks.hpp"

#include <mpi.h>
#include <unistd.h>

#include <stdexcept>

#include "base/shared_module.hpp"
#include "gaussdrift/error.hpp"
#include "mpi/mpi_module.hpp"

namespace gaussdrift::mpi {

namespace {

constexpr std::size_t most_bytes = std::size_t{1} << 30;  // in one call of MPI, whose counts have 32 bits

const MpiModule* loaded = nullptr;

const MpiModule* load() {
  // MPI loads parts of its own that look for its names.
  const base::SharedModule module({GAUSSDRIFT_MPI_RANKS}, base::SharedModule::Names::for_all);
  if (!module.is_there())
    throw CommandLineError("ranks cannot be started: " + module.reason() +
                           ".\nThey need " GAUSSDRIFT_MPI_RANKS
                           ", which is installed with the program in " GAUSSDRIFT_MODULES ", and " +
                           library() + ".");
  return module.find<const MpiModule*()>("gaussdrift_mpi_ranks")();
}

}  // namespace

std::string library() {
#if defined(OMPI_MAJOR_VERSION)
  return "Open MPI " + std::to_string(OMPI_MAJOR_VERSION) + "." + std::to_string(OMPI_MINOR_VERSION) + "." +
         std::to_string(OMPI_RELEASE_VERSION);
#elif defined(MPICH_VERSION)
  return "MPICH " MPICH_VERSION;
#else
  return "MPI " + std::to_string(MPI_VERSION) + "." + std::to_string(MPI_SUBVERSION);
#endif
}

std::unique_ptr<base::Communicator> start(const Exchange& how) {
  if (how.round == 0 || how.round > most_bytes) throw std::logic_error("a round has 1 to 2^30 bytes");
  loaded = load();
  return loaded->start(how);
}

void end_all(int code) {
  if (loaded) loaded->end_all(code);
  ::_exit(code);
}

}  // namespace gaussdrift::mpi
