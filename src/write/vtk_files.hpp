// ParaView files: density as .vti, particles as .vtp, each with a .pvd that lists the times.
// Every file is written beside its name and renamed, so what is there is always whole. Arrays are Float64.
#pragma once

#include <array>
#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "gaussdrift/frame.hpp"
#include "write/growing_file.hpp"

namespace gaussdrift::write {

/// density/density_0000.vti: image data with the point array "rho" and TimeValue; where the exact density is known also
/// "rho_exact" and "error" = rho - rho_exact, NaN at points where it is not. Throws FileError.
void write_density(const std::filesystem::path& file, const DensityGrid& density, double time,
                   const std::vector<double>* exact = nullptr);

/// particles/particles_0000.vtp: points with id (Int64), alpha, u; vertex cells; TimeValue. Throws FileError.
/// velocity [j][dimension]; points and u are padded with 0 to three components.
void write_particles(const std::filesystem::path& file, const Particles& particles, const std::vector<double>& velocity,
                     double time);

/// The texts of these files; messages call them `file`.
std::string density_text(const std::filesystem::path& file, const DensityGrid& density, double time,
                         const std::vector<double>* exact = nullptr);
/// sphere: its radius, where places are longitudes and latitudes.
std::string particle_text(const std::filesystem::path& file, const Particles& particles,
                          const std::vector<double>& velocity, double time,
                          const std::vector<FieldOnGrid>* fields = nullptr, double sphere = 0);

/// Image data with the fields alone.
std::string fields_text(const std::filesystem::path& file, const Lattice& lattice,
                        const std::vector<FieldOnGrid>& fields, double time);

/// Points at equal distances on each axis, first axis fastest. Axes that there are not have one point.
struct Image {
  std::array<std::size_t, 3> points{1, 1, 1};
  std::array<double, 3> origin{}, spacing{1, 1, 1};
};
struct ImageArray {
  std::string name;  // letters that XML takes as they are
  const double* values;
};
/// Image data with these arrays, in little memory. Throws std::system_error.
void write_image(std::FILE* file, const Image& image, const std::vector<ImageArray>& arrays);

/// density/density_0000/0000.vti: the same of a piece; its extent is that within the whole grid.
std::string density_piece_text(const std::filesystem::path& file, const Frame& frame, const DensityPiece& piece);
/// density/density_0000.pvti: names the files of the pieces, as seen from its folder.
std::string density_index_text(const Frame& frame, const std::vector<std::string>& files);

/// particles/particles_0000.pvtp: the same of particles, each of which is a particle_text().
std::string particle_index_text(const std::vector<std::string>& files,
                                const std::vector<FieldOnGrid>* fields = nullptr);

/// A ParaView collection, whole after every call. Data are named relative to the folder of the .pvd. Throws FileError.
class Collection {
 public:
  explicit Collection(std::filesystem::path file);
  void add(double time, const std::filesystem::path& data);
  /// Begins the .pvd anew with these entries; not none.
  void begin(const std::vector<std::pair<double, std::filesystem::path>>& entries);

 private:
  std::string entry(double time, const std::filesystem::path& data) const;

  std::filesystem::path file_;
  GrowingFile text_;
  bool begun_ = false;
};

}  // namespace gaussdrift::write
