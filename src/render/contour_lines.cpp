#include "render/contour_lines.hpp"

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkFlyingEdges2D.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkStripper.h>

#include <cmath>

#include "render/ticks.hpp"

namespace gaussdrift::render {

std::vector<double> contour_levels(const ColourRange& range) {
  const double length = range.max - range.min;
  std::vector<double> levels;
  for (const Tick& tick : make_ticks(range.min, range.max, 15).list)
    if (range.position(tick.at) > 1e-6 && range.position(tick.at) < 1 - 1e-6 && std::fabs(tick.at) > 1e-9 * length)
      levels.push_back(tick.at);
  return levels;
}

std::vector<ContourLine> contour_lines(const HeightField& field, const std::vector<double>& levels) {
  vtkNew<vtkImageData> image;
  image->SetDimensions(static_cast<int>(field.nx), static_cast<int>(field.ny), 1);
  image->SetSpacing(field.x(1), field.y(1), 1);
  vtkNew<vtkFloatArray> values;
  values->SetArray(const_cast<float*>(field.value.data()), static_cast<vtkIdType>(field.value.size()), /*save=*/1);
  image->GetPointData()->SetScalars(values);

  std::vector<ContourLine> lines;
  for (const double level : levels) {
    vtkNew<vtkFlyingEdges2D> contour;
    contour->SetInputData(image);
    contour->SetValue(0, level);
    contour->ComputeScalarsOff();
    vtkNew<vtkStripper> join;
    join->SetInputConnection(contour->GetOutputPort());
    join->SetMaximumLength(1 << 24);
    join->Update();
    vtkPolyData* joined = join->GetOutput();
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    vtkCellArray* cells = joined->GetLines();
    for (cells->InitTraversal(); cells->GetNextCell(count, ids);) {
      ContourLine line{level, {}};
      const auto finish = [&] {
        if (line.points.size() > 1) lines.push_back(line);
        line.points.clear();
      };
      for (vtkIdType k = 0; k < count; ++k) {
        double p[3];
        joined->GetPoint(ids[k], p);
        if (std::isfinite(p[0]) && std::isfinite(p[1]))
          line.points.push_back({p[0], p[1]});
        else
          finish();  // beside a NaN
      }
      finish();
    }
  }
  return lines;
}

}  // namespace gaussdrift::render
