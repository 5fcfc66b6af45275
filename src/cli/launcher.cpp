#include "cli/launcher.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <thread>

#include "base/counted.hpp"
#include "base/number.hpp"
#include "cli/terminal.hpp"
#include "gaussdrift/error.hpp"
#include "mpi/ranks.hpp"

namespace gaussdrift::cli {

namespace {

/// The number in the first of these variables that has one.
template <std::size_t n>
std::optional<int> number_in(const char* const (&names)[n]) {
  for (const char* name : names)
    if (const char* text = std::getenv(name))
      if (const std::optional<int> number = base::read_number<int>(text)) return number;
  return std::nullopt;
}

/// Open MPI sets the first; PMIx, MPICH's hydra and SLURM the others.
constexpr const char* signs[] = {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK", "PMI_SIZE"};
constexpr const char* sizes[] = {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"};
constexpr const char* numbers[] = {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK", "SLURM_PROCID"};

}  // namespace

Launcher find_launcher() {
  Launcher launcher;
  for (const char* name : signs) launcher.found = launcher.found || std::getenv(name);
  if (launcher.found) {
    launcher.copies = number_in(sizes);
    launcher.number = number_in(numbers);
  }
  return launcher;
}

std::unique_ptr<base::Communicator> start_ranks(const Launcher& launcher) {
  if (!launcher.found) return std::make_unique<base::Communicator>();
  const bool several = launcher.copies.value_or(1) > 1 || launcher.number.value_or(0) > 0;
  const std::string how_many = launcher.copies ? fmt::format("{}", *launcher.copies) : "several";
  if (mpi::library().empty()) {
    if (!several) return std::make_unique<base::Communicator>();
    throw CommandLineError(
        fmt::format("gaussdrift was started as {} copies, but it is built without MPI, so they cannot work together.\n"
                    "Install MPI (Debian: apt-get install libopenmpi-dev), configure with -D GAUSSDRIFT_MPI=ON and "
                    "build again. Or start it once, without mpirun.",
                    how_many));
  }
  std::unique_ptr<base::Communicator> ranks = mpi::start();
  if (ranks->size() == 1 && several)
    throw CommandLineError(
        fmt::format("gaussdrift was started as {} copies, but each of them finds itself alone: the launcher belongs to "
                    "another MPI.\nThis gaussdrift is built with {}. Start it with the mpirun of that, or, with srun, "
                    "by srun --mpi=pmix.",
                    how_many, mpi::library()));
  return ranks;
}

int refuse(const Launcher& launcher, const std::string& words) {
  if (launcher.number.value_or(0) == 0)
    note("error: {}\n", words);
  else
    std::this_thread::sleep_for(std::chrono::seconds(1));
  return static_cast<int>(ExitCode::command_line);
}

std::string ranks_text(const base::Communicator& ranks) {
  return base::counted(static_cast<std::size_t>(ranks.size()), "rank") + " on " +
         base::counted(static_cast<std::size_t>(ranks.hosts()), "host");
}

}  // namespace gaussdrift::cli
