#include "render/read_png.hpp"

#include <fmt/format.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>

#include <algorithm>

#include "gaussdrift/error.hpp"

namespace gaussdrift::render {

Image read_png(const std::filesystem::path& file) {
  vtkNew<vtkPNGReader> reader;
  if (!std::filesystem::is_regular_file(file) || !reader->CanReadFile(file.c_str()))
    throw FileError(fmt::format("cannot read {}: not a PNG picture", file.string()));
  reader->SetFileName(file.c_str());
  reader->Update();
  vtkImageData* data = reader->GetOutput();
  if (data->GetScalarType() != VTK_UNSIGNED_CHAR || data->GetNumberOfScalarComponents() != 3)
    throw FileError(fmt::format("cannot read {}: not 8-bit red, green, blue", file.string()));
  Image image;
  image.width = data->GetDimensions()[0];
  image.height = data->GetDimensions()[1];
  image.pixels.resize(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  const auto* from = static_cast<const unsigned char*>(data->GetScalarPointer());
  for (Colour& pixel : image.pixels) {
    std::copy_n(from, 3, pixel.begin());
    from += 3;
  }
  return image;
}

}  // namespace gaussdrift::render
