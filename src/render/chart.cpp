// The files of a chart.
#include "render/chart.hpp"

#include "render/on_canvas.hpp"
#include "render/picture.hpp"
#include "write/atomic_file.hpp"

namespace gaussdrift::render {

std::vector<std::string_view> chart_endings() {
  std::vector<std::string_view> endings{".svg", ".pdf"};
  if (unavailable_reason().empty()) endings.insert(endings.begin(), ".png");
  return endings;
}

void write_chart(const Chart& chart, const std::filesystem::path& file) {
  const Sheet sheet = laid_out(chart);
  for (const std::string_view ending : chart_endings()) {
    std::filesystem::path name = file;
    name += ending;
    if (ending == ".png")
      on_canvas(sheet.width, sheet.height, name, [&](Canvas& canvas) { paint(sheet, canvas); });
    else
      write::write_text(name, ending == ".svg" ? svg_of(sheet) : pdf_of(sheet));
  }
}

}  // namespace gaussdrift::render
