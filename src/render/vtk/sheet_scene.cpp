// The scene behind a sheet: camera, light, lines, meshes.
#include <vtkActor.h>
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
#include <vtkRenderer.h>
#include <vtkTubeFilter.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>

#include "render/vtk/sheet.hpp"

namespace gaussdrift::render {
namespace {

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

vtkCamera* VtkSheet::camera() const { return renderer_->GetActiveCamera(); }

void VtkSheet::look(const Place& eye, const Place& towards) {
  camera()->SetViewAngle(20);
  camera()->SetViewUp(0, 0, 1);
  camera()->SetFocalPoint(towards.data());
  camera()->SetPosition(eye.data());
}

void VtkSheet::shift_scene(Point by) { camera()->SetWindowCenter(by.x, by.y); }

Point VtkSheet::pixel(const Place& place) const {
  vtkMatrix4x4* projection =
      camera()->GetCompositeProjectionTransformMatrix(static_cast<double>(width_) / height_, -1, 1);
  const double from[4] = {place[0], place[1], place[2], 1};
  double to[4];
  projection->MultiplyPoint(from, to);
  return {(to[0] / to[3] + 1) / 2 * width_, (to[1] / to[3] + 1) / 2 * height_};
}

double VtkSheet::depth(const Place& place) const {
  double position[3], direction[3];
  camera()->GetPosition(position);
  camera()->GetDirectionOfProjection(direction);
  double distance = 0;
  for (int k = 0; k < 3; ++k) distance += (place[static_cast<std::size_t>(k)] - position[k]) * direction[k];
  return distance;
}

void VtkSheet::scene_lines(const std::vector<std::vector<Place>>& lines, const Colour& colour, double width) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(polylines(lines));
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  set_colour(actor, colour);
  actor->GetProperty()->LightingOff();
  actor->GetProperty()->SetLineWidth(static_cast<float>(width));
  renderer_->AddActor(actor);
}

void VtkSheet::scene_tubes(const std::vector<std::vector<Place>>& lines, const Colour& colour, double radius) {
  vtkNew<vtkTubeFilter> tubes;
  tubes->SetInputData(polylines(lines));
  tubes->SetRadius(radius);
  tubes->SetNumberOfSides(6);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(tubes->GetOutputPort());
  mapper->ScalarVisibilityOff();
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  set_colour(actor, colour);
  actor->GetProperty()->LightingOff();
  renderer_->AddActor(actor);
}

void VtkSheet::scene_mesh(const Mesh& mesh, const Material& material) {
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

void VtkSheet::light_scene() {
  renderer_->AutomaticLightCreationOff();
  vtkNew<vtkLight> light;
  light->SetLightTypeToCameraLight();
  light->SetPosition(-0.6, 0.7, 1);
  renderer_->AddLight(light);
  renderer_->ResetCameraClippingRange();
}

}  // namespace gaussdrift::render
