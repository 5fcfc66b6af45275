#include "write/output_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "base/text_file.hpp"
#include "gaussdrift/error.hpp"
#include "write/atomic_file.hpp"
#include "write/vtk_files.hpp"

namespace gaussdrift::write {

// Each in a file of its name.
FileKind density_files();
FileKind particle_files();

}  // namespace gaussdrift::write

template <>
std::vector<gaussdrift::write::FileKind>& gaussdrift::base::catalogue<gaussdrift::write::FileKind>() {
  using namespace gaussdrift::write;
  static std::vector<FileKind> all{density_files(), particle_files()};
  return all;
}

namespace gaussdrift::write {

namespace fs = std::filesystem;

namespace {

/// "density/density_0012.vti", as seen from the folder of the run; `ending` may be "/".
std::string name_of_output(const FileKind& kind, std::size_t index, std::string_view ending) {
  return fmt::format("{0}/{0}_{1:04}{2}", kind.about.name, index, ending);
}

/// As the index of an output names it: "density_0012/0003.vti".
std::string name_of_piece(const FileKind& kind, std::size_t index, std::size_t number) {
  return fmt::format("{}_{:04}/{:04}{}", kind.about.name, index, number, kind.ending);
}

/// Pieces that an index names; none if it cannot be read.
std::size_t pieces_in(const fs::path& index) {
  constexpr std::size_t most_bytes = 40'000'000;
  std::size_t count = 0;
  try {
    const std::string text = base::read_text_file(index, "a list of pieces", most_bytes);
    for (std::size_t at = text.find("<Piece "); at != text.npos; at = text.find("<Piece ", at + 1)) ++count;
  } catch (const Error&) {
    return 0;
  }
  return count;
}

class FileSeries : public Observer {
 public:
  FileSeries(const FileKind& kind, const fs::path& folder)
      : kind_(kind), folder_(folder), collection_(folder / fmt::format("{}.pvd", kind.about.name)) {}
  std::string name() const override { return fmt::format("write {}", kind_.about.name); }
  bool needs_particles(double /*time*/) const override { return kind_.about.needs_velocity; }
  void piece(const Frame& frame, const DensityPiece& piece) override {
    if (!kind_.piece) return;
    const fs::path file = piece_of(frame, piece.number);
    write_text(file, kind_.piece(file, frame, piece));
  }
  bool takes_particle_pieces() const override { return kind_.particle_piece; }
  void particle_piece(const Frame& frame, const ParticlePiece& piece) override {
    if (!kind_.particle_piece) return;
    const fs::path file = piece_of(frame, piece.number);
    write_text(file, kind_.particle_piece(file, frame, piece));
  }
  void frame(const Frame& frame) override {
    const auto index = static_cast<std::size_t>(frame.index);
    const std::size_t count = pieces_of(frame);
    const fs::path file = count > 1 ? index_of(index) : file_of(index);
    if (count > 1) {
      std::vector<std::string> pieces;
      for (std::size_t number = 0; number < count; ++number) pieces.push_back(piece_name(frame, number));
      write_text(file, kind_.index(frame, pieces));
    } else {
      write_text(file, kind_.text(file, frame));
    }
    collection_.add(frame.time, file);
  }
  void restore(const std::vector<std::pair<double, FrameNumbers>>& frames, const std::string& /*state*/) override {
    std::vector<std::pair<double, fs::path>> entries;
    for (const auto& [time, numbers] : frames) {
      const fs::path index = index_of(entries.size());
      entries.emplace_back(time, kind_.index && fs::exists(index) ? index : file_of(entries.size()));
    }
    if (!entries.empty()) collection_.begin(entries);
  }

 private:
  std::size_t pieces_of(const Frame& frame) const {
    if (kind_.particle_piece) return frame.particle_pieces;
    return kind_.piece && frame.pieces ? frame.pieces->count() : 1;
  }
  fs::path file_of(std::size_t index) const { return folder_ / name_of_output(kind_, index, kind_.ending); }
  fs::path index_of(std::size_t index) const { return folder_ / name_of_output(kind_, index, kind_.index_ending); }
  std::string piece_name(const Frame& frame, std::size_t number) const {
    return name_of_piece(kind_, static_cast<std::size_t>(frame.index), number);
  }
  fs::path piece_of(const Frame& frame, std::size_t number) const {
    return folder_ / kind_.about.name / piece_name(frame, number);
  }

  const FileKind kind_;
  const fs::path folder_;
  Collection collection_;
};

}  // namespace

const std::vector<FileKind>& output_files() { return base::catalogue<FileKind>(); }

const FileKind& find_output_file(std::string_view name) {
  return base::find_named(output_files(), "kind of output files", name);
}

const FileKind& density_output() {
  const auto found = std::find_if(output_files().begin(), output_files().end(),
                                  [](const FileKind& kind) { return kind.about.shows_density; });
  if (found == output_files().end()) throw std::logic_error("no output file shows the density");
  return *found;
}

std::vector<std::string> missing_files(const FileKind& kind, const fs::path& folder, std::size_t outputs) {
  std::vector<std::string> missing;
  for (std::size_t index = 0; index < outputs; ++index) {
    const std::string whole = name_of_output(kind, index, kind.ending),
                      list = name_of_output(kind, index, kind.index_ending);
    if (fs::exists(folder / whole)) continue;
    if (!kind.index || !fs::exists(folder / list)) {
      const bool in_pieces = kind.index && fs::exists(folder / name_of_output(kind, index, "/"));
      missing.push_back(in_pieces ? list : whole);
      continue;
    }
    for (std::size_t number = 0, count = pieces_in(folder / list); number < count; ++number)
      if (std::string piece = fmt::format("{}/{}", kind.about.name, name_of_piece(kind, index, number));
          !fs::exists(folder / piece))
        missing.push_back(std::move(piece));
  }
  return missing;
}

std::unique_ptr<Observer> file_series(const FileKind& kind, const fs::path& folder) {
  return std::make_unique<FileSeries>(kind, folder);
}

}  // namespace gaussdrift::write
