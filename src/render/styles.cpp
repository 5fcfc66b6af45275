#include "render/styles.hpp"

#include <algorithm>
#include <stdexcept>

namespace gaussdrift::render {

// Each in a file of its name.
Style surface_style();
Style contour_style();
Style heatmap_style();
Style arrows_style();
Style streamlines_style();
Style slices_style();
Style projection_style();
Style isosurface_style();
Style error_style();

}  // namespace gaussdrift::render

template <>
std::vector<gaussdrift::render::Style>& gaussdrift::base::catalogue<gaussdrift::render::Style>() {
  using namespace gaussdrift::render;
  static std::vector<Style> all{surface_style(),    contour_style(),     heatmap_style(),
                                arrows_style(),     streamlines_style(), slices_style(),
                                projection_style(), isosurface_style(),  error_style()};
  return all;
}

namespace gaussdrift::render {

namespace {

template <class Wanted>
const Style& first(int dimension, bool errors, const Wanted& wanted) {
  const auto found = std::find_if(styles().begin(), styles().end(), [&](const Style& style) {
    return style.about.shows(dimension) && style.about.shows_error == errors && wanted(style);
  });
  if (found == styles().end()) throw std::logic_error("no picture shows such a density");
  return *found;
}

}  // namespace

const std::vector<Style>& styles() { return base::catalogue<Style>(); }

std::vector<std::string> style_names() {
  std::vector<std::string> names;
  for (const Style& style : styles()) names.emplace_back(style.about.name);
  return names;
}

const Style& find_style(std::string_view name) { return base::find_named(styles(), "style of pictures", name); }

const Style& default_style(int dimension, bool errors) {
  return first(dimension, errors, [&](const Style& style) { return style.about.by_default || errors; });
}

const Style& panel_style(int dimension, bool errors) {
  return first(dimension, errors, [](const Style& style) { return style.in_panels; });
}

}  // namespace gaussdrift::render
