#include "render/vtk/scene.hpp"

#include <vtkActor.h>
#include <vtkCallbackCommand.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkLight.h>
#include <vtkLookupTable.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkTubeFilter.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "render/vtk/osmesa_window.hpp"

namespace gaussdrift::render {
namespace {

/// Edges are smooth because scenes are drawn so many times as wide and high, and pixels are means. The several samples a
/// pixel that OpenGL offers for that take three times as long with llvmpipe.
constexpr int finer = 2;

vtkNew<vtkPolyData> polylines(const std::vector<std::vector<Place>>& lines) {
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> cells;
  for (const auto& line : lines) {
    cells->InsertNextCell(static_cast<int>(line.size()));
    for (const Place& p : line) cells->InsertCellPoint(points->InsertNextPoint(p.data()));
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetLines(cells);
  return data;
}

void set_colour(vtkActor* actor, const Colour& colour) {
  actor->GetProperty()->SetColor(colour[0] / 255., colour[1] / 255., colour[2] / 255.);
}

template <class Array, class Entry>
vtkNew<Array> array_of(const std::vector<Entry>& entries, int components) {
  vtkNew<Array> array;
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(static_cast<vtkIdType>(entries.size()));
  if (!entries.empty())
    std::copy_n(entries.front().data(), entries.size() * static_cast<std::size_t>(components), array->GetPointer(0));
  return array;
}

vtkNew<vtkPolyData> data_of(const Mesh& mesh) {
  vtkNew<vtkPoints> points;
  points->SetData(array_of<vtkFloatArray>(mesh.points, 3));
  const auto normals = array_of<vtkFloatArray>(mesh.normals, 3);
  normals->SetName("Normals");
  vtkNew<vtkCellArray> cells;
  for (const auto& corners : mesh.triangles) cells->InsertNextCell({corners[0], corners[1], corners[2]});
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetPolys(cells);
  data->GetPointData()->SetNormals(normals);
  if (mesh.shades.empty()) {
    data->GetPointData()->SetScalars(array_of<vtkUnsignedCharArray>(mesh.colours, 4));
  } else {
    vtkNew<vtkFloatArray> shade;
    shade->SetNumberOfValues(static_cast<vtkIdType>(mesh.shade.size()));
    std::copy(mesh.shade.begin(), mesh.shade.end(), shade->GetPointer(0));
    data->GetPointData()->SetScalars(shade);
  }
  return data;
}

vtkNew<vtkLookupTable> table_of(const std::vector<Colour>& shades) {
  vtkNew<vtkLookupTable> table;
  table->SetNumberOfTableValues(static_cast<vtkIdType>(shades.size()));
  table->SetRange(0, 1);
  for (std::size_t i = 0; i < shades.size(); ++i)
    table->SetTableValue(static_cast<vtkIdType>(i), shades[i][0] / 255., shades[i][1] / 255., shades[i][2] / 255.);
  return table;
}

}  // namespace

VtkScene::VtkScene(int width, int height) : width_(width), height_(height), renderer_(vtkRenderer::New()) {
  renderer_->SetBackground(1, 1, 1);
  renderer_->SetBackgroundAlpha(0);
  renderer_->SetUseFXAA(false);
  offscreen_window(finer * width, finer * height)->AddRenderer(renderer_);
}

VtkScene::~VtkScene() {
  vtkRenderWindow* window = offscreen_window(finer * width_, finer * height_);
  renderer_->ReleaseGraphicsResources(window);
  window->RemoveRenderer(renderer_);
  renderer_->Delete();
  release_window();
}

vtkCamera* VtkScene::camera() const { return renderer_->GetActiveCamera(); }

void VtkScene::look(const Place& eye, const Place& towards) {
  camera()->SetViewAngle(20);
  camera()->SetViewUp(0, 0, 1);
  camera()->SetFocalPoint(towards.data());
  camera()->SetPosition(eye.data());
}

void VtkScene::shift(Point by) { camera()->SetWindowCenter(by.x, by.y); }

Point VtkScene::pixel(const Place& place) const {
  vtkMatrix4x4* projection =
      camera()->GetCompositeProjectionTransformMatrix(static_cast<double>(width_) / height_, -1, 1);
  const double from[4] = {place[0], place[1], place[2], 1};
  double to[4];
  projection->MultiplyPoint(from, to);
  return {(to[0] / to[3] + 1) / 2 * width_, (to[1] / to[3] + 1) / 2 * height_};
}

double VtkScene::depth(const Place& place) const {
  double position[3], direction[3];
  camera()->GetPosition(position);
  camera()->GetDirectionOfProjection(direction);
  double distance = 0;
  for (int k = 0; k < 3; ++k) distance += (place[static_cast<std::size_t>(k)] - position[k]) * direction[k];
  return distance;
}

void VtkScene::lines(const std::vector<std::vector<Place>>& lines, const Colour& colour, double width) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(polylines(lines));
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  set_colour(actor, colour);
  actor->GetProperty()->LightingOff();
  actor->GetProperty()->SetLineWidth(static_cast<float>(finer * width));
  renderer_->AddActor(actor);
}

void VtkScene::tubes(const std::vector<std::vector<Place>>& lines, const Colour& colour, double radius) {
  vtkNew<vtkTubeFilter> tubes;
  tubes->SetInputData(polylines(lines));
  tubes->SetRadius(radius);
  tubes->SetNumberOfSides(4);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(tubes->GetOutputPort());
  mapper->ScalarVisibilityOff();
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  set_colour(actor, colour);
  actor->GetProperty()->LightingOff();
  renderer_->AddActor(actor);
}

void VtkScene::mesh(const Mesh& mesh, const Material& material) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data_of(mesh));
  if (!mesh.shades.empty()) {
    mapper->SetLookupTable(table_of(mesh.shades));
    mapper->UseLookupTableScalarRangeOn();
    mapper->InterpolateScalarsBeforeMappingOn();
  }
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  if (material.translucent) actor->ForceTranslucentOn();
  actor->GetProperty()->SetAmbient(material.ambient);
  actor->GetProperty()->SetDiffuse(material.diffuse);
  actor->GetProperty()->SetSpecular(material.specular);
  actor->GetProperty()->SetSpecularPower(material.specular_power);
  renderer_->AddActor(actor);
}

