// The density as a surface in perspective, with contour lines on it.
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

#include <algorithm>
#include <array>
#include <cmath>

#include "render/contour_lines.hpp"
#include "render/furniture.hpp"
#include "render/styles.hpp"

namespace gaussdrift::render {
namespace {

using Place = std::array<double, 3>;  // in the scene: [0, width] x [0, depth] x [0, height]

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

void add_lines(vtkRenderer* scene, const std::vector<std::vector<Place>>& lines, const Colour& colour, double width) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(polylines(lines));
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  set_colour(actor, colour);
  actor->GetProperty()->LightingOff();
  actor->GetProperty()->SetLineWidth(static_cast<float>(width));
  scene->AddActor(actor);
}

/// Camera over the corner (x_max, y_min), so that a counter-clockwise turn is seen as one.
class View {
 public:
  View(Canvas& canvas, const Place& box, const Rectangle& room)
      : canvas_(canvas), camera_(canvas.scene()->GetActiveCamera()) {
    constexpr double azimuth = -62 * 3.14159265358979 / 180, elevation = 31 * 3.14159265358979 / 180;
    const Place centre{box[0] / 2, box[1] / 2, box[2] / 2};
    camera_->SetViewAngle(20);
    camera_->SetViewUp(0, 0, 1);
    camera_->SetFocalPoint(centre.data());
    double distance = 4;
    for (int round = 0; round < 8; ++round) {
      camera_->SetPosition(centre[0] + distance * std::cos(elevation) * std::cos(azimuth),
                           centre[1] + distance * std::cos(elevation) * std::sin(azimuth),
                           centre[2] + distance * std::sin(elevation));
      const Rectangle seen = extent(box);
      distance *= std::max(seen.width / room.width, seen.height / room.height);
    }
    const Rectangle seen = extent(box);
    camera_->SetWindowCenter(2 * (seen.x + seen.width / 2 - room.x - room.width / 2) / canvas.width(),
                             2 * (seen.y + seen.height / 2 - room.y - room.height / 2) / canvas.height());
  }

  Point pixel(const Place& place) const {
    vtkMatrix4x4* projection =
        camera_->GetCompositeProjectionTransformMatrix(static_cast<double>(canvas_.width()) / canvas_.height(), -1, 1);
    const double from[4] = {place[0], place[1], place[2], 1};
    double to[4];
    projection->MultiplyPoint(from, to);
    return {(to[0] / to[3] + 1) / 2 * canvas_.width(), (to[1] / to[3] + 1) / 2 * canvas_.height()};
  }

