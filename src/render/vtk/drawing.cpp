// The drawing library: its one function, and what it does besides scenes.
#include "render/drawing.hpp"

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkFlyingEdges2D.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkPNGReader.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkStripper.h>
#include <vtkVersion.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include "render/vtk/osmesa_window.hpp"
#include "render/vtk/scene.hpp"
#include "render/vtk/text.hpp"

namespace gaussdrift::render {
namespace {

class SilentWindow : public vtkOutputWindow {
 public:
  static SilentWindow* New() { VTK_STANDARD_NEW_BODY(SilentWindow); }
  void DisplayText(const char* /*text*/) override {}
};

/// The values themselves, not copied.
vtkNew<vtkImageData> image_of(const Field& field) {
  const auto [nx, ny, nz] = field.points;
  vtkNew<vtkImageData> image;
  image->SetDimensions(static_cast<int>(nx), static_cast<int>(ny), static_cast<int>(nz));
  image->SetSpacing(field.spacing.data());
  vtkNew<vtkFloatArray> values;
  values->SetArray(const_cast<float*>(field.values), static_cast<vtkIdType>(nx * ny * nz), /*save=*/1);
  image->GetPointData()->SetScalars(values);
  return image;
}

class VtkDrawing : public Drawing {
 public:
  VtkDrawing() {
    // What is wrong is told by exceptions.
    vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
    vtkNew<SilentWindow> window;
    vtkOutputWindow::SetInstance(window);
    // VTK looks at it before its first loop. It starts no threads: where there are none to be had it gives up.
    setenv("VTK_SMP_BACKEND_IN_USE", "Sequential", 0);
  }

  std::string library() const override { return std::string("VTK ") + vtkVersion::GetVTKVersion(); }
  std::string start() override { return open_window(); }
  void finish() override { close_window(); }

  std::unique_ptr<Scene> scene(int width, int height) override { return std::make_unique<VtkScene>(width, height); }
  Mask text(const std::string& line, const TextStyle& style) const override { return mask_of(line, style); }
  double text_width(const std::string& line, int size) const override { return width_of(line, {.size = size}); }
  bool has_font() const override { return has_own_font(); }

  std::vector<std::vector<Point>> level_lines(const Field& field, double level) const override {
    vtkNew<vtkFlyingEdges2D> contour;
    contour->SetInputData(image_of(field));
    contour->SetValue(0, level);
    contour->ComputeScalarsOff();
    vtkNew<vtkStripper> join;
    join->SetInputConnection(contour->GetOutputPort());
    join->SetMaximumLength(1 << 24);
    join->Update();
    vtkPolyData* joined = join->GetOutput();
    std::vector<std::vector<Point>> lines;
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    vtkCellArray* cells = joined->GetLines();
    for (cells->InitTraversal(); cells->GetNextCell(count, ids);) {
      auto& line = lines.emplace_back();
      for (vtkIdType k = 0; k < count; ++k) {
        double p[3];
        joined->GetPoint(ids[k], p);
        line.push_back({p[0], p[1]});
      }
    }
    return lines;
  }

  Mesh level_surface(const Field& field, double level) const override {
    vtkNew<vtkFlyingEdges3D> contour;
    contour->SetInputData(image_of(field));
    contour->SetValue(0, level);
    contour->ComputeScalarsOff();
    contour->ComputeNormalsOn();
    contour->Update();
    vtkPolyData* surface = contour->GetOutput();
    Mesh mesh;
    const auto floats = [](const double* p) {
      return std::array{static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
    };
    for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i) {
      mesh.points.push_back(floats(surface->GetPoint(i)));
      mesh.normals.push_back(floats(surface->GetPointData()->GetNormals()->GetTuple(i)));
    }
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    vtkCellArray* cells = surface->GetPolys();
    for (cells->InitTraversal(); cells->GetNextCell(count, ids);) mesh.triangles.push_back({ids[0], ids[1], ids[2]});
    return mesh;
  }

  Image read_png(const std::filesystem::path& file) const override {
    vtkNew<vtkPNGReader> reader;
    if (!std::filesystem::is_regular_file(file) || !reader->CanReadFile(file.c_str()))
      throw std::runtime_error("not a PNG picture");
    reader->SetFileName(file.c_str());
    reader->Update();
    vtkImageData* data = reader->GetOutput();
    if (data->GetScalarType() != VTK_UNSIGNED_CHAR || data->GetNumberOfScalarComponents() != 3)
      throw std::runtime_error("not 8-bit red, green, blue");
    Image image;
    image.width = data->GetDimensions()[0];
    image.height = data->GetDimensions()[1];
    image.pixels.resize(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
    const auto* from = static_cast<const unsigned char*>(data->GetScalarPointer());
    for (Colour& pixel : image.pixels) {
      std::copy_n(from, 3, pixel.begin());
      from += 3;
    }
    return image;
  }
};

}  // namespace
}  // namespace gaussdrift::render

/// What the program asks for. It lives until the process ends.
extern "C" __attribute__((visibility("default"))) gaussdrift::render::Drawing* gaussdrift_drawing() {
  static auto* const drawing = new gaussdrift::render::VtkDrawing;
  return drawing;
}
