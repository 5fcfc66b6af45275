// ParaView files as VTK's own writer (9.1) lays them out: arrays inline in base64, no compression, 64-bit headers.
// Appended raw data would be a quarter smaller. But ParaView 5.11 with the expat of Debian 12 cannot read appended data:
// it goes on parsing behind <AppendedData>.
#include "write/vtk_files.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <string_view>

#include "gaussdrift/error.hpp"
#include "write/atomic_file.hpp"
#include "write/draining.hpp"
#include "write/output_files.hpp"
#include "write/vtk_array.hpp"

namespace gaussdrift::write {
namespace {

namespace fs = std::filesystem;

std::string escaped(std::string_view text) {
  std::string xml;
  for (const char c : text) {
    switch (c) {
      case '&':
        xml += "&amp;";
        break;
      case '<':
        xml += "&lt;";
        break;
      case '>':
        xml += "&gt;";
        break;
      case '"':
        xml += "&quot;";
        break;
      default:
        xml += c;
    }
  }
  return xml;
}

void check_size(const fs::path& file, std::string_view what, std::size_t is, std::size_t should_be) {
  if (is != should_be)
    throw Error(ExitCode::internal,
                fmt::format("{}: {} has {} values, must have {}", file.string(), what, is, should_be));
}

std::string extent_text(const LatticeBox& box) {
  std::string text;
  for (std::size_t k = 0; k < 3; ++k) text += fmt::format("{}{} {}", k == 0 ? "" : " ", box.first[k], box.end(k) - 1);
  return text;
}

constexpr std::size_t around_arrays = 4000;  // bytes

std::string beginning(const char* type, std::size_t numbers) {
  std::string text;
  text.reserve(static_cast<std::size_t>(bytes_as_text(static_cast<double>(numbers))) + around_arrays);
  text += fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"{}\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n",
      type);
  return text;
}

/// ParaView's name for the time that a file belongs to. Where places are longitudes and latitudes in degrees, the radius
/// of their sphere says so.
void add_time(std::string& text, double time, double sphere) {
  text += "    <FieldData>\n";
  add_array(text, {6, "TimeValue", " NumberOfTuples=\"1\""}, 1, [&](std::size_t) { return time; });
  if (sphere > 0)
    add_array(text, {6, "sphere_radius", " NumberOfTuples=\"1\""}, 1, [&](std::size_t) { return sphere; });
  text += "    </FieldData>\n";
}

/// Where the points of an image are.
std::string image_tag(const std::string& extent, const std::array<double, 3>& origin,
                      const std::array<double, 3>& spacing) {
  return fmt::format(
      "  <ImageData WholeExtent=\"{}\" Origin=\"{} {} {}\" Spacing=\"{} {} {}\" "
      "Direction=\"1 0 0 0 1 0 0 0 1\">\n",
      extent, shortest_text(origin[0]), shortest_text(origin[1]), shortest_text(origin[2]), shortest_text(spacing[0]),
      shortest_text(spacing[1]), shortest_text(spacing[2]));
}

std::string piece_tag(const std::string& extent, const char* attributes) {
  return fmt::format("  <Piece Extent=\"{}\">\n    <PointData{}>\n", extent, attributes);
}

/// Image data at the points of a box of a lattice, up to its arrays. `numbers`: of all arrays.
std::string beginning_of_image(const Lattice& lattice, const LatticeBox& box, double time, std::size_t numbers,
                               const char* attributes) {
  std::string text = beginning("ImageData", numbers);
  const std::string extent = extent_text(box);
  text += image_tag(extent, lattice.origin, {lattice.spacing, lattice.spacing, lattice.spacing});
  add_time(text, time, lattice.sphere);
  text += piece_tag(extent, attributes);
  return text;
}

constexpr const char* end_of_image =
    "    </PointData>\n    <CellData>\n    </CellData>\n  </Piece>\n  </ImageData>\n</VTKFile>\n";

/// ParaView knows vectors by their three components, and matrices by their nine.
std::size_t file_components(int components) { return components == 1 ? 1 : components <= 3 ? 3 : 9; }

std::string components_text(int components) {
  return components == 1 ? "" : fmt::format(" NumberOfComponents=\"{}\"", file_components(components));
}

std::size_t numbers_in(const std::vector<FieldOnGrid>& fields, std::size_t points) {
  std::size_t numbers = 0;
  for (const FieldOnGrid& field : fields) numbers += points * file_components(field.components);
  return numbers;
}

/// Rows of a matrix of d x d numbers, filled up with 0 to three.
std::array<double, 9> matrix_of(const double* values, std::size_t components) {
  const std::size_t d = components == 4 ? 2 : 3;
  std::array<double, 9> matrix{};
  for (std::size_t i = 0; i < d; ++i)
    for (std::size_t k = 0; k < d; ++k) matrix[3 * i + k] = values[i * d + k];
  return matrix;
}

void add_fields(std::string& text, const fs::path& file, const std::vector<FieldOnGrid>& fields, std::size_t points,
                std::size_t indent = 6) {
  for (const FieldOnGrid& field : fields) {
    const auto components = static_cast<std::size_t>(field.components);
    check_size(file, field.name, field.values.size(), points * components);
    if (components == 1) {
      add_array(text, {indent, field.name}, points, [&](std::size_t i) { return field.values[i]; });
      continue;
    }
    if (components > 3) {
      add_vectors(text, {indent, field.name}, points,
                  [&](std::size_t i) { return matrix_of(field.values.data() + i * components, components); });
      continue;
    }
    add_vectors(text, {indent, field.name}, points, [&](std::size_t i) {
      std::array<double, 3> vector{};
      for (std::size_t k = 0; k < components; ++k) vector[k] = field.values[i * components + k];
      return vector;
    });
  }
}

/// Values at the points of a box of the lattice.
std::string box_text(const fs::path& file, const Lattice& lattice, const LatticeBox& box,
                     const std::vector<double>& rho, const std::vector<double>* exact,
                     const std::vector<FieldOnGrid>& fields, double time) {
  check_size(file, "rho", rho.size(), box.size());
  if (exact) check_size(file, "rho_exact", exact->size(), box.size());
  std::string text = beginning_of_image(
      lattice, box, time, rho.size() * (exact ? 3 : 1) + numbers_in(fields, rho.size()), " Scalars=\"rho\"");
  add_array(text, {6, "rho"}, rho.size(), [&](std::size_t i) { return rho[i]; });
  if (exact) {
    add_array(text, {6, "rho_exact"}, rho.size(), [&](std::size_t i) { return (*exact)[i]; });
    add_array(text, {6, "error"}, rho.size(), [&](std::size_t i) { return rho[i] - (*exact)[i]; });
  }
  add_fields(text, file, fields, rho.size());
  text += end_of_image;
  return text;
}

/// Cells of points 0, 1, 2, ... in their order.
void add_cells(std::string& text, const char* kind, std::size_t count) {
  text += fmt::format("      <{}>\n", kind);
  add_array(text, {8, "connectivity"}, count, [](std::size_t j) { return static_cast<std::int64_t>(j); });
  add_array(text, {8, "offsets"}, count, [](std::size_t j) { return static_cast<std::int64_t>(j + 1); });
  text += fmt::format("      </{}>\n", kind);
}

}  // namespace

