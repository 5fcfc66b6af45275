#include "render/canvas.hpp"

#include <fmt/format.h>
#include <unistd.h>
#include <vtkActor2D.h>
#include <vtkCallbackCommand.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCoordinate.h>
#include <vtkImageData.h>
#include <vtkImageMapper.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper2D.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkTextRenderer.h>
#include <vtkUnsignedCharArray.h>
#include <vtkWindowToImageFilter.h>

#include <algorithm>
#include <cmath>

#include "gaussdrift/error.hpp"
#include "render/osmesa_window.hpp"

#ifndef GAUSSDRIFT_FONT
#define GAUSSDRIFT_FONT ""
#endif

namespace gaussdrift::render {
namespace {

constexpr int dots_per_inch = 72;  // a font size is in pixels

bool has_font() {
  static const bool found = access(GAUSSDRIFT_FONT, R_OK) == 0;
  return found;
}

void set_font(vtkTextProperty* property, const TextStyle& style) {
  if (has_font()) {
    property->SetFontFamily(VTK_FONT_FILE);
    property->SetFontFile(GAUSSDRIFT_FONT);
  } else {
    property->SetFontFamilyToArial();
  }
  property->SetFontSize(style.size);
  property->SetColor(style.colour[0] / 255., style.colour[1] / 255., style.colour[2] / 255.);
  property->SetOrientation(style.upwards ? 90 : 0);
  // VTK justifies along and across the text's own direction. Of text written upwards the right is the bottom, its end
  // is the top.
  const auto along_text = [](int place) {
    return place == 0 ? VTK_TEXT_LEFT : place == 1 ? VTK_TEXT_CENTERED : VTK_TEXT_RIGHT;
  };
  const auto across_text = [](int place) {
    return place == 0 ? VTK_TEXT_BOTTOM : place == 1 ? VTK_TEXT_CENTERED : VTK_TEXT_TOP;
  };
  const int across = static_cast<int>(style.across), along = static_cast<int>(style.along);
  property->SetJustification(along_text(style.upwards ? along : across));
  property->SetVerticalJustification(across_text(style.upwards ? 2 - across : along));
}

/// One line of well-formed UTF-8, with plain minus signs where the font has no others.
std::string drawable(const std::string& text) {
  std::string clean;
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const std::size_t length = byte < 0x80                   ? 1
                               : byte >= 0xC2 && byte < 0xE0 ? 2
                               : byte >= 0xE0 && byte < 0xF0 ? 3
                               : byte >= 0xF0 && byte < 0xF5 ? 4
                                                             : 0;
    bool whole = length > 0 && i + length <= text.size();
    for (std::size_t k = 1; whole && k < length; ++k) whole = (static_cast<unsigned char>(text[i + k]) & 0xC0) == 0x80;
    if (!whole) {
      clean += '?';
      ++i;
      continue;
    }
    const std::string letter = text.substr(i, length);
    clean += byte < 0x20 || byte == 0x7F ? " " : letter == "\u2212" && !has_font() ? "-" : letter;
    i += length;
  }
  return clean;
}

/// Where the middle of an upright or level line has to be so that the line fills whole pixels.
double on_grid(double x, double line_width) {
  const bool odd = static_cast<long>(std::max(1., std::round(line_width))) % 2 == 1;
  return odd ? std::floor(x) + 0.5 : std::round(x);
}

std::vector<Point> crisp(std::vector<Point> segment, double line_width) {
  if (segment[0].x == segment[1].x) segment[0].x = segment[1].x = on_grid(segment[0].x, line_width);
  if (segment[0].y == segment[1].y) segment[0].y = segment[1].y = on_grid(segment[0].y, line_width);
  return segment;
}

/// The two edges of a thick line: the points moved by `half` at right angles, mitred at bends. Lines of OpenGL have
/// gaps there.
std::pair<std::vector<Point>, std::vector<Point>> edges(const std::vector<Point>& line, double half) {
  std::vector<Point> way;
  for (const Point& p : line)
    if (way.empty() || std::hypot(p.x - way.back().x, p.y - way.back().y) > 1e-3) way.push_back(p);
  std::vector<Point> left, right;
  if (way.size() < 2) return {left, right};
  const std::size_t last = way.size() - 1;
  const bool closed = last > 2 && std::hypot(way[0].x - way[last].x, way[0].y - way[last].y) < 1e-2;
  const auto normal = [&](std::size_t i) {  // of the piece from point i to the next
    const double dx = way[i + 1].x - way[i].x, dy = way[i + 1].y - way[i].y, length = std::hypot(dx, dy);
    return Point{-dy / length, dx / length};
  };
  for (std::size_t i = 0; i <= last; ++i) {
    const Point before = normal(i > 0    ? i - 1
                                : closed ? last - 1
                                         : 0),
                after = normal(i < last ? i
                               : closed ? 0
                                        : last - 1);
    const double cosine = before.x * after.x + before.y * after.y;
    const double stretch = half / std::max(1 + cosine, 0.25);  // spikes are cut
    const Point out{stretch * (before.x + after.x), stretch * (before.y + after.y)};
    left.push_back({way[i].x + out.x, way[i].y + out.y});
    right.push_back({way[i].x - out.x, way[i].y - out.y});
  }
  return {left, right};
}

}  // namespace

Canvas::Canvas(int width, int height) : width_(width), height_(height), renderer_(vtkRenderer::New()) {
  renderer_->SetBackground(1, 1, 1);
  renderer_->SetUseFXAA(false);
  offscreen_window(width, height)->AddRenderer(renderer_);
}

