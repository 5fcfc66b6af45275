// In place of the pictures where OSMesa was absent at build time.
#include "base/error.hpp"
#include "render/chart.hpp"
#include "render/panel.hpp"
#include "render/picture.hpp"

namespace gaussdrift::render {

std::string unavailable_reason() { return "this program draws no pictures: " GAUSSDRIFT_NO_PICTURES; }

void draw(Style, const DensityGrid&, const PictureOptions&, const std::filesystem::path&) {
  throw Error(ExitCode::internal, unavailable_reason());
}

void draw_panels(const std::vector<Panel>&, const std::filesystem::path&) {
  throw Error(ExitCode::internal, unavailable_reason());
}

void draw_chart(const Chart&, const std::filesystem::path&) { throw Error(ExitCode::internal, unavailable_reason()); }

}  // namespace gaussdrift::render
