#include "render/kept_densities.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "gaussdrift/error.hpp"
#include "render/solid.hpp"
#include "write/output_files.hpp"

namespace gaussdrift::render {

// Single precision is plenty for colours and halves what a long run keeps; in space thinned, for the same reason.
KeptDensities::Kept KeptDensities::kept_of(const DensityGrid& density) {
  constexpr std::size_t most_points = 128;
  if (density.lattice.dimension != 3) return {density.lattice, {density.rho.begin(), density.rho.end()}};
  const DensityGrid thin = thinned(density, most_points);
  return {thin.lattice, {thin.rho.begin(), thin.rho.end()}};
}

void KeptDensities::keep(bool error, std::size_t output, const DensityGrid& density) {
  lattice = density.lattice;
  Kept kept = kept_of(density);
  const std::size_t bytes = kept.rho.size() * sizeof(float);
  if (bytes > most_bytes_ - bytes_) return;
  if (kept_.insert_or_assign({error, output}, std::move(kept)).second) bytes_ += bytes;
}

DensityGrid KeptDensities::get(bool error, std::size_t output, double time) {
  const auto widened = [](const Kept& kept) { return DensityGrid{kept.lattice, {kept.rho.begin(), kept.rho.end()}}; };
  const auto there = kept_.find({error, output});
  return widened(there != kept_.end() ? there->second : kept_of(read_back(error, output, time)));
}

DensityGrid KeptDensities::read_back(bool error, std::size_t output, double time) {
  const std::string_view series = write::density_output().about.name;
  if (!files_) files_ = read::written_outputs(folder_, series);
  // A file of another time was left by an earlier part of the run that had other outputs.
  const auto file = std::find_if(files_->begin(), files_->end(), [&](const read::WrittenOutput& written) {
    return written.number == output && written.time == time;
  });
  if (file == files_->end())
    throw FileError(fmt::format("{} has no file of t = {:g} (output.vtk)", (folder_ / series).string(), time));
  DensityGrid density = read::read_density(file->file, error ? "error" : "rho");
  if (density.lattice.points != lattice.points)
    throw FileError(fmt::format("the grid of {} is not that of the run", file->file.string()));
  density.lattice = lattice;  // coordinates of files are rounded
  return density;
}

}  // namespace gaussdrift::render
