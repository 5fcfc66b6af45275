// The densities of earlier outputs, for pictures that are drawn again: in memory, or read back from the run's own files.
// A run that writes no density files keeps some of its own for that, in state/pictures/.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "gaussdrift/density_grid.hpp"
#include "read/written_run.hpp"

namespace gaussdrift::render {

/// A density or an error at its output. All ways lead to the same bits.
class KeptDensities {
 public:
  /// `folder` of the run. In memory this many bytes are kept at most; what would take more is read back.
  /// `run_writes_densities`: there are files to read back already.
  /// `tracer`: the array of the files, where it is not the density.
  KeptDensities(std::filesystem::path folder, std::size_t most_bytes, bool run_writes_densities, std::string tracer)
      : folder_(std::move(folder)),
        tracer_(std::move(tracer)),
        most_bytes_(most_bytes),
        run_writes_densities_(run_writes_densities) {}

  /// All outputs of a run have the same lattice. Throws FileError.
  void keep(bool error, std::size_t output, double time, const DensityGrid& density);

  /// In single precision, and thinned in space. Throws FileError if it is neither kept nor in a file of this output.
  DensityGrid get(bool error, std::size_t output, double time);

  /// A field of that output, a vector, from its file. Throws FileError.
  FieldOnGrid field(std::string_view name, std::size_t output, double time);

  /// Removes the files of so many outputs, unless a checkpoint stands beside them: a run that goes on needs them.
  void remove_files(std::size_t outputs) const;

  Lattice lattice;  // of what was given to keep(), in this process or in an earlier one

 private:
  struct Kept {
    Lattice lattice;
    std::vector<float> rho;
  };
  static Kept kept_of(const DensityGrid& density);
  std::filesystem::path file_of(bool error, std::size_t output) const;
  void write_file(bool error, std::size_t output, double time, const Kept& kept) const;
  /// None if there is no whole file of this output.
  std::optional<Kept> read_file(bool error, std::size_t output, double time) const;
  DensityGrid read_back(bool error, std::size_t output, double time);
  std::filesystem::path density_file(std::size_t output, double time);

  std::filesystem::path folder_;
  std::string tracer_;
  std::size_t most_bytes_, bytes_ = 0;
  bool run_writes_densities_;
  std::map<std::pair<bool, std::size_t>, Kept> kept_;
  std::optional<std::vector<read::WrittenOutput>> files_;  // once they were looked for
};

}  // namespace gaussdrift::render
