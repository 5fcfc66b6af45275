// A sheet of VTK: 2D actors over the scene of one renderer, in the one window of the process.
#pragma once

#include <string>
#include <vector>

#include "render/drawing.hpp"

class vtkCamera;
class vtkRenderer;
class vtkActor2D;

namespace gaussdrift::render {

bool has_own_font();

/// In pixels.
double width_of(const std::string& line, const TextStyle& style);

class VtkSheet : public Sheet {
 public:
  VtkSheet(int width, int height);
  ~VtkSheet() override;
  VtkSheet(const VtkSheet&) = delete;
  VtkSheet& operator=(const VtkSheet&) = delete;

  void strips(const std::vector<Strip>& list) override;
  void image(int left, int bottom, int columns, int rows, const std::vector<Colour>& colours) override;
  void text(Point at, const std::string& line, const TextStyle& style) override;
  std::string png() override;

  void look(const Place& eye, const Place& towards) override;
  void shift_scene(Point by) override;
  Point pixel(const Place& place) const override;
  double depth(const Place& place) const override;
  void scene_lines(const std::vector<std::vector<Place>>& lines, const Colour& colour, double width) override;
  void scene_tubes(const std::vector<std::vector<Place>>& lines, const Colour& colour, double radius) override;
  void scene_mesh(const Mesh& mesh, const Material& material) override;
  void light_scene() override;

 private:
  void add(vtkActor2D* actor);
  vtkCamera* camera() const;

  int width_, height_;
  int layer_ = 0;
  vtkRenderer* renderer_;
};

}  // namespace gaussdrift::render
