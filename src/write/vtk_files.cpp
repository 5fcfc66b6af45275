// The VTK side of the ParaView files: arrays inline in base64, no compression, 64-bit headers. Appended raw data would
// be ten times as fast to write (10^6 particles: 0.06 s against 0.7 s) and a quarter smaller. But ParaView 5.11 with
// the expat of Debian 12 cannot read appended data: it goes on parsing behind <AppendedData>.
#include "write/vtk_files.hpp"

#include <fmt/format.h>
#include <vtkCallbackCommand.h>
#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkErrorCode.h>
#include <vtkExecutive.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkLongArray.h>
#include <vtkLongLongArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkTypeInt64Array.h>
#include <vtkXMLImageDataWriter.h>
#include <vtkXMLPolyDataWriter.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <new>
#include <numeric>
#include <string_view>
#include <type_traits>

#include "base/seam.hpp"
#include "gaussdrift/error.hpp"
#include "write/atomic_file.hpp"

namespace gaussdrift::write {
namespace {

namespace fs = std::filesystem;

using Int64Array = std::conditional_t<std::is_same_v<std::int64_t, long>, vtkLongArray, vtkLongLongArray>;

/// A VTK array that looks at `values` without copying; VTK only reads them.
template <class Array, class Value>
vtkNew<Array> borrowed(const char* name, const std::vector<Value>& values, int components = 1) {
  vtkNew<Array> array;
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetArray(const_cast<Value*>(values.data()), static_cast<vtkIdType>(values.size()), /*save=*/1);
  return array;
}

/// ParaView's name for the time that a file belongs to.
void set_time(vtkDataSet* data, double time) {
  vtkNew<vtkDoubleArray> value;
  value->SetName("TimeValue");
  value->InsertNextValue(time);
  data->GetFieldData()->AddArray(value);
}

/// Keeps VTK's messages off the terminal: they become part of the exception.
void collect_errors(vtkObject* source, std::string& messages) {
  vtkNew<vtkCallbackCommand> collect;
  collect->SetClientData(&messages);
  collect->SetCallback([](vtkObject*, unsigned long, void* list, void* text) {
    *static_cast<std::string*>(list) += static_cast<const char*>(text);
  });
  source->AddObserver("ErrorEvent", collect);
  source->AddObserver("WarningEvent", collect);
}

/// The writer tells its progress for every piece of some tens of kilobytes. VTK asks nobody whether to go on, so the way
/// out of it is an exception; the writer and what it made are not used again.
void make_seams(vtkObject* writer) {
  vtkNew<vtkCallbackCommand> look;
  look->SetCallback([](vtkObject*, unsigned long, void*, void*) { base::seam(); });
  writer->AddObserver("ProgressEvent", look);
}

// VTK writes into memory and the file is written in one piece: its writers are not safe on a disk that fills up.
template <class Writer>
std::string text_of(const fs::path& file, vtkDataSet* data) {
  std::string messages;
  vtkNew<Writer> writer;
  collect_errors(writer, messages);
  collect_errors(writer->GetExecutive(), messages);
  make_seams(writer);
  writer->WriteToOutputStringOn();
  writer->SetInputData(data);
  writer->SetDataModeToBinary();
  writer->SetCompressorTypeToNone();
  writer->SetHeaderTypeToUInt64();
  if (writer->Write() != 1 || writer->GetErrorCode() != vtkErrorCode::NoError) {
    // Nothing is on a disk yet: what was full is the memory.
    if (writer->GetErrorCode() == ENOMEM || writer->GetErrorCode() == vtkErrorCode::OutOfDiskSpaceError ||
        messages.find("llocat") != std::string::npos)
      throw std::bad_alloc();
    throw FileError(fmt::format("cannot write {}: {} {}", file.string(),
                                vtkErrorCode::GetStringFromErrorCode(writer->GetErrorCode()), messages));
  }
  return writer->GetOutputString();
}

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

/// ParaView knows vectors by their three components.
int file_components(int components) { return components == 2 ? 3 : components; }

std::vector<double> with_zeros(const std::vector<double>& pairs) {
  std::vector<double> triples(pairs.size() / 2 * 3, 0.0);
  for (std::size_t j = 0; 2 * j < pairs.size(); ++j) std::copy_n(&pairs[2 * j], 2, &triples[3 * j]);
  return triples;
}

/// The points of a box of a lattice, and the time.
vtkNew<vtkImageData> image_of(const Lattice& lattice, const LatticeBox& box, double time) {
  vtkNew<vtkImageData> image;
  std::array<int, 6> extent{};
  for (std::size_t k = 0; k < 3; ++k)
    extent[2 * k] = static_cast<int>(box.first[k]), extent[2 * k + 1] = static_cast<int>(box.end(k)) - 1;
  image->SetExtent(extent.data());
  image->SetOrigin(lattice.origin[0], lattice.origin[1], lattice.origin[2]);
  image->SetSpacing(lattice.spacing, lattice.spacing, lattice.spacing);
  set_time(image, time);
  return image;
}

/// Adds the fields to the image; `padded` holds what they are written from.
void add_fields(const fs::path& file, const std::vector<FieldOnGrid>& fields, std::size_t points, vtkImageData* image,
                std::vector<std::vector<double>>& padded) {
  padded.reserve(fields.size());
  for (const FieldOnGrid& field : fields) {
    check_size(file, field.name, field.values.size(), points * static_cast<std::size_t>(field.components));
    const std::vector<double>& values =
        field.components == 2 ? padded.emplace_back(with_zeros(field.values)) : field.values;
    const vtkNew<vtkDoubleArray> array =
        borrowed<vtkDoubleArray>(field.name.c_str(), values, file_components(field.components));
    image->GetPointData()->AddArray(array);
  }
}

/// Values at the points of a box of the lattice.
std::string box_text(const fs::path& file, const Lattice& lattice, const LatticeBox& box,
                     const std::vector<double>& rho, const std::vector<double>* exact,
                     const std::vector<FieldOnGrid>& fields, double time) {
  check_size(file, "rho", rho.size(), box.size());
  const vtkNew<vtkImageData> image = image_of(lattice, box, time);
  image->GetPointData()->SetScalars(borrowed<vtkDoubleArray>("rho", rho));
  std::vector<double> error;
  if (exact) {
    check_size(file, "rho_exact", exact->size(), box.size());
    error.reserve(box.size());
    for (std::size_t i = 0; i < box.size(); ++i) error.push_back(rho[i] - (*exact)[i]);
    image->GetPointData()->AddArray(borrowed<vtkDoubleArray>("rho_exact", *exact));
    image->GetPointData()->AddArray(borrowed<vtkDoubleArray>("error", error));
  }
  std::vector<std::vector<double>> padded;
  add_fields(file, fields, box.size(), image, padded);
  return text_of<vtkXMLImageDataWriter>(file, image);
}

std::string extent_text(const LatticeBox& box) {
  std::string text;
  for (std::size_t k = 0; k < 3; ++k) text += fmt::format("{}{} {}", k == 0 ? "" : " ", box.first[k], box.end(k) - 1);
  return text;
}

}  // namespace

std::string density_text(const fs::path& file, const DensityGrid& density, double time,
                         const std::vector<double>* exact) {
  return box_text(file, density.lattice, {{}, density.lattice.points}, density.rho, exact, density.fields, time);
}

std::string fields_text(const fs::path& file, const Lattice& lattice, const std::vector<FieldOnGrid>& fields,
                        double time) {
  const vtkNew<vtkImageData> image = image_of(lattice, {{}, lattice.points}, time);
  std::vector<std::vector<double>> padded;
  add_fields(file, fields, lattice.size(), image, padded);
  return text_of<vtkXMLImageDataWriter>(file, image);
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
    text += fmt::format("      <PDataArray type=\"Float64\" Name=\"{}\"{}/>\n", name,
                        components > 1 ? " NumberOfComponents=\"3\"" : "");
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
                          double time) {
  const auto count = static_cast<vtkIdType>(particles.size());
  const int dimension = particles.dimension;
  check_size(file, "id", particles.id.size(), particles.size());
  check_size(file, "velocity", velocity.size(), particles.size() * static_cast<std::size_t>(dimension));

  vtkNew<vtkDoubleArray> positions, u;
  u->SetName("u");
  for (auto* array : {positions.Get(), u.Get()}) {
    array->SetNumberOfComponents(3);
    array->SetNumberOfTuples(count);
  }
  double* x = positions->GetPointer(0);
  double* v = u->GetPointer(0);
  for (std::size_t j = 0; j < particles.size(); ++j) {
    for (int k = 0; k < 3; ++k) {
      *x++ = k < dimension ? particles.position[k][j] : 0;
      *v++ = k < dimension ? velocity[j * static_cast<std::size_t>(dimension) + static_cast<std::size_t>(k)] : 0;
    }
  }
  vtkNew<vtkPoints> points;
  points->SetData(positions);

  // One vertex cell a particle, not one for all: then thresholds and selections in ParaView take single particles.
  vtkNew<vtkTypeInt64Array> offsets, connectivity;
  offsets->SetNumberOfValues(count + 1);
  connectivity->SetNumberOfValues(count);
  std::iota(offsets->GetPointer(0), offsets->GetPointer(0) + count + 1, 0);
  std::iota(connectivity->GetPointer(0), connectivity->GetPointer(0) + count, 0);
  vtkNew<vtkCellArray> vertices;
  vertices->SetData(offsets, connectivity);

  vtkNew<vtkPolyData> cloud;
  cloud->SetPoints(points);
  cloud->SetVerts(vertices);
  cloud->GetPointData()->AddArray(borrowed<Int64Array>("id", particles.id));
  cloud->GetPointData()->SetScalars(borrowed<vtkDoubleArray>("alpha", particles.alpha));
  cloud->GetPointData()->SetVectors(u);
  set_time(cloud, time);
  return text_of<vtkXMLPolyDataWriter>(file, cloud);
}

void write_particles(const fs::path& file, const Particles& particles, const std::vector<double>& velocity,
                     double time) {
  write_text(file, particle_text(file, particles, velocity, time));
}

std::string particle_index_text(const std::vector<std::string>& files) {
  std::string text =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"PPolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
      "  <PPolyData GhostLevel=\"0\">\n"
      "    <PPointData Scalars=\"alpha\" Vectors=\"u\">\n"
      "      <PDataArray type=\"Int64\" Name=\"id\"/>\n"
      "      <PDataArray type=\"Float64\" Name=\"alpha\"/>\n"
      "      <PDataArray type=\"Float64\" Name=\"u\" NumberOfComponents=\"3\"/>\n"
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
