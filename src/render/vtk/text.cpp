#include "render/vtk/text.hpp"

#include <unistd.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkStdString.h>
#include <vtkTextProperty.h>
#include <vtkTextRenderer.h>

#include <array>

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

Mask mask_of(const std::string& line, const TextStyle& style) {
  vtkNew<vtkTextProperty> property;
  set_font(property, style);
  property->SetColor(1, 1, 1);
  vtkNew<vtkImageData> image;
  std::array<int, 2> size{};
  Mask mask;
  if (!vtkTextRenderer::GetInstance()->RenderString(property, line, image, size.data(), dots_per_inch)) return mask;
  // The image may be larger than the text, and begins where that does, as seen from the point.
  const int* extent = image->GetExtent();
  const int parts = image->GetNumberOfScalarComponents();
  mask = {extent[0], extent[2], size[0], size[1], {}};
  mask.cover.reserve(static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]));
  for (int j = 0; j < size[1]; ++j)
    for (int i = 0; i < size[0]; ++i) {
      const auto* pixel = static_cast<const unsigned char*>(image->GetScalarPointer(extent[0] + i, extent[2] + j, 0));
      mask.cover.push_back(pixel[parts - 1]);
    }
  return mask;
}

}  // namespace gaussdrift::render
