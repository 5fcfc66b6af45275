// In place of osmesa_window.cpp where OSMesa was absent at build time: nothing is drawn, and the reason is told.
#include "gaussdrift/error.hpp"
#include "render/osmesa_window.hpp"

namespace gaussdrift::render {

std::string window_unavailable_reason() { return "this program draws no pictures: " GAUSSDRIFT_NO_PICTURES; }

vtkRenderWindow* offscreen_window(int, int) { throw Error(ExitCode::internal, window_unavailable_reason()); }

void release_window() {}

}  // namespace gaussdrift::render