std::string density_text(const fs::path& file, const DensityGrid& density, double time,
                         const std::vector<double>* exact) {
  return box_text(file, density.lattice, {{}, density.lattice.points}, density.rho, exact, density.fields, time);
}

std::string fields_text(const fs::path& file, const Lattice& lattice, const std::vector<FieldOnGrid>& fields,
                        double time) {
  const LatticeBox all{{}, lattice.points};
  std::string text = beginning_of_image(lattice, all, time, numbers_in(fields, all.size()), "");
  add_fields(text, file, fields, all.size());
  text += end_of_image;
  return text;
}

void write_image(std::FILE* file, const Image& image, const std::vector<ImageArray>& arrays) {
  Draining out(file);
  const LatticeBox all{{}, image.points};
  const std::string extent = extent_text(all);
  out.text = beginning("ImageData", 0) + image_tag(extent, image.origin, image.spacing) + piece_tag(extent, "");
  for (const auto& [name, values] : arrays) {
    const ArrayHeading heading{6, name};
    ValueRange range;
    for (std::size_t i = 0; i < all.size(); ++i) range.add(values[i]);
    begin_array(out.text, heading, "Float64", range);
    Base64Numbers numbers(out.text, all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      numbers.put(values[i]);
      out.some();
    }
    numbers.end();
    end_array(out.text, heading, nullptr);
  }
  out.text += end_of_image;
  out.all();
  flush(file);
}

std::string density_piece_text(const fs::path& file, const Frame& frame, const DensityPiece& piece) {
  return box_text(file, *frame.lattice, piece.box, *piece.rho, piece.exact,
                  piece.fields ? *piece.fields : std::vector<FieldOnGrid>(), frame.time);
}

std::string density_index_text(const Frame& frame, const std::vector<std::string>& files) {
  const Lattice& lattice = *frame.lattice;
  // As VTK's writer has it in the pieces: numbers that give the same double.
  std::string text = fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"PImageData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
      "  <PImageData WholeExtent=\"{}\" GhostLevel=\"0\" Origin=\"{:.17g} {:.17g} {:.17g}\" "
      "Spacing=\"{:.17g} {:.17g} {:.17g}\">\n"
      "    <PPointData Scalars=\"rho\">\n      <PDataArray type=\"Float64\" Name=\"rho\"/>\n",
      extent_text({{}, lattice.points}), lattice.origin[0], lattice.origin[1], lattice.origin[2], lattice.spacing,
      lattice.spacing, lattice.spacing);
  if (frame.pieces_have_exact)
    for (const char* name : {"rho_exact", "error"})
      text += fmt::format("      <PDataArray type=\"Float64\" Name=\"{}\"/>\n", name);
  for (const auto& [name, components] : frame.piece_fields)
    text += fmt::format("      <PDataArray type=\"Float64\" Name=\"{}\"{}/>\n", name, components_text(components));
  text += "    </PPointData>\n";
  for (std::size_t number = 0; number < files.size(); ++number)
    text += fmt::format("    <Piece Extent=\"{}\" Source=\"{}\"/>\n", extent_text(frame.pieces->shown(number)),
                        escaped(files[number]));
  return text + "  </PImageData>\n</VTKFile>\n";
}

