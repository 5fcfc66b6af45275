// The densities that a run left, in the order and with the times of their outputs.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gaussdrift/density_grid.hpp"

namespace gaussdrift::read {

struct WrittenOutput {
  std::filesystem::path file;
  std::optional<double> time;  // none in a .vti of others that has no TimeValue
  std::size_t number = 0;      // of the output, as in the file's name; 0 for a single file
};

/// Of a run's folder, finished or not, or of one .vti. `series` names the files and their folder; times are those of
/// its .pvd, or of the files where it does not list them. Empty where a folder holds no densities. Throws FileError: nothing there, a file that cannot be read.
std::vector<WrittenOutput> written_outputs(const std::filesystem::path& place, std::string_view series);

/// An array of a .vti: rho, rho_exact (NaN where it is not known) or error. Throws FileError.
DensityGrid read_density(const std::filesystem::path& file, const std::string& array);

}  // namespace gaussdrift::read
