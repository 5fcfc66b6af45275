#include "render/read_png.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "gaussdrift/error.hpp"
#include "render/drawing_library.hpp"

namespace gaussdrift::render {

Image read_png(const std::filesystem::path& file) {
  try {
    return drawing().read_png(file);
  } catch (const Error&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw FileError(fmt::format("cannot read {}: {}", file.string(), error.what()));
  }
}

}  // namespace gaussdrift::render
