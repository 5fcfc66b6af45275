// Where the values of a sum go, and as what.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "sum/points_request.hpp"

namespace gaussdrift::cli {

enum class ValuesFormat {
  table,  // text
  npy,    // of NumPy
  image   // of ParaView, .vti
};

/// By the ending of its name. Throws CommandLineError for endings of what is not written.
ValuesFormat format_of(const std::filesystem::path& out);

struct ValuesOutput {
  std::filesystem::path file;  // empty or "-": standard output
  std::vector<std::string> columns;
  std::vector<sum::GridAxis> grid;  // none: the targets are scattered
};

/// A file is whole or not there; a pipe or a device is written to. An image needs a grid of one to three axes. Throws
/// FileError.
void write_values(const ValuesOutput& output, const Eigen::MatrixXd& values);

}  // namespace gaussdrift::cli
