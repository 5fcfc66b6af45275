#include "render/chart_page.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace gaussdrift::render {
namespace {

std::string page_file(std::string_view name) {
  const auto& files = chart_page_files();
  return std::string(
      std::find_if(files.begin(), files.end(), [&](const auto& file) { return file.name == name; })->bytes);
}

/// Letters of 13 pixels.
Chart in_size(const Chart& chart, int width, int height) {
  Chart sized = chart;
  sized.width = width, sized.height = height;
  sized.grows = true;
  sized.conclusion.clear(), sized.footer.clear();
  constexpr double letters = 0.74;  // times those of a picture of 1280 x 960 pixels
  sized.type = letters / std::min(width / 1280., height / 960.);
  return sized;
}

/// What it shows is told to those who do not see it; nobody reads it twice.
Sheet without_title(const Chart& chart) {
  Chart bare = chart;
  bare.title.clear();
  Sheet sheet = laid_out(bare);
  sheet.title = chart.title;
  return sheet;
}

}  // namespace

std::string frame_style() { return page_file("frame.css"); }
std::string chart_style() { return page_file("chart.css"); }
std::string chart_script() { return page_file("chart.js"); }

std::string chart_figure(const Chart& chart, int height) {
  return fmt::format(
      "<figure class=\"chart-figure\"><div class=\"chart-wide\">{}</div><div class=\"chart-narrow\">{}</div>"
      "<figcaption class=\"chart-value\" aria-live=\"polite\">Point at a mark, or go through them with the arrow keys, "
      "to read its numbers.</figcaption></figure>\n",
      inline_svg_of(without_title(in_size(chart, 940, height))),
      inline_svg_of(without_title(in_size(chart, 370, 430))));
}

}  // namespace gaussdrift::render
