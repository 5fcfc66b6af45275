// Charts as part of a page: in two sizes, for wide windows and for narrow ones, with the numbers of the mark that is
// pointed at.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "render/chart.hpp"

namespace gaussdrift::render {

struct ChartPageFile {
  std::string_view name;   // "chart.css"
  std::string_view bytes;  // as it stands in src/render/page/
};

/// Generated from src/render/page/ by cmake/EmbedFiles.cmake.
const std::vector<ChartPageFile>& chart_page_files();

/// Goes into the style element of a page before all else: colours, letters and tables of the pages that have charts.
std::string frame_style();
/// Goes into the same element. Needs colours --ink and --quiet.
std::string chart_style();
/// Goes into a script element at the end of the page.
std::string chart_script();

/// A figure, in wide windows so many pixels high for a width of 940. Title, conclusion and footer are left to the page.
std::string chart_figure(const Chart& chart, int height = 620);

}  // namespace gaussdrift::render
