// The densities that a run left, in the order and with the times of their outputs.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "read/stored_density.hpp"

namespace gaussdrift::read {

struct WrittenOutput {
  std::filesystem::path file;
  std::optional<double> time;  // none in a file of others that has no TimeValue
  std::size_t number = 0;      // of the output, as in the file's name; 0 for a single file
};

/// Of a run's folder, finished or not, or of one .vti or .pvti. `series` names the files and their folder; times are those of
/// its .pvd, or of the files where it does not list them. Empty where a folder holds no densities. Throws FileError: nothing there, a file that cannot be read.
std::vector<WrittenOutput> written_outputs(const std::filesystem::path& place, std::string_view series);

}  // namespace gaussdrift::read
