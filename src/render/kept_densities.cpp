#include "render/kept_densities.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <system_error>

#include "gaussdrift/error.hpp"
#include "render/solid.hpp"
#include "write/atomic_file.hpp"
#include "write/checkpoint.hpp"
#include "write/output_files.hpp"

namespace gaussdrift::render {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t most_points_in_space = 128;  // along an axis, in space

Lattice kept_lattice(const Lattice& lattice) {
  return lattice.dimension == 3 ? thinned_lattice(lattice, most_points_in_space) : lattice;
}

std::uint64_t sum_of(double time, const std::vector<float>& rho) {
  const uLong of_time = crc32_z(crc32_z(0, nullptr, 0), reinterpret_cast<const Bytef*>(&time), sizeof time);
  return crc32_z(of_time, reinterpret_cast<const Bytef*>(rho.data()), rho.size() * sizeof(float));
}

}  // namespace

// Single precision is plenty for colours and halves what a long run keeps; in space thinned, for the same reason.
KeptDensities::Kept KeptDensities::kept_of(const DensityGrid& density) {
  if (density.lattice.dimension != 3) return {density.lattice, {density.rho.begin(), density.rho.end()}};
  const DensityGrid thin = thinned(density, most_points_in_space);
  return {thin.lattice, {thin.rho.begin(), thin.rho.end()}};
}

void KeptDensities::keep(bool error, std::size_t output, double time, const DensityGrid& density) {
  lattice = density.lattice;
  Kept kept = kept_of(density);
  if (!run_writes_densities_) write_file(error, output, time, kept);
  const std::size_t bytes = kept.rho.size() * sizeof(float);
  if (bytes > most_bytes_ - bytes_) return;
  if (kept_.insert_or_assign({error, output}, std::move(kept)).second) bytes_ += bytes;
}

DensityGrid KeptDensities::get(bool error, std::size_t output, double time) {
  const auto widened = [](const Kept& kept) { return DensityGrid{kept.lattice, {kept.rho.begin(), kept.rho.end()}}; };
  if (const auto there = kept_.find({error, output}); there != kept_.end()) return widened(there->second);
  if (const auto kept = tracer_.empty() ? read_file(error, output, time) : std::nullopt) return widened(*kept);
  return widened(kept_of(read_back(error, output, time)));
}

fs::path KeptDensities::file_of(bool error, std::size_t output) const {
  return folder_ / write::checkpoints_folder / "pictures" /
         fmt::format("{}_{:04}.raw", error ? "error" : "density", output);
}

// The time, the values, and a check sum of both.
void KeptDensities::write_file(bool error, std::size_t output, double time, const Kept& kept) const {
  write::write_atomically(file_of(error, output), [&](std::FILE* file) {
    const std::uint64_t sum = sum_of(time, kept.rho);
    const bool written = std::fwrite(&time, sizeof time, 1, file) == 1 &&
                         std::fwrite(kept.rho.data(), sizeof(float), kept.rho.size(), file) == kept.rho.size() &&
                         std::fwrite(&sum, sizeof sum, 1, file) == 1;
    if (!written) throw std::system_error(errno, std::generic_category());
  });
}

std::optional<KeptDensities::Kept> KeptDensities::read_file(bool error, std::size_t output, double time) const {
  const fs::path name = file_of(error, output);
  std::error_code problem;
  Kept kept{kept_lattice(lattice), {}};
  const std::uintmax_t bytes = sizeof time + kept.lattice.size() * sizeof(float) + sizeof(std::uint64_t);
  if (!fs::is_regular_file(fs::symlink_status(name, problem)) || fs::file_size(name, problem) != bytes)
    return std::nullopt;
  std::ifstream in(name, std::ios::binary);
  double written_at = 0;
  std::uint64_t sum = 0;
  kept.rho.resize(kept.lattice.size());
  const auto read = [&](void* data, std::size_t size) {
    in.read(static_cast<char*>(data), static_cast<std::streamsize>(size));
  };
  read(&written_at, sizeof written_at);
  read(kept.rho.data(), kept.rho.size() * sizeof(float));
  read(&sum, sizeof sum);
  // A file of another time was left by an earlier part of the run that had other outputs.
  if (!in || written_at != time || sum != sum_of(time, kept.rho)) return std::nullopt;
  return kept;
}

void KeptDensities::remove_files(std::size_t outputs) const {
  if (!write::checkpoint_files(folder_).empty()) return;
  std::error_code ignored;
  for (std::size_t output = 0; output < outputs; ++output)
    for (const bool error : {false, true}) fs::remove(file_of(error, output), ignored);
  const fs::path folder = file_of(false, 0).parent_path();
  fs::remove(folder, ignored);  // if it is empty
  fs::remove(folder.parent_path(), ignored);
}

fs::path KeptDensities::density_file(std::size_t output, double time) {
  const std::string_view series = write::density_output().about.name;
  if (!files_) files_ = read::written_outputs(folder_, series);
  // A file of another time was left by an earlier part of the run that had other outputs.
  const auto file = std::find_if(files_->begin(), files_->end(), [&](const read::WrittenOutput& written) {
    return written.number == output && written.time == time;
  });
  if (file == files_->end())
    throw FileError(fmt::format("{} has no file of t = {:g} (output.vtk)", (folder_ / series).string(), time));
  return file->file;
}

DensityGrid KeptDensities::read_back(bool error, std::size_t output, double time) {
  const fs::path file = density_file(output, time);
  DensityGrid density = read::read_density(file, error ? "error" : tracer_.empty() ? "rho" : tracer_);
  if (density.lattice.points != lattice.points)
    throw FileError(fmt::format("the grid of {} is not that of the run", file.string()));
  density.lattice = lattice;  // coordinates of files are rounded
  return density;
}

FieldOnGrid KeptDensities::field(std::string_view name, std::size_t output, double time) {
  return read::read_vector(density_file(output, time), std::string(name));
}

}  // namespace gaussdrift::render
