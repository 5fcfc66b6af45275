// What VTK and OSMesa do for pictures: scenes, texts, lines and surfaces of equal values. They are in a shared library (vtk/), which is loaded for the first picture (drawing_library.hpp). Only types of this file and of the
// standard library pass between the two, and errors are those of the standard library.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "render/colour.hpp"
#include "render/image.hpp"

namespace gaussdrift::render {

using Place = std::array<double, 3>;  // in a scene

/// Where a text sits relative to its point.
enum class Across { left, centre, right };  // the point is at the left end, centre, right end of the text
enum class Along { bottom, centre, top };

struct TextStyle {
  int size = 19;
  Across across = Across::centre;
  Along along = Along::centre;
  bool upwards = false;  // written from below to above
  Colour colour = ink;
};

/// Triangles in space. Their colours are `colours`, or a shade for each point: 0 is the first of `shades`, 1 the last.
struct Mesh {
  std::vector<std::array<float, 3>> points, normals;
  std::vector<std::array<std::int64_t, 3>> triangles;
  std::vector<std::array<std::uint8_t, 4>> colours;  // of the points: red, green, blue, opacity
  std::vector<float> shade;
  std::vector<Colour> shades;
};

/// How a mesh reflects light.
struct Material {
  double ambient = 0, diffuse = 1, specular = 0, specular_power = 1;
  bool translucent = false;
};

/// Values on a plane lattice or in space, x fastest, the first point at the origin.
struct Field {
  std::array<std::size_t, 3> points{1, 1, 1};
  Place spacing{1, 1, 1};
  const float* values = nullptr;
};

/// What is seen in perspective. Places are in a box of one's own.
class Scene {
 public:
  virtual ~Scene() = default;

  /// From `eye`, under an angle of 20 degrees from below to above, z upwards.
  virtual void look(const Place& eye, const Place& towards) = 0;
  /// Moves what is seen, in halves of the picture.
  virtual void shift(Point by) = 0;
  /// Where a place is in the picture.
  virtual Point pixel(const Place& place) const = 0;
  /// Distance from the plane of the eye, growing away from it.
  virtual double depth(const Place& place) const = 0;
  virtual void lines(const std::vector<std::vector<Place>>& lines, const Colour& colour, double width) = 0;
  /// Lines as tubes, which do not flicker through a surface.
  virtual void tubes(const std::vector<std::vector<Place>>& lines, const Colour& colour, double radius) = 0;
  virtual void mesh(const Mesh& mesh, const Material& material) = 0;

  /// All of it, over white, with its opacity. After that nothing is added. Throws std::runtime_error.
  virtual Image image() = 0;
};

/// One thread at a time (drawing_library.hpp).
class Drawing {
 public:
  virtual ~Drawing() = default;

  /// "VTK 9.1.0"
  virtual std::string library() const = 0;
  /// Before the first sheet, once. Empty if pictures can be drawn, else the reason and the remedy.
  virtual std::string start() = 0;
  /// Before the process ends, and after that nothing.
  virtual void finish() = 0;

  virtual std::unique_ptr<Scene> scene(int width, int height) = 0;
  /// One line of well-formed UTF-8, put where its point is.
  virtual Mask text(const std::string& line, const TextStyle& style) const = 0;
  /// In pixels.
  virtual double text_width(const std::string& line, int size) const = 0;
  /// Whether the font has Greek letters, superscripts and the true minus sign.
  virtual bool has_font() const = 0;
  /// Lines on which a plane field has this value.
  virtual std::vector<std::vector<Point>> level_lines(const Field& field, double level) const = 0;
  /// The surface on which a field has this value: points, normals, triangles.
  virtual Mesh level_surface(const Field& field, double level) const = 0;
  /// A PNG of 8-bit red, green, blue. Throws std::runtime_error: "not a PNG picture".
  virtual Image read_png(const std::filesystem::path& file) const = 0;
};

}  // namespace gaussdrift::render
