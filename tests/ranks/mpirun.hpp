// Starts N ranks, as a user does.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "mpi/ranks.hpp"
#include "program/program.hpp"

namespace gaussdrift {

/// For the beginning of a test.
#define NEEDS_MPIRUN()                                                                                     \
  if (std::string(MPIRUN).empty()) GTEST_SKIP() << "the program is built without MPI, or with sanitizers"; \
  if (mpi::library().find("Open MPI") != 0) GTEST_SKIP() << "these tests know the mpirun of Open MPI alone"

/// As root and in containers too.
inline const std::string mpirun =
    "env OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 "
    "OMPI_MCA_btl_vader_single_copy_mechanism=none timeout 100 " MPIRUN " -q ";

inline std::string ranks_of_mpi(int ranks, const std::string& command) {
  return mpirun + "--oversubscribe --bind-to none -n " + std::to_string(ranks) + " " + command;
}

/// Without OMP_WAIT_POLICY, which ctest sets, the program starts itself again.
inline std::string ranks_that_start_again(int ranks, const std::string& command) {
  return "unset OMP_WAIT_POLICY; " + ranks_of_mpi(ranks, command);
}

inline Outcome on_ranks_of_mpi(int ranks, const std::string& command, const ScratchFolder& folder) {
  return outcome_of(folder, ranks_of_mpi(ranks, command));
}

inline std::size_t times_in(const std::string& text, const std::string& words) {
  std::size_t times = 0;
  for (std::size_t at = text.find(words); at != std::string::npos; at = text.find(words, at + 1)) ++times;
  return times;
}

}  // namespace gaussdrift
