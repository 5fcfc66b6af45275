// Figures 3.2 to 3.5 of [Sch06]: a box, the boxes that a bounding box is cut into, and the neighbours of one of them.
#pragma once

#include <filesystem>

namespace gaussdrift::reproduce {

// Each writes a PNG, and throws as render::on_canvas().
void draw_box_with_its_corners(const std::filesystem::path& png);
void draw_numbered_boxes(const std::filesystem::path& png);
void draw_neighbours(const std::filesystem::path& png);
void draw_recursion(const std::filesystem::path& png);

}  // namespace gaussdrift::reproduce