void write_density(const fs::path& file, const DensityGrid& density, double time, const std::vector<double>* exact) {
  write_text(file, density_text(file, density, time, exact));
}

std::string particle_text(const fs::path& file, const Particles& particles, const std::vector<double>& velocity,
                          double time, const std::vector<FieldOnGrid>* fields, double sphere) {
  const std::size_t count = particles.size();
  const int dimension = particles.dimension;
  check_size(file, "id", particles.id.size(), count);
  check_size(file, "velocity", velocity.size(), count * static_cast<std::size_t>(dimension));

  std::string text = beginning("PolyData", 10 * count + (fields ? numbers_in(*fields, count) : 0));
  text += "  <PolyData>\n";
  add_time(text, time, sphere);
  text += fmt::format(
      "    <Piece NumberOfPoints=\"{0}\" NumberOfVerts=\"{0}\" NumberOfLines=\"0\" NumberOfStrips=\"0\" "
      "NumberOfPolys=\"0\">\n      <PointData Scalars=\"alpha\" Vectors=\"u\">\n",
      count);
  add_array(text, {8, "id"}, count, [&](std::size_t j) { return particles.id[j]; });
  add_array(text, {8, "alpha"}, count, [&](std::size_t j) { return particles.alpha[j]; });
  add_vectors(text, {8, "u"}, count, [&](std::size_t j) {
    std::array<double, 3> u{};
    for (int k = 0; k < dimension; ++k)
      u[static_cast<std::size_t>(k)] = velocity[j * static_cast<std::size_t>(dimension) + static_cast<std::size_t>(k)];
    return u;
  });
  if (fields) add_fields(text, file, *fields, count, 8);
  text += "      </PointData>\n      <CellData>\n      </CellData>\n      <Points>\n";
  add_vectors(text, {8, "Points"}, count, [&](std::size_t j) {
    std::array<double, 3> x{};
    for (int k = 0; k < dimension; ++k) x[static_cast<std::size_t>(k)] = particles.position[k][j];
    return x;
  });
  text += "      </Points>\n";
  // One vertex cell a particle, not one for all: then thresholds and selections in ParaView take single particles.
  add_cells(text, "Verts", count);
  for (const char* kind : {"Lines", "Strips", "Polys"}) add_cells(text, kind, 0);
  text += "    </Piece>\n  </PolyData>\n</VTKFile>\n";
  return text;
}

void write_particles(const fs::path& file, const Particles& particles, const std::vector<double>& velocity,
                     double time) {
  write_text(file, particle_text(file, particles, velocity, time));
}

std::string particle_index_text(const std::vector<std::string>& files, const std::vector<FieldOnGrid>* fields) {
  std::string text =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"PPolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
      "  <PPolyData GhostLevel=\"0\">\n"
      "    <PPointData Scalars=\"alpha\" Vectors=\"u\">\n"
      "      <PDataArray type=\"Int64\" Name=\"id\"/>\n"
      "      <PDataArray type=\"Float64\" Name=\"alpha\"/>\n"
      "      <PDataArray type=\"Float64\" Name=\"u\" NumberOfComponents=\"3\"/>\n";
  for (const FieldOnGrid& field : fields ? *fields : std::vector<FieldOnGrid>())
    text += fmt::format("      <PDataArray type=\"Float64\" Name=\"{}\"{}/>\n", field.name,
                        components_text(field.components));
  text +=
      "    </PPointData>\n"
      "    <PPoints>\n      <PDataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"/>\n    </PPoints>\n";
  for (const std::string& file : files) text += fmt::format("    <Piece Source=\"{}\"/>\n", escaped(file));
  return text + "  </PPolyData>\n</VTKFile>\n";
}

Collection::Collection(fs::path file) : file_(std::move(file)), text_(file_, "  </Collection>\n</VTKFile>\n") {}

std::string Collection::entry(double time, const fs::path& data) const {
  const fs::path folder = fs::absolute(file_).lexically_normal().parent_path();
  const std::string name = fs::absolute(data).lexically_normal().lexically_relative(folder).generic_string();
  return fmt::format("    <DataSet timestep=\"{:.17g}\" part=\"0\" file=\"{}\"/>\n", time, escaped(name));
}

void Collection::add(double time, const fs::path& data) {
  if (begun_)
    text_.append(entry(time, data));
  else
    begin({{time, data}});
}

void Collection::begin(const std::vector<std::pair<double, fs::path>>& entries) {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n  "
      "<Collection>\n";
  for (const auto& [time, data] : entries) text += entry(time, data);
  text_.begin(text);
  begun_ = true;
}

}  // namespace gaussdrift::write
