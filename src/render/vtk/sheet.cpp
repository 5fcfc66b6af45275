#include "render/vtk/sheet.hpp"

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
#include <array>
#include <cmath>
#include <stdexcept>

#include "render/vtk/osmesa_window.hpp"

#ifndef GAUSSDRIFT_FONT
#define GAUSSDRIFT_FONT ""
#endif

namespace gaussdrift::render {
namespace {

constexpr int dots_per_inch = 72;  // a font size is in pixels

void set_font(vtkTextProperty* property, const TextStyle& style) {
  if (has_own_font()) {
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

}  // namespace

bool has_own_font() {
  static const bool found = access(GAUSSDRIFT_FONT, R_OK) == 0;
  return found;
}

double width_of(const std::string& line, const TextStyle& style) {
  vtkNew<vtkTextProperty> property;
  set_font(property, style);
  std::array<int, 4> box{};
  if (!vtkTextRenderer::GetInstance()->GetBoundingBox(property, line, box.data(), dots_per_inch)) return 0;
  return box[1] - box[0] + 1;
}

VtkSheet::VtkSheet(int width, int height) : width_(width), height_(height), renderer_(vtkRenderer::New()) {
  renderer_->SetBackground(1, 1, 1);
  renderer_->SetUseFXAA(false);
  offscreen_window(width, height)->AddRenderer(renderer_);
}

VtkSheet::~VtkSheet() {
  vtkRenderWindow* window = offscreen_window(width_, height_);
  renderer_->ReleaseGraphicsResources(window);
  window->RemoveRenderer(renderer_);
  renderer_->Delete();
  release_window();
}

void VtkSheet::add(vtkActor2D* actor) {
  actor->SetLayerNumber(layer_++);
  renderer_->AddActor2D(actor);
}

void VtkSheet::strips(const std::vector<Strip>& list) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> cells;
  vtkNew<vtkUnsignedCharArray> colours;
  colours->SetNumberOfComponents(3);
  for (const auto& [left, right, colour] : list)
    for (std::size_t i = 0; i < left.size(); ++i) {
      points->InsertNextPoint(left[i].x, left[i].y, 0);
      const vtkIdType last = points->InsertNextPoint(right[i].x, right[i].y, 0);
      if (i == 0) continue;
      cells->InsertNextCell({last - 3, last - 2, last, last - 1});
      colours->InsertNextTypedTuple(colour.data());
    }
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

void VtkSheet::image(int left, int bottom, int columns, int rows, const std::vector<Colour>& colours) {
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

void VtkSheet::text(Point at, const std::string& line, const TextStyle& style) {
  vtkNew<vtkTextActor> actor;
  actor->SetInput(line.c_str());
  set_font(actor->GetTextProperty(), style);
  actor->GetPositionCoordinate()->SetCoordinateSystemToDisplay();
  actor->SetPosition(std::round(at.x), std::round(at.y));
  add(actor);
}

std::string VtkSheet::png() {
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
    throw std::runtime_error(messages);
  return {reinterpret_cast<const char*>(bytes->GetPointer(0)), static_cast<std::size_t>(bytes->GetNumberOfValues())};
}

}  // namespace gaussdrift::render
