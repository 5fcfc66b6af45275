// Several densities side by side in one picture, those of a quantity with a colour range in common: the summary of a run.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "gaussdrift/frame.hpp"
#include "render/lines_over_map.hpp"

namespace gaussdrift::render {

struct Panel {
  std::string title;
  DensityGrid density;
  std::optional<double> time;
  std::string date{};                                  // of that time; empty: it has none
  std::string quantity = "density";                    // panels of the same quantity have the same range
  bool is_difference = false;                          // a range as far below 0 as above, and white there
  std::optional<std::array<std::size_t, 3>> planes{};  // in space, the indices of the planes that cut it
  std::vector<PlaneLine> lines{};                      // over the density, which is then seen from above
};

/// Two panels a row, as heatmaps (2D) or slices (3D), of 640 x 480 pixels each. Throws as draw() does.
void draw_panels(const std::vector<Panel>& panels, const std::filesystem::path& png);

}  // namespace gaussdrift::render