Canvas::~Canvas() {
  vtkRenderWindow* window = offscreen_window(width_, height_);
  renderer_->ReleaseGraphicsResources(window);
  window->RemoveRenderer(renderer_);
  renderer_->Delete();
  release_window();
}

void Canvas::add(void* prop) {
  auto* actor = static_cast<vtkActor2D*>(prop);
  actor->SetLayerNumber(layer_++);
  renderer_->AddActor2D(actor);
}

void Canvas::lines(const std::vector<Polyline>& list, double line_width) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> cells;
  vtkNew<vtkUnsignedCharArray> colours;
  colours->SetNumberOfComponents(3);
  for (const Polyline& line : list) {
    const std::vector<Point> way = line.points.size() == 2 ? crisp(line.points, line_width) : line.points;
    const auto [left, right] = edges(way, line_width / 2);
    for (std::size_t i = 0; i < left.size(); ++i) {
      points->InsertNextPoint(left[i].x, left[i].y, 0);
      const vtkIdType last = points->InsertNextPoint(right[i].x, right[i].y, 0);
      if (i == 0) continue;
      cells->InsertNextCell({last - 3, last - 2, last, last - 1});
      colours->InsertNextTypedTuple(line.colour.data());
    }
  }
  if (cells->GetNumberOfCells() == 0) return;
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetPolys(cells);
  data->GetCellData()->SetScalars(colours);
  vtkNew<vtkPolyDataMapper2D> mapper;
  mapper->SetInputData(data);
  vtkNew<vtkActor2D> actor;
  actor->SetMapper(mapper);
  add(actor);
}

void Canvas::frame(const Rectangle& box, const Colour& colour, double line_width) {
  const double low_x = on_grid(box.x, line_width), high_x = on_grid(box.right(), line_width);
  const double low_y = on_grid(box.y, line_width), high_y = on_grid(box.top(), line_width);
  lines({{{{low_x, low_y}, {high_x, low_y}, {high_x, high_y}, {low_x, high_y}, {low_x, low_y}}, colour}},
        std::max(1., std::round(line_width)));
}

void Canvas::area(const Rectangle& box, const Colour& colour) {
  const int left = static_cast<int>(std::lround(box.x)), bottom = static_cast<int>(std::lround(box.y));
  const int columns = std::max(1, static_cast<int>(std::lround(box.width))),
            rows = std::max(1, static_cast<int>(std::lround(box.height)));
  image(left, bottom, columns, rows,
        std::vector<Colour>(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), colour));
}

void Canvas::image(int left, int bottom, int columns, int rows, const std::vector<Colour>& colours) {
  vtkNew<vtkImageData> data;
  data->SetDimensions(columns, rows, 1);
  data->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  auto* to = static_cast<unsigned char*>(data->GetScalarPointer());
  for (const Colour& colour : colours) to = std::copy(colour.begin(), colour.end(), to);
  vtkNew<vtkImageMapper> mapper;
  mapper->SetInputData(data);
  mapper->SetColorWindow(255);  // the bytes as they are
  mapper->SetColorLevel(127.5);
  vtkNew<vtkActor2D> actor;
  actor->SetMapper(mapper);
  actor->SetPosition(left, bottom);
  add(actor);
}

void Canvas::text(Point at, const std::string& text, const TextStyle& style) {
  const std::string clean = drawable(text);
  if (clean.find_first_not_of(' ') == std::string::npos) return;
  vtkNew<vtkTextActor> actor;
  actor->SetInput(clean.c_str());
  set_font(actor->GetTextProperty(), style);
  actor->GetPositionCoordinate()->SetCoordinateSystemToDisplay();
  actor->SetPosition(std::round(at.x), std::round(at.y));
  add(actor.Get());
}

double Canvas::text_width(const std::string& text, int size) {
  vtkNew<vtkTextProperty> property;
  TextStyle style;
  style.size = size;
  set_font(property, style);
  std::array<int, 4> box{};
  if (!vtkTextRenderer::GetInstance()->GetBoundingBox(property, drawable(text), box.data(), dots_per_inch)) return 0;
  return box[1] - box[0] + 1;
}

std::string Canvas::png() {
  vtkRenderWindow* window = offscreen_window(width_, height_);
  std::string messages;
  vtkNew<vtkCallbackCommand> collect;
  collect->SetClientData(&messages);
  collect->SetCallback([](vtkObject*, unsigned long, void* list, void* text) {
    *static_cast<std::string*>(list) += static_cast<const char*>(text);
  });
  const unsigned long observer = window->AddObserver("ErrorEvent", collect);
  window->SetDPI(dots_per_inch);
  window->Render();
  vtkNew<vtkWindowToImageFilter> pixels;
  pixels->SetInput(window);
  pixels->ReadFrontBufferOff();
  pixels->ShouldRerenderOff();
  pixels->SetInputBufferTypeToRGB();
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputConnection(pixels->GetOutputPort());
  writer->WriteToMemoryOn();
  writer->SetCompressionLevel(4);
  writer->Write();
  window->RemoveObserver(observer);
  vtkUnsignedCharArray* bytes = writer->GetResult();
  if (!messages.empty() || writer->GetErrorCode() != 0 || !bytes || bytes->GetNumberOfValues() == 0)
    throw Error(ExitCode::internal, fmt::format("VTK could not draw the picture: {}", messages));
  return {reinterpret_cast<const char*>(bytes->GetPointer(0)), static_cast<std::size_t>(bytes->GetNumberOfValues())};
}

}  // namespace gaussdrift::render
