// A table of samples at scattered points: coordinates, and what is known there.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace gaussdrift::input {

struct SampleTable {
  std::vector<double> positions;  // [point][dimension]
  std::vector<double> values;     // [point][component]
};

enum class Coinciding {
  allowed,
  refused  // two samples at one place: a fit to both has no solution, or no meaning
};

/// The columns have these names, the first `dimension` of them coordinates, in any order in the file. Throws FileError if
/// the file cannot be read, and InputError, naming file, line and column, for what it contains.
SampleTable read_sample_table(const std::filesystem::path& file, const std::vector<std::string>& names, int dimension,
                              Coinciding coinciding);

}  // namespace gaussdrift::input