 private:
  Rectangle extent(const Place& box) const {
    Point low{1e30, 1e30}, high{-1e30, -1e30};
    for (int corner = 0; corner < 8; ++corner) {
      const Point p = pixel({corner & 1 ? box[0] : 0, corner & 2 ? box[1] : 0, corner & 4 ? box[2] : 0});
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    return {low.x, low.y, high.x - low.x, high.y - low.y};
  }

  Canvas& canvas_;
  vtkCamera* camera_;
};

/// Ticks, numbers and title along the edge from `from` to `to`, outwards in the direction of `out` (as seen).
void draw_edge(Canvas& canvas, const View& view, const Axis& axis, const Place& from, const Place& to,
               const Place& out) {
  const Scale scale(canvas);
  const auto along = [&](double s) {
    return Place{from[0] + s * (to[0] - from[0]), from[1] + s * (to[1] - from[1]), from[2] + s * (to[2] - from[2])};
  };
  const auto outwards = [&](const Place& p) {  // unit vector in the picture
    const Point here = view.pixel(p),
                there = view.pixel({p[0] + 0.01 * out[0], p[1] + 0.01 * out[1], p[2] + 0.01 * out[2]});
    const double length = std::hypot(there.x - here.x, there.y - here.y);
    return Point{(there.x - here.x) / length, (there.y - here.y) / length};
  };
  // Numbers are centred on a point beyond the tick, as far out as half of them reaches.
  const int size = scale.font(18), title_size = scale.font(21);
  const auto centre = [&](const Point& at, const Point& direction, double gap, double text_width, double text_height) {
    const double reach = gap + std::fabs(direction.x) * text_width / 2 + std::fabs(direction.y) * text_height / 2;
    return Point{at.x + reach * direction.x, at.y + reach * direction.y};
  };
  std::vector<Polyline> marks;
  double widest = 0;
  for (const Tick& t : axis.ticks.list) {
    const Place place = along(axis.position(t.at));
    const Point at = view.pixel(place), direction = outwards(place);
    const double tick = scale(8), width = Canvas::text_width(t.label, size);
    marks.push_back({{at, {at.x + tick * direction.x, at.y + tick * direction.y}}, ink});
    canvas.text(centre(at, direction, scale(15), width, size), t.label, {.size = size});
    widest = std::max(widest, width);
  }
  canvas.lines(marks, 1.3);
  canvas.line(view.pixel(from), view.pixel(to), ink, 1.3);
  const Place middle = along(0.5);
  const Point at = view.pixel(middle), direction = outwards(middle);
  const bool upwards = std::fabs(to[2] - from[2]) > 0;
  const double width = upwards ? title_size : Canvas::text_width(axis.title(), title_size);
  const double beyond = scale(15 + 16) + std::fabs(direction.x) * widest + std::fabs(direction.y) * size;
  canvas.text(centre(at, direction, beyond, width, title_size), axis.title(), {.size = title_size, .upwards = upwards});
}

}  // namespace

void draw_surface(Canvas& canvas, const HeightField& field, const ColourRange& range, const PictureOptions& options) {
  const Scale scale(canvas);
  const double height = 0.45 * std::max(0.5, std::sqrt(field.width * field.depth));
  const double w = field.width, d = field.depth;
  const Axis x{"x", field.x_min, field.x_min + w * field.length, w > 0.4 ? 5 : 2};
  const Axis y{"y", field.y_min, field.y_min + d * field.length, d > 0.4 ? 5 : 2};
  const Axis z{options.quantity, range.min, range.max, 5};

  // Room at the right for the title of y and the colour bar.
  const double right = scale(160) + Canvas::text_width(y.title(), scale.font(21));
  const View view(canvas, {w, d, height},
                  {scale(128), scale(96), canvas.width() - scale(128) - right, canvas.height() - scale(96 + 130)});

  // Grid on the two walls behind the surface.
  std::vector<std::vector<Place>> grid, walls{{{0, 0, 0},
                                               {0, 0, height},
                                               {0, d, height},
                                               {w, d, height},
                                               {w, d, 0},
                                               {0, d, 0},
                                               {0, 0, 0},
                                               {w, 0, 0},
                                               {w, d, 0}},
                                              {{0, d, 0}, {0, d, height}}};
  for (const Tick& t : x.ticks.list) grid.push_back({{x.position(t.at) * w, d, 0}, {x.position(t.at) * w, d, height}});
  for (const Tick& t : y.ticks.list) grid.push_back({{0, y.position(t.at) * d, 0}, {0, y.position(t.at) * d, height}});
  for (const Tick& t : z.ticks.list) {
    const double level = z.position(t.at) * height;
    grid.push_back({{0, 0, level}, {0, d, level}, {w, d, level}});
  }
  vtkRenderer* scene = canvas.scene();
  add_lines(scene, grid, pale_grey, 1);
  add_lines(scene, walls, grey, 1);
  add_surface(scene, field, height);
  add_contours(scene, field, height, range);

  scene->AutomaticLightCreationOff();
  vtkNew<vtkLight> light;
  light->SetLightTypeToCameraLight();
  light->SetPosition(-0.6, 0.7, 1);
  scene->AddLight(light);
  scene->ResetCameraClippingRange();

  draw_edge(canvas, view, x, {0, 0, 0}, {w, 0, 0}, {0, -1, 0});
  draw_edge(canvas, view, y, {w, 0, 0}, {w, d, 0}, {1, 0, 0});
  draw_edge(canvas, view, z, {0, 0, 0}, {0, 0, height}, {-1, 0, 0});
  draw_colour_bar(canvas, {canvas.width() - scale(134), scale(250), scale(26), scale(460)}, true,
                  {options.quantity, range.min, range.max, 6}, {});
  draw_heading(canvas, options, field);
}

}  // namespace gaussdrift::render
