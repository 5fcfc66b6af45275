// The densities of earlier outputs, for pictures that are drawn again: in memory, or read back from the run's own files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "gaussdrift/density_grid.hpp"
#include "read/written_run.hpp"

namespace gaussdrift::render {

/// A density or an error at its output. Both ways lead to the same bits.
class KeptDensities {
 public:
  /// `folder` of the run. What is kept takes this many bytes at most; what would take more is read back.
  KeptDensities(std::filesystem::path folder, std::size_t most_bytes)
      : folder_(std::move(folder)), most_bytes_(most_bytes) {}

  /// All outputs of a run have the same lattice.
  void keep(bool error, std::size_t output, const DensityGrid& density);

  /// In single precision, and thinned in space. Throws FileError if it is neither kept nor in a file of this output.
  DensityGrid get(bool error, std::size_t output, double time);

  Lattice lattice;  // of what was given to keep(), in this process or in an earlier one

 private:
  struct Kept {
    Lattice lattice;
    std::vector<float> rho;
  };
  static Kept kept_of(const DensityGrid& density);
  DensityGrid read_back(bool error, std::size_t output, double time);

  std::filesystem::path folder_;
  std::size_t most_bytes_, bytes_ = 0;
  std::map<std::pair<bool, std::size_t>, Kept> kept_;
  std::optional<std::vector<read::WrittenOutput>> files_;  // once they were looked for
};

}  // namespace gaussdrift::render
