// The catalogue of files for ParaView. A kind is one object: its name and meaning, what it needs of a run, what it holds,
// how large it gets. To add one: its file, its line in output_files.cpp, its line in CMakeLists.txt.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/catalogue.hpp"
#include "gaussdrift/case.hpp"
#include "gaussdrift/frame.hpp"

namespace gaussdrift::write {

/// The numbers that decide how large the files of an output are.
struct Extent {
  double lattice_points = 0;  // looked at for particles
  double particles = 0;       // carried, with those that effects add
  double grid_points = 0;
  bool compared_everywhere = false;  // with the exact density
  double field_numbers = 0;          // of output.fields, a grid point
  double particle_numbers = 0;       // of output.fields, a particle
  double pieces = 1;                 // of the grid
  double particle_pieces = 1;
};

struct FileKind {
  OutputFile about;
  std::string_view ending;  // ".vti"
  /// All that the file of an output holds; messages call it `file`. Of the frame it may take what `about` says.
  std::string (*text)(const std::filesystem::path& file, const Frame& frame) = nullptr;
  /// Where the density comes in pieces: the file of one. Null: there is one file of the density always.
  std::string (*piece)(const std::filesystem::path& file, const Frame& frame, const DensityPiece& piece) = nullptr;
  /// Where particles do.
  std::string (*particle_piece)(const std::filesystem::path& file, const Frame& frame,
                                const ParticlePiece& piece) = nullptr;
  /// Names the files of all pieces.
  std::string (*index)(const Frame& frame, const std::vector<std::string>& files) = nullptr;
  std::string_view index_ending = {};                // ".pvti"
  double (*bytes)(const Extent& extent) = nullptr;   // of the files of one output
  double (*memory)(const Extent& extent) = nullptr;  // bytes held at most while it is made, beside the frame
  /// What view.py does after ParaView has read the files into `NAME`, where they are what is looked at.
  std::string (*view)(int dimension) = nullptr;
};

/// In the order of docs/cases.md.
const std::vector<FileKind>& output_files();

/// Throws std::out_of_range if no kind is called so.
const FileKind& find_output_file(std::string_view name);

/// The first kind that shows the density: pictures of a finished run are drawn from its files.
const FileKind& density_output();

/// Bytes that numbers take as text in a ParaView file: four letters for three bytes.
constexpr double bytes_as_text(double numbers) { return 4. / 3 * 8 * numbers; }

/// Files of the first outputs of a run that are not there, pieces among them, as seen from its folder.
std::vector<std::string> missing_files(const FileKind& kind, const std::filesystem::path& folder, std::size_t outputs);

/// Writes NAME.pvd and NAME/NAME_0000.vti, ...; where density or particles come in pieces NAME/NAME_0000.pvti, ... and
/// NAME/NAME_0000/0000.vti, ...
std::unique_ptr<Observer> file_series(const FileKind& kind, const std::filesystem::path& folder);

}  // namespace gaussdrift::write

template <>
std::vector<gaussdrift::write::FileKind>& gaussdrift::base::catalogue<gaussdrift::write::FileKind>();