Image VtkScene::image() {
  renderer_->AutomaticLightCreationOff();
  vtkNew<vtkLight> light;
  light->SetLightTypeToCameraLight();
  light->SetPosition(-0.6, 0.7, 1);
  renderer_->AddLight(light);
  renderer_->ResetCameraClippingRange();
  vtkRenderWindow* window = offscreen_window(finer * width_, finer * height_);
  std::string messages;
  vtkNew<vtkCallbackCommand> collect;
  collect->SetClientData(&messages);
  collect->SetCallback([](vtkObject*, unsigned long, void* list, void* text) {
    *static_cast<std::string*>(list) += static_cast<const char*>(text);
  });
  const unsigned long observer = window->AddObserver("ErrorEvent", collect);
  window->Render();
  vtkNew<vtkUnsignedCharArray> bytes;
  const int failed = window->GetRGBACharPixelData(0, 0, finer * width_ - 1, finer * height_ - 1, /*front=*/0, bytes);
  window->RemoveObserver(observer);
  const std::size_t count = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  Image image{width_, height_, std::vector<Colour>(count), std::vector<std::uint8_t>(count)};
  if (!messages.empty() || failed == VTK_ERROR ||
      static_cast<std::size_t>(bytes->GetNumberOfValues()) != 4 * finer * finer * image.pixels.size())
    throw std::runtime_error(messages);
  const auto width = static_cast<std::size_t>(width_), row = 4 * finer * width;
  for (std::size_t y = 0; y < static_cast<std::size_t>(height_); ++y) {
    const unsigned char* below = bytes->GetPointer(0) + finer * y * row;
    const unsigned char* above = below + row;
    for (std::size_t x = 0; x < width; ++x, below += 4 * finer, above += 4 * finer) {
      const auto mean = [&](std::size_t k) {
        return static_cast<std::uint8_t>((below[k] + below[k + 4] + above[k] + above[k + 4] + 2) / 4);
      };
      image.pixels[y * width + x] = {mean(0), mean(1), mean(2)};
      image.opacity[y * width + x] = mean(3);
    }
  }
  return image;
}

}  // namespace gaussdrift::render
