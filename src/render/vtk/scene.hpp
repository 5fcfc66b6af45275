// A scene of VTK: one renderer in the one window of the process.
#pragma once

#include <vector>

#include "render/drawing.hpp"

class vtkCamera;
class vtkRenderer;

namespace gaussdrift::render {

class VtkScene : public Scene {
 public:
  VtkScene(int width, int height);
  ~VtkScene() override;
  VtkScene(const VtkScene&) = delete;
  VtkScene& operator=(const VtkScene&) = delete;

  void look(const Place& eye, const Place& towards) override;
  void shift(Point by) override;
  Point pixel(const Place& place) const override;
  double depth(const Place& place) const override;
  void lines(const std::vector<std::vector<Place>>& lines, const Colour& colour, double width) override;
  void tubes(const std::vector<std::vector<Place>>& lines, const Colour& colour, double radius) override;
  void mesh(const Mesh& mesh, const Material& material) override;
  Image image() override;

 private:
  vtkCamera* camera() const;

  int width_, height_;
  vtkRenderer* renderer_;
};

}  // namespace gaussdrift::render
