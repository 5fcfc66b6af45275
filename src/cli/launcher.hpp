// A launcher (mpirun, srun) starts several copies of the program, which are the ranks of one run. It says so in
// environment variables. Without them nothing of MPI is called.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "base/communicator.hpp"

namespace gaussdrift::cli {

/// What the variables say.
struct Launcher {
  bool found = false;
  std::optional<int> copies, number;  // how many there are, and which one this is, from 0; not every launcher tells
};

Launcher find_launcher();

/// The ranks that the launcher started; one rank where there is none. Throws CommandLineError where there are more
/// copies than the program can join, because it is built without MPI or for another one: each would do all of the work,
/// and they would overwrite each other's files.
std::unique_ptr<base::Communicator> start_ranks(const Launcher& launcher);

/// What a copy does with such an error: the first one tells it, and the others leave later, because launchers end all
/// copies as soon as one of them has failed. Returns the exit code.
int refuse(const Launcher& launcher, const std::string& words);

/// "3 ranks on 1 host"
std::string ranks_text(const base::Communicator& ranks);

}  // namespace gaussdrift::cli
