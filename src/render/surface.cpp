// The density as a surface in perspective, with contour lines on it.
#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkLookupTable.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkTubeFilter.h>
#include <vtkTypeInt64Array.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "render/axes.hpp"
#include "render/contour_lines.hpp"
#include "render/scene.hpp"
#include "render/styles.hpp"

namespace gaussdrift::render {
namespace {

/// Overshoots stick out of the box a little; what is far outside the range is cut off there.
constexpr double stick_out = 0.04;

double height_of(double position, double height) {
  return std::isnan(position) ? 0 : height * std::clamp(position, -stick_out, 1 + stick_out);
}

vtkNew<vtkPolyData> mesh(const HeightField& field, double height) {
  const auto nx = static_cast<vtkIdType>(field.nx), ny = static_cast<vtkIdType>(field.ny);
  vtkNew<vtkFloatArray> coordinates, normals, position;
  for (auto* array : {coordinates.Get(), normals.Get()}) {
    array->SetNumberOfComponents(3);
    array->SetNumberOfTuples(nx * ny);
  }
  position->SetArray(const_cast<float*>(field.value.data()), nx * ny, /*save=*/1);
  const auto z = [&](std::size_t i, std::size_t j) { return height_of(field.at(i, j), height); };
  float* x = coordinates->GetPointer(0);
  float* n = normals->GetPointer(0);
  for (std::size_t j = 0; j < field.ny; ++j)
    for (std::size_t i = 0; i < field.nx; ++i) {
      const std::size_t west = i > 0 ? i - 1 : i, east = std::min(i + 1, field.nx - 1);
      const std::size_t south = j > 0 ? j - 1 : j, north = std::min(j + 1, field.ny - 1);
      const double slope_x = (z(east, j) - z(west, j)) / (field.x(east) - field.x(west));
      const double slope_y = (z(i, north) - z(i, south)) / (field.y(north) - field.y(south));
      const double length = std::sqrt(1 + slope_x * slope_x + slope_y * slope_y);
      for (const double c : {field.x(i), field.y(j), z(i, j)}) *x++ = static_cast<float>(c);
      for (const double c : {-slope_x / length, -slope_y / length, 1 / length}) *n++ = static_cast<float>(c);
    }

  vtkNew<vtkCellArray> triangles;
  triangles->AllocateExact(2 * (nx - 1) * (ny - 1), 6 * (nx - 1) * (ny - 1));
  for (vtkIdType j = 0; j + 1 < ny; ++j)
    for (vtkIdType i = 0; i + 1 < nx; ++i) {
      const vtkIdType a = j * nx + i, b = a + 1, c = a + nx, d = c + 1;
      const float sum = position->GetValue(a) + position->GetValue(b) + position->GetValue(c) + position->GetValue(d);
      if (std::isnan(sum)) continue;  // a hole
      triangles->InsertNextCell({a, b, d});
      triangles->InsertNextCell({a, d, c});
    }

  vtkNew<vtkPoints> points;
  points->SetData(coordinates);
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetPolys(triangles);
  data->GetPointData()->SetNormals(normals);
  data->GetPointData()->SetScalars(position);
  return data;
}

void add_surface(vtkRenderer* scene, const HeightField& field, double height) {
  vtkNew<vtkLookupTable> table;
  table->SetNumberOfTableValues(256);
  table->SetRange(0, 1);
  for (int i = 0; i < 256; ++i) {
    const Colour colour = viridis(i / 255.);
    table->SetTableValue(i, colour[0] / 255., colour[1] / 255., colour[2] / 255.);
  }
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(mesh(field, height));
  mapper->SetLookupTable(table);
  mapper->UseLookupTableScalarRangeOn();
  mapper->InterpolateScalarsBeforeMappingOn();
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->SetAmbient(0.35);
  actor->GetProperty()->SetDiffuse(0.68);
  actor->GetProperty()->SetSpecular(0.06);
  actor->GetProperty()->SetSpecularPower(20);
  scene->AddActor(actor);
}

/// Tubes: lines would flicker through the surface.
void add_contours(vtkRenderer* scene, const HeightField& field, double height, const ColourRange& range) {
  std::vector<double> levels;
  for (const double level : contour_levels(range)) levels.push_back(range.position(level));
  std::vector<std::vector<Place>> lines;
  for (const auto& [level, points] : contour_lines(field, levels)) {
    auto& line = lines.emplace_back();
    for (const Point& p : points) line.push_back({p.x, p.y, level * height});
  }
  if (lines.empty()) return;
  vtkNew<vtkTubeFilter> tubes;
  tubes->SetInputData(polylines(lines));
  tubes->SetRadius(0.0011);
  tubes->SetNumberOfSides(6);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(tubes->GetOutputPort());
  mapper->ScalarVisibilityOff();
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  set_colour(actor, {20, 20, 26});
  actor->GetProperty()->LightingOff();
  scene->AddActor(actor);
}

void draw(Canvas& canvas, const HeightField& field, const ColourRange& range, const PictureOptions& options) {
  const Scale scale(canvas);
  const double height = 0.45 * std::max(0.5, std::sqrt(field.width * field.depth));
  const double w = field.width, d = field.depth;
  const Axis x{options.axes[0], field.x_min, field.x_min + w * field.length, w > 0.4 ? 5 : 2};
  const Axis y{options.axes[1], field.y_min, field.y_min + d * field.length, d > 0.4 ? 5 : 2};
  const Axis z{options.quantity, range.min, range.max, 5};

  // Room at the right for the title of y and the colour bar.
  const double right = scale(160) + Canvas::text_width(y.title(), scale.font(21));
  const View view(canvas, {w, d, height},
                  {scale(128), scale(96), canvas.width() - scale(128) - right, canvas.height() - scale(96 + 130)});

  vtkRenderer* scene = canvas.scene();
  add_walls(scene, {w, d, height}, x, y, z, false);
  add_surface(scene, field, height);
  add_contours(scene, field, height, range);

  add_light(scene);
  scene->ResetCameraClippingRange();

  draw_edges(canvas, view, {w, d, height}, x, y, z);
  draw_colour_bar(canvas, {canvas.width() - scale(134), scale(250), scale(26), scale(460)}, true,
                  {options.quantity, range.min, range.max, 6}, {});
  draw_heading(canvas, options, field);
}

/// A picture of 1280 pixels does not show more points an axis than these, and a surface costs time for each.
constexpr std::size_t most_points = 300;

Painting surface(const DensityGrid& density, const ColourRange& range, const PictureOptions& options) {
  return [field = make_height_field(density, range, most_points), range, options](Canvas& canvas) {
    draw(canvas, field, range, options);
  };
}

}  // namespace

Style surface_style() {
  return {.about = {.name = "surface",
                    .meaning = "a surface in perspective, seen from above at an angle, with contour lines on it",
                    .most_dimension = 2,
                    .by_default = true},
          .cost = {.a_point = 1.6e-6, .most_points = most_points * most_points},  // a triangle for every point

          .painting = surface};
}

}  // namespace gaussdrift::render
